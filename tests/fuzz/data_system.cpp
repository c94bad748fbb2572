// Fuzz target: a system by data, read, planned, and run for two steps.
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/run/own_system.hpp>
#include <hamel/framework/run/run/simulation.hpp>

#include "registry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hamel;
  constexpr int kMostFuzzed = 40;  // a step takes n^3 operations
  fuzz::accept_or_refuse([&] {
    const std::string text = fuzz::text_of(data, size);
    const SystemModel model = data_system(fuzz::registry(), text, "fuzz.toml");
    if (model.group.dim > kMostFuzzed) return;
    const std::string retraction = fuzz::registry().retractions_or_common(model.group.name).front();
    Simulation(fuzz::registry(), "fuzz.toml",
               OwnSystem{data_system_maker(fuzz::registry(), "fuzz.toml", text)})
        .retraction(retraction)
        .until(0.02)
        .run()
        .record();
  });
  return 0;
}
