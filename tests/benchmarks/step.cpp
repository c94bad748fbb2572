// Time per step: a hand-written loop, the typed path and the named path, in one run.
//
//   build/tests/benchmarks/step --benchmark_counters_tabular=true
// Every benchmark takes 2000 steps of h = 0.01 from the same start; the counter "per_step" is the
// time of one. The hand-written loops are for s = 0: hand_written.hpp with the library's own
// policies, lean.hpp with as little as the problem needs; s = 1/2 is shown beside them.
#include <benchmark/benchmark.h>

#include <hamel/hamel.hpp>

#include "hand_written.hpp"
#include "lean.hpp"

namespace {

using namespace hamel;  // a program, not a header

constexpr long kSteps = 2000;
const std::vector<double> kFullInertia = {2, 0.3, 0.5, 3, 0.4, 4};

void per_step(benchmark::State& state) {
  state.counters["per_step"] = benchmark::Counter(
      static_cast<double>(kSteps),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Body>
void hand(benchmark::State& state, bool (Body::*step)(), double a, double b) {
  for (auto _ : state) {
    Body body(a, b);
    for (long k = 0; k < kSteps; ++k) {
      if (!(body.*step)()) state.SkipWithError("no convergence");
    }
    benchmark::DoNotOptimize(body);
  }
  per_step(state);
}

void library(benchmark::State& state, const Simulation& simulation) {
  for (auto _ : state) {
    state.PauseTiming();
    hamel::Run run = simulation.build();
    state.ResumeTiming();
    if (!run.step(kSteps)) state.SkipWithError("failed");
  }
  per_step(state);
}

Suslov body() {
  Suslov suslov;
  suslov.moments = kFullInertia;
  return suslov;
}
const Start kSuslovStart = {.velocity = {1, 0.5, 0}};
const Start kSleighStart = {.velocity = {0.9, -1, 0}};

// What a user's loop pays beside its steps: a run of its own, or the same one from another start.
void built(benchmark::State& state, const Simulation& simulation) {
  for (auto _ : state) {
    hamel::Run run = simulation.build();
    if (!run.step()) state.SkipWithError("failed");
  }
}
void restarted(benchmark::State& state, const Simulation& simulation, const Start& start) {
  hamel::Run run = simulation.build();
  for (auto _ : state) {
    run.restart(start);
    if (!run.step()) state.SkipWithError("failed");
  }
}

template <class Step>
void add_hand(const std::string& name, Step step) {
  benchmark::RegisterBenchmark(name.c_str(), step);
}

void add(const std::string& name, Simulation simulation) {
  simulation.step(0.01);  // of lift, by name too
  benchmark::RegisterBenchmark(name.c_str(),
                               [simulation](benchmark::State& s) { library(s, simulation); });
}

}  // namespace

int main(int argc, char** argv) {
  using benchmarks::HandSleigh;
  using benchmarks::HandSuslov;
  add_hand("suslov/cayley/hand_written",
           [](benchmark::State& s) { hand(s, &HandSuslov::step_cayley, 1, 0.5); });
  add_hand("suslov/cayley/lean",
           [](benchmark::State& s) { hand(s, &benchmarks::LeanSuslov::step_cayley, 1, 0.5); });
  add("suslov/cayley/typed", simulate<Lift, Cayley>(body()).start(kSuslovStart).s(0));
  add("suslov/cayley/named",
      simulate("suslov").set("inertia", kFullInertia).start(kSuslovStart).s(0));
  add("suslov/cayley/named, s=0.5",
      simulate("suslov").set("inertia", kFullInertia).start(kSuslovStart));
  add_hand("suslov/exp/hand_written",
           [](benchmark::State& s) { hand(s, &HandSuslov::step_exp, 1, 0.5); });
  add("suslov/exp/typed", simulate<Lift, Exp>(body()).start(kSuslovStart).s(0));
  add("suslov/exp/named",
      simulate("suslov").set("inertia", kFullInertia).start(kSuslovStart).s(0).retraction("exp"));

  add_hand("sleigh/cayley/hand_written",
           [](benchmark::State& s) { hand(s, &HandSleigh::step_cayley, 0.9, -1); });
  add("sleigh/cayley/typed", simulate<Lift, Cayley>(ChaplyginSleigh{}).start(kSleighStart).s(0));
  add("sleigh/cayley/named", simulate("chaplygin_sleigh").start(kSleighStart).s(0));
  add("sleigh/cayley/named, s=0.5", simulate("chaplygin_sleigh").start(kSleighStart));
  add_hand("sleigh/exp/hand_written",
           [](benchmark::State& s) { hand(s, &HandSleigh::step_exp, 0.9, -1); });
  add("sleigh/exp/typed", simulate<Lift, Exp>(ChaplyginSleigh{}).start(kSleighStart).s(0));
  add("sleigh/exp/named", simulate("chaplygin_sleigh").start(kSleighStart).s(0).retraction("exp"));

  const Simulation full =
      simulate("suslov").set("inertia", kFullInertia).start(kSuslovStart).step(0.01);
  add_hand("suslov/build and a step", [full](benchmark::State& s) { built(s, full); });
  add_hand("suslov/restart and a step",
           [full](benchmark::State& s) { restarted(s, full, kSuslovStart); });

  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
