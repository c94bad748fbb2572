// Fuzz target: a mechanism by parts, read, assembled, and run for two steps.
#include <hamel/framework/run/run/own_system.hpp>
#include <hamel/framework/run/run/simulation.hpp>
#include <hamel/systems/mechanisms/mechanism_file.hpp>

#include "registry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hamel;
  constexpr int kMostFuzzed = 40;  // a step takes n^3 operations
  fuzz::accept_or_refuse([&] {
    const std::string text = fuzz::text_of(data, size);
    const auto read = [text](const Parameters& given) {
      return mechanism_from(text, "fuzz.toml", given);
    };
    if (read({}).group.dim > kMostFuzzed) return;
    Simulation(fuzz::registry(), "fuzz.toml", OwnSystem{read})
        .scheme("rkmk4")
        .retraction("exp")
        .step(0.01)
        .until(0.02)
        .run()
        .record();
  });
  return 0;
}
