// Systems by data beside the same systems as C++ structs, in one run.
//
//   build/tests/benchmarks/data_systems --benchmark_counters_tabular=true
// Counters: seconds a step of the file and of the struct, and their ratio, which is to be at
// most 5. "compiled" is the struct with a kernel of its own types, "by name" the struct on the
// erased problem, as simulate(MySystem{}) runs it.
#include <chrono>
#include <cmath>

#include <benchmark/benchmark.h>

#include <hamel/hamel.hpp>
#include <hamel/systems/contact_oscillator.hpp>

#include "../systems/written_in_cpp.hpp"

namespace {

using namespace hamel;  // a program, not a header

constexpr long kSteps = 2000;

double seconds_of(const Simulation& simulation) {
  hamel::Run integration = simulation.build();
  (void)integration.step(20);  // a history to extrapolate from
  const auto before = std::chrono::steady_clock::now();
  if (!integration.step(kSteps)) return std::nan("");
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
}

void add(const std::string& name, const Simulation& in_cpp, const std::string& file) {
  for (const std::string scheme : {"lift", "balance", "rkmk4"}) {
    const auto set = [&](Simulation s) { return s.scheme(scheme).step(0.005).until(11); };
    const Simulation ours = set(simulate(std::string(HAMEL_EXAMPLES "/") + file)),
                     hers = set(in_cpp);
    benchmark::RegisterBenchmark((name + "/" + scheme).c_str(), [=](benchmark::State& state) {
      double data = 0, written = 0;
      for (auto _ : state) {  // in turns, so that what disturbs one disturbs the other
        data += seconds_of(ours);
        written += seconds_of(hers);
      }
      const double steps = static_cast<double>(kSteps * state.iterations());
      state.counters["file"] = data / steps;
      state.counters["struct"] = written / steps;
      state.counters["ratio"] = data / written;
    });
  }
}

// The registered system under another type, for which no kernel is compiled.
struct PlainOscillator : ContactOscillator {
  static std::string name() { return "plain_oscillator"; }
};

}  // namespace

int main(int argc, char** argv) {
  ContactOscillator oscillator;
  oscillator.ratio = 0.2;
  oscillator.spring = 1.3;
  const PlainOscillator plain{oscillator};
  add("contact_oscillator/compiled", simulate(oscillator), "contact_oscillator.toml");
  add("contact_oscillator/by_name", simulate(plain), "contact_oscillator.toml");
  add("particle/by_name", simulate(Particle{}), "particle_in_potential.toml");
  add("scooter/by_name", simulate(Scooter{}), "scooter_by_rows.toml");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
