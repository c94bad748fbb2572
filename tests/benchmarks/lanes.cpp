// Bodies in lanes beside the scalar kernel: suslov with full inertia, lift and rkmk4 with Cayley.
// items_per_second counts steps of bodies; the ratio of the two is what lanes gain on a core.
#include <benchmark/benchmark.h>

#include <hamel/hamel.hpp>

namespace {

constexpr long kSteps = 1000;

const hamel::Mechanics& mechanics() {
  static const auto all = [] {
    hamel::Suslov body;
    body.moments = {2, 0.3, 0.5, 3, 0.4, 4};
    return hamel::erase(body).mechanics;
  }();
  return *all;
}
std::vector<hamel::KernelSetup> setups(int count, double step) {
  std::vector<hamel::KernelSetup> out(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    hamel::KernelSetup& setup = out[static_cast<size_t>(i)];
    hamel::Suslov body;
    body.moments = {2, 0.3 + 0.01 * i, 0.5, 3, 0.4, 4};
    setup.mechanics = hamel::erase(body).mechanics;
    setup.step = step;
    setup.velocity = {1, 0.5, 0};
    setup.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  }
  return out;
}

// To the attractor and on, where one correction is enough.
void scalar(benchmark::State& state, const char* scheme) {
  const auto kernel =
      (*hamel::registry().kernel("so3", mechanics(), "cayley", scheme))(setups(1, 0.02).front());
  for (auto _ : state) benchmark::DoNotOptimize(kernel->advance(kSteps).ok);
  state.SetItemsProcessed(state.iterations() * kSteps);
}
void lanes(benchmark::State& state, const char* scheme) {
  const hamel::LaneInfo* info = hamel::registry().lanes("so3", mechanics(), "cayley", scheme);
  const auto all = info->make(setups(info->lanes, 0.02));
  for (auto _ : state) all->advance(kSteps);
  state.SetItemsProcessed(state.iterations() * kSteps * info->lanes);
  state.SetLabel(info->instructions);
}

// The first steps of members, each with a new Jacobian.
constexpr long kFirst = 40;
void scalar_first(benchmark::State& state) {
  const auto start = setups(1, 0.1).front();
  const auto kernel = (*hamel::registry().kernel("so3", mechanics(), "cayley", "lift"))(start);
  for (auto _ : state) {
    kernel->restart(0, start.configuration, start.velocity, start.step);
    benchmark::DoNotOptimize(kernel->advance(kFirst).ok);
  }
  state.SetItemsProcessed(state.iterations() * kFirst);
}
void lanes_first(benchmark::State& state) {
  const hamel::LaneInfo* info = hamel::registry().lanes("so3", mechanics(), "cayley", "lift");
  const auto starts = setups(info->lanes, 0.1);
  const auto all = info->make(starts);
  for (auto _ : state) {
    all->restart(starts);
    all->advance(kFirst);
  }
  state.SetItemsProcessed(state.iterations() * kFirst * info->lanes);
  state.SetLabel(info->instructions);
}

BENCHMARK_CAPTURE(scalar, lift, "lift");
BENCHMARK_CAPTURE(lanes, lift, "lift");
BENCHMARK_CAPTURE(scalar, rkmk4, "rkmk4");
BENCHMARK_CAPTURE(lanes, rkmk4, "rkmk4");
BENCHMARK(scalar_first);
BENCHMARK(lanes_first);

}  // namespace
