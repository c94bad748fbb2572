// Time of a recorded row: 200,000 steps of suslov, every one a row, into nothing that is kept,
// memory, and files.
//
//   build/tests/benchmarks/recording
// The counter "per_row" is the time of a step and its row; what a file costs is its difference from
// "thinned".
#include <benchmark/benchmark.h>

#include <filesystem>

#include <hamel/hamel.hpp>

namespace {

using namespace hamel;  // a program, not a header

constexpr long kRows = 200000;

void record(benchmark::State& state, const Simulation& simulation) {
  for (auto _ : state)
    if (!simulation.run()) state.SkipWithError("failed");
  state.counters["per_row"] = benchmark::Counter(
      kRows, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

}  // namespace

int main(int argc, char** argv) {
  const auto folder = std::filesystem::temp_directory_path() / "hamel_recording";
  std::filesystem::create_directory(folder);
  const Simulation suslov =
      simulate("suslov").with(&Config::no_exact, true).step(0.01).until(0.01 * kRows);
  const auto add = [&](const char* name, const Simulation& simulation) {
    benchmark::RegisterBenchmark(name, [simulation](benchmark::State& state) {
      record(state, simulation);
    })->Unit(benchmark::kMillisecond);
  };
  add("thinned", Simulation(suslov).keep_rows(1000));
  add("memory", suslov);
  for (const std::string& format : output_formats())  // .json holds no rows
    add(format.c_str(), Simulation(suslov).record_to(folder / ("rows" + format)));
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  std::filesystem::remove_all(folder);
  return 0;
}
