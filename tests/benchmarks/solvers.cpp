// Time per step of each solver: through hamel, and the raw library called by hand, in one run.
//
//   build/tests/benchmarks/solvers --benchmark_enable_random_interleaving=true
//   --benchmark_repetitions=9
// The table at the end holds medians and their ratio. The equation: lift with Cayley at s = 0,
// Suslov with full inertia, h = 0.1, two unknowns, tolerance 1e-13. By hand is: the same step class
// and the same extrapolated guess, the library's own interface with the equation inlined, stopped
// at the same residual with the options that it needs for that (solvers/README.md); nothing
// counted, kept or certified.
#include <algorithm>
#include <cstdio>
#include <map>

#include <benchmark/benchmark.h>

#include <hamel/framework/mechanics/frame.hpp>
#include <hamel/hamel.hpp>

#include "raw_solvers.hpp"

namespace {

using namespace hamel;  // a program, not a header
using benchmarks::Step;
using benchmarks::Unknown;

constexpr long kSteps = 500;
constexpr double kStep = 0.1;

Suslov body() {
  Suslov suslov;
  suslov.moments = {2, 0.3, 0.5, 3, 0.4, 4};
  return suslov;
}

void per_step(benchmark::State& state) {
  state.counters["per_step"] = benchmark::Counter(
      static_cast<double>(kSteps),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// The loop by hand: the extrapolation of six solutions, as in framework/loop/extrapolation.hpp.
template <class Raw>
void by_hand(benchmark::State& state) {
  const Suslov suslov = body();
  const benchmarks::Problem problem(suslov.inertia(), suslov.constraints());
  Raw raw;
  for (auto _ : state) {
    Step step(problem, 0);
    Node<benchmarks::Problem> node(problem), next(problem);
    problem.to_state(Vec<3>(1, 0.5, 0), node.x);
    std::array<Unknown, 6> x;
    for (long k = 0; k < kSteps; ++k) {
      step.begin(node, kStep);
      Unknown y;
      step.guess(y);
      if (k >= 6) {
        y = 6 * (x[0] + x[4]) - 15 * (x[1] + x[3]) + 20 * x[2] - x[5];
      } else if (k > 0) {
        y = x[0];
      }
      if (!raw.solve(step, y)) state.SkipWithError("no convergence");
      for (size_t i = 5; i > 0; --i) x[i] = x[i - 1];
      x[0] = y;
      if (!step.finish(y, next)) state.SkipWithError("outside the domain");
      next.g = SO3::normalise(next.g);
      node = next;
    }
    benchmark::DoNotOptimize(node);
  }
  per_step(state);
}

void through_hamel(benchmark::State& state, const std::string& solver) {
  const Simulation simulation = simulate<Lift, Cayley>(body())
                                    .start({.velocity = {1, 0.5, 0}})
                                    .s(0)
                                    .solver(solver)
                                    .step(kStep);
  for (auto _ : state) {
    state.PauseTiming();
    Run run = simulation.build();
    state.ResumeTiming();
    if (!run.step(kSteps)) state.SkipWithError("failed");
  }
  per_step(state);
}

template <class Raw>
void add(const std::string& solver) {
  benchmark::RegisterBenchmark((solver + "/by_hand").c_str(), by_hand<Raw>);
  benchmark::RegisterBenchmark((solver + "/hamel").c_str(),
                               [solver](benchmark::State& s) { through_hamel(s, solver); });
}

/// Keeps every repetition's time per step.
class Ratios final : public benchmark::ConsoleReporter {
 public:
  Ratios() : ConsoleReporter(OO_None) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      times_[run.run_name.function_name].push_back(run.counters.at("per_step").value);
    }
  }
  void table() {
    std::printf("\n%-18s %12s %12s %8s\n", "ns a step", "by hand", "hamel", "ratio");
    for (auto& [name, times] : times_) {
      const std::string suffix = "/by_hand";
      if (!name.ends_with(suffix)) continue;
      const std::string solver = name.substr(0, name.size() - suffix.size());
      const double hand = median(times), ours = median(times_[solver + "/hamel"]);
      std::printf("%-18s %12.0f %12.0f %8.2f\n", solver.c_str(), 1e9 * hand, 1e9 * ours,
                  ours / hand);
    }
  }

 private:
  static double median(std::vector<double>& times) {
    if (times.empty()) return 0;
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
  }
  std::map<std::string, std::vector<double>> times_;
};

}  // namespace

int main(int argc, char** argv) {
  add<benchmarks::RawNewton>("newton");
  add<benchmarks::RawHybrid>("hybrid");
#ifdef HAMEL_HAS_CERES
  add<benchmarks::RawTiny>("ceres_tiny");
  add<benchmarks::RawCeres>("ceres");
#endif
#ifdef HAMEL_HAS_NLOPT
  add<benchmarks::RawSlsqp>("nlopt");
  add<benchmarks::RawMinimiser<NLOPT_LD_LBFGS>>("nlopt:lbfgs");
  add<benchmarks::RawMinimiser<NLOPT_LD_VAR2>>("nlopt:var2");
  add<benchmarks::RawMinimiser<NLOPT_LD_TNEWTON_PRECOND_RESTART>>("nlopt:tnewton");
  add<benchmarks::RawMinimiser<NLOPT_LD_MMA>>("nlopt:mma");
  add<benchmarks::RawMinimiser<NLOPT_LD_CCSAQ>>("nlopt:ccsaq");
  add<benchmarks::RawMinimiser<NLOPT_LN_NELDERMEAD>>("nlopt:neldermead");
  add<benchmarks::RawMinimiser<NLOPT_LN_SBPLX>>("nlopt:sbplx");
#endif
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  Ratios ratios;
  benchmark::RunSpecifiedBenchmarks(&ratios);
  ratios.table();
  benchmark::Shutdown();
  return 0;
}
