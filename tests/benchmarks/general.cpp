// Time per step of general systems, by name.
//
//   build/tests/benchmarks/general --benchmark_counters_tabular=true
// The counter "per_step" is the time of one step, "evaluations" how often the equation was
// evaluated in it. The explicit Runge-Kutta-Munthe-Kaas method, four accelerations a step, is
// measured beside lift and balance.
#include <benchmark/benchmark.h>

#include <hamel/hamel.hpp>

namespace {

using namespace hamel;  // a program, not a header

void run(benchmark::State& state, const Simulation& simulation, long steps) {
  double evaluations = 0;
  for (auto _ : state) {
    state.PauseTiming();
    hamel::Run integration = simulation.build();
    (void)integration.step(20);  // a history to extrapolate from
    const long before = integration.stats().evaluations;
    state.ResumeTiming();
    if (!integration.step(steps)) state.SkipWithError("failed");
    evaluations = static_cast<double>(integration.stats().evaluations - before);
  }
  state.counters["per_step"] =
      benchmark::Counter(static_cast<double>(steps), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
  state.counters["evaluations"] = evaluations / static_cast<double>(steps);
}

void add(const std::string& name, const Simulation& simulation, long steps) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) { run(state, simulation, steps); });
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::string scheme : {"lift", "balance", "rkmk4"}) {
    for (const std::string retraction : {"cayley", "exp"}) {
      const Simulation disk = simulate("falling_disk").scheme(scheme).retraction(retraction);
      const std::string name = "falling_disk/" + scheme + "/" + retraction;
      add(name + "/h=0.001", Simulation(disk).step(0.001), 2000);
      add(name + "/h=0.01", Simulation(disk).step(0.01), 2000);
    }
  }
  for (const int n : {3, 10, 30, 60}) {
    for (const std::string scheme : {"lift", "balance"}) {
      add("n_trailer/" + scheme + "/n=" + std::to_string(n),
          simulate("n_trailer").set("trailers", n).scheme(scheme).step(0.01), 200);
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
