// Time of a recorded program, per body: machine code, interpreter and gcc's build of the exported
// C, in one body and in lanes, beside the same template over double.
//
// The formula: the end of a chain of eight links in space, each turned about an axis of its own,
// with its derivatives by the eight angles.
#include <benchmark/benchmark.h>
#include <dlfcn.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/framework/graph/export_c.hpp>

namespace {

using namespace hamel::graph;

constexpr int kLinks = 8;
template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;

// End of the chain; links alternate between the three axes.
template <class T>
Vector3<T> end_of_chain(const std::vector<T>& angles) {
  using std::cos, std::sin;
  Vector3<T> end(T(0), T(0), T(0));
  for (int i = kLinks; i-- > 0;) {
    const T c = cos(angles[static_cast<size_t>(i)]), s = sin(angles[static_cast<size_t>(i)]);
    end += Vector3<T>(T(0.3), T(0.1 * i), T(1));
    const int a = i % 3, b = (i + 1) % 3;
    const T p = c * end[a] - s * end[b], q = s * end[a] + c * end[b];
    end[a] = p;
    end[b] = q;
  }
  return end;
}

std::shared_ptr<const Program> chain(bool with_derivatives) {
  Recording recording;
  std::vector<Number> angles;
  for (int i = 0; i < kLinks; ++i) angles.push_back(recording.input("angle" + std::to_string(i)));
  const Vector3<Number> end = end_of_chain(angles);
  std::vector<Number> y = {end[0], end[1], end[2]};
  for (int i = 0; with_derivatives && i < kLinks; ++i) {
    std::vector<Number> direction(kLinks);
    direction[static_cast<size_t>(i)] = 1;
    const std::vector<Number> column = along({end[0], end[1], end[2]}, angles, direction);
    y.insert(y.end(), column.begin(), column.end());
  }
  Program::Outputs outputs;
  for (size_t k = 0; k < y.size(); ++k) outputs.push_back({"y" + std::to_string(k), y[k]});
  return std::make_shared<const Program>(recording, outputs);
}

std::vector<double> angles(int width) {
  std::vector<double> x;
  for (int i = 0; i < kLinks * width; ++i) x.push_back(0.1 + 0.17 * (i % 29));
  return x;
}

void call(benchmark::State& state, Machine machine) {
  const int width = static_cast<int>(state.range(0));
  const Code code(chain(state.range(1) != 0), width, machine);
  std::vector<double> x = angles(width), work(code.work_size());
  std::vector<double> y(code.program().outputs().size() * static_cast<size_t>(width));
  for (auto _ : state) {
    code(x.data(), y.data(), work.data());
    benchmark::DoNotOptimize(y.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * width);
  state.counters["instructions"] = static_cast<double>(code.program().instructions().size());
  state.SetLabel(code.is_machine_code() ? "machine code" : "interpreter");
}
void MachineCode(benchmark::State& state) { call(state, Machine::allowed); }
void Interpreter(benchmark::State& state) { call(state, Machine::refused); }
BENCHMARK(MachineCode)->ArgsProduct({{1, 4, 8}, {0, 1}})->ArgNames({"width", "derivatives"});
BENCHMARK(Interpreter)->ArgsProduct({{1, 4, 8}, {0, 1}})->ArgNames({"width", "derivatives"});

// The exported C, built by cc.
void ExportedC(benchmark::State& state) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  const std::string stem =
      (folder / ("hamel_programs_" + std::to_string(getpid()) + std::to_string(state.range(0))))
          .string();
  std::ofstream(stem + ".c") << c_preamble() << c_function(*chain(state.range(0) != 0), "chain");
  const std::string command =
      "cc -O2 -march=native -ffp-contract=off -shared -fPIC -o " + stem + ".so " + stem + ".c -lm";
  void* const library =
      std::system(command.c_str()) == 0 ? dlopen((stem + ".so").c_str(), RTLD_NOW) : nullptr;
  std::filesystem::remove(stem + ".c");
  std::filesystem::remove(stem + ".so");
  if (!library) return state.SkipWithError("cc does not build the exported C");
  const auto function = reinterpret_cast<void (*)(const double*, double*)>(dlsym(library, "chain"));
  std::vector<double> x = angles(1), y(3 + 3 * kLinks);
  for (auto _ : state) {
    function(x.data(), y.data());
    benchmark::DoNotOptimize(y.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations());
  dlclose(library);
}
BENCHMARK(ExportedC)->Arg(0)->Arg(1)->ArgName("derivatives");

void TemplateOverDouble(benchmark::State& state) {
  std::vector<double> x = angles(1);
  for (auto _ : state) {
    benchmark::DoNotOptimize(x.data());
    benchmark::DoNotOptimize(end_of_chain(x));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(TemplateOverDouble);

// From formulas to code.
void Record(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(chain(true));
}
void Emit(benchmark::State& state) {
  const auto program = chain(true);
  for (auto _ : state) benchmark::DoNotOptimize(Code(program, 1));
}
BENCHMARK(Record)->Unit(benchmark::kMicrosecond);
BENCHMARK(Emit)->Unit(benchmark::kMicrosecond);

}  // namespace
