// Time of whole plans and fits: recording, solving, deviations.
//
//   build/tests/benchmarks/inverse
// plan: files of tests/examples, read before; "iterations" of Newton's method.
// fit: the sleigh's offset and start from 81 samples of both velocities in [0, 4], sigma 0.01;
// "runs" of the motion.
#include <benchmark/benchmark.h>

#include <random>
#include <string>

#include <hamel/framework/inverse/fit.hpp>
#include <hamel/framework/inverse/motion_plan.hpp>
#include <hamel/hamel.hpp>

namespace {

using namespace hamel;  // a program, not a header

void plan(benchmark::State& state, const std::string& name) {
  const PlanRequest request = read_plan(std::string(HAMEL_EXAMPLES) + "/" + name + ".toml");
  double iterations = 0;
  for (auto _ : state) {
    const Plan made = make_plan(registry(), request);
    if (!made) state.SkipWithError(made.reason.c_str());
    iterations = static_cast<double>(made.iterations);
  }
  state.counters["iterations"] = iterations;
}

Simulation sleigh() {
  return simulate("chaplygin_sleigh")
      .set("mass", 1)
      .set("inertia", 1)
      .set("offset", 0.2)
      .start({.velocity = {1, 1, 0}});
}

void fit_sleigh(benchmark::State& state, bool by_steps) {
  Simulation simulation = sleigh();
  if (by_steps) simulation.scheme("lift").step(0.05);
  else simulation.tolerance({.relative = 1e-11});
  const Result result = Simulation(simulation).output(0.05).until(4).run();
  FitRequest request;
  Recording data{"sleigh", {"omega", "v1"}, result.trajectory.column("t"), {}, {}};
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, 0.01);
  for (const std::string& name : data.columns) {
    data.values.push_back(result.trajectory.column(name));
    for (double& x : data.values.back()) x += normal(random);
  }
  request.recordings.push_back(data);
  request.names = {{"offset", 0.25}, {"start.v1", 0.9}, {"start.omega", 0.9}};
  request.sigma = {{"omega", 0.01}, {"v1", 0.01}};
  double runs = 0, iterations = 0;
  for (auto _ : state) {
    const Fit found = fit(simulation, request);
    if (!found) state.SkipWithError(found.reason.c_str());
    runs = static_cast<double>(found.runs);
    iterations = static_cast<double>(found.iterations);
  }
  state.counters["runs"] = runs;
  state.counters["iterations"] = iterations;
}

BENCHMARK_CAPTURE(plan, parking, "parking")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan, disk_to_place, "disk_to_place")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan, segway_to_rest, "segway_to_rest")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan, into_a_bay, "into_a_bay")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan, planned_gait, "planned_gait")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan, lane_change, "lane_change")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit_sleigh, tolerance, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit_sleigh, steps, true)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
