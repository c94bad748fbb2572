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
std::vector<hamel::KernelSetup> setups(int count) {
  std::vector<hamel::KernelSetup> out(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) {
    hamel::KernelSetup& setup = out[static_cast<size_t>(i)];
    hamel::Suslov body;
    body.moments = {2, 0.3 + 0.01 * i, 0.5, 3, 0.4, 4};
    setup.mechanics = hamel::erase(body).mechanics;
    setup.step = 0.05;
    setup.velocity = {1, 0.5, 0};
    setup.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  }
  return out;
}

void scalar(benchmark::State& state, const char* scheme) {
  const auto kernel =
      (*hamel::registry().kernel("so3", mechanics(), "cayley", scheme))(setups(1).front());
  for (auto _ : state) benchmark::DoNotOptimize(kernel->advance(kSteps).ok);
  state.SetItemsProcessed(state.iterations() * kSteps);
}
void lanes(benchmark::State& state, const char* scheme) {
  const hamel::LaneInfo* info = hamel::registry().lanes("so3", mechanics(), "cayley", scheme);
  const auto all = info->make(setups(info->lanes));
  for (auto _ : state) all->advance(kSteps);
  state.SetItemsProcessed(state.iterations() * kSteps * info->lanes);
  state.SetLabel(info->instructions);
}

BENCHMARK_CAPTURE(scalar, lift, "lift");
BENCHMARK_CAPTURE(lanes, lift, "lift");
BENCHMARK_CAPTURE(scalar, rkmk4, "rkmk4");
BENCHMARK_CAPTURE(lanes, rkmk4, "rkmk4");

}  // namespace
