// Time per step of mechanisms by parts: against the systems written by hand, and along a chain of n
// bodies.
//
//   build/tests/benchmarks/mechanisms
// segway and n_trailer: "per_step" is the time of one step of lift, "ratio" that of the parts to
// the written system, which runs between them in turns. chain: a snake in space of n bodies;
// "equations" is I(g), A(g) and the force once, at a place and velocity not seen before, "step" a
// whole step with its dense solve.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <vector>

#include <hamel/hamel.hpp>

#include "../systems/mechanism_systems.hpp"
#include "chains.hpp"

namespace {

using namespace hamel;  // a program, not a header

constexpr long kSteps = 500;

// Of this process, so that others on the machine do not count.
double seconds_of(hamel::Run& run, benchmark::State& state) {
  const std::clock_t begin = std::clock();
  if (!run.step(kSteps)) state.SkipWithError("failed");
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// Blocks of steps in turns, so that both see the same machine.
void compare(benchmark::State& state, const Simulation& written, const Simulation& parts) {
  hamel::Run hers = written.build(), ours = parts.build();
  (void)hers.step(20);
  (void)ours.step(20);
  std::vector<double> ratios, times;
  for (auto _ : state) {
    const double other = seconds_of(hers, state), mine = seconds_of(ours, state);
    ratios.push_back(mine / other);
    times.push_back(mine / kSteps);
    state.SetIterationTime(mine);
  }
  state.counters["per_step"] = median(times);
  state.counters["ratio"] = median(ratios);
}

void equations(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const SystemModel model = benchmarks::snake(n).model();
  const Mechanics& mechanics = *model.mechanics;
  const auto geometry = registry().geometry(model.group.name, "exp");
  Eigen::VectorXd g(geometry->size()), turn(geometry->size()), force(mechanics.dim()),
      b(mechanics.constraint_count()), xi = Eigen::VectorXd::Constant(mechanics.dim(), 0.01);
  Eigen::MatrixXd inertia(mechanics.dim(), mechanics.dim()),
      a(mechanics.constraint_count(), mechanics.dim());
  geometry->from_coordinates(model.start.configuration, g.data());
  geometry->tau(xi.data(), turn.data());
  for (auto _ : state) {
    geometry->compose(g.data(), turn.data(), g.data());
    mechanics.inertia(g.data(), inertia);
    mechanics.constraints(0, g.data(), a, b);
    mechanics.force(0, g.data(), xi, force);
    benchmark::DoNotOptimize(force.data());
  }
  state.SetComplexityN(n);
}

void step(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  hamel::Run run = simulate(benchmarks::snake(n)).step(0.001).build();
  const Start start = run.config().start;
  long taken = 0;
  for (auto _ : state) {  // the first second again and again: later a long chain lies in knots
    if (!run.step()) state.SkipWithError("failed");
    if (++taken % 1000 == 0) run.restart(start);
  }
  state.SetComplexityN(n);
}

void add(const std::string& name, const Simulation& written, const Simulation& parts) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) { compare(state, written, parts); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::string scheme : {"lift", "balance"}) {
    const Simulation segway = simulate("segway").scheme(scheme).step(0.001);
    add("segway/" + scheme, segway,
        simulate(by_parts::segway({}))
            .scheme(scheme)
            .step(0.001)
            .start(segway.build().config().start));
    const Simulation train = simulate("n_trailer").scheme(scheme).step(0.001);
    Start start =
        train.build().config().start;  // headings against the car -> against the one before
    for (auto* values : {&start.configuration, &start.velocity})
      for (size_t i = values->size() - 1; i > 3; --i) (*values)[i] -= (*values)[i - 1];
    add("n_trailer3/" + scheme, train,
        simulate(by_parts::train({})).scheme(scheme).step(0.001).start(start));
  }
  benchmark::RegisterBenchmark("chain/equations", equations)
      ->DenseRange(1, 20)
      ->Complexity(benchmark::oNSquared);
  benchmark::RegisterBenchmark("chain/step", step)->DenseRange(1, 20)->Complexity();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
