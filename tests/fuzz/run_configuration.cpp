// Fuzz target: a run's configuration file, read, written, planned, and run for two steps.
#include <hamel/framework/run/run/simulation.hpp>

#include "registry.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hamel;
  fuzz::accept_or_refuse([&] {
    Config config = Config::from_toml(fuzz::text_of(data, size));
    const std::string text = config.to_toml();
    fuzz::expect(Config::from_toml(text).to_toml() == text, "a configuration that reads back");
    Simulation simulation(fuzz::registry(), config.system);
    simulation.config(config);
    if (!simulation.mistakes().empty()) throw ConfigError(simulation.mistakes());
    config.until = 2 * config.step_or_usual();
    config.on_failure = "stop";  // a step that fails may be halved a thousand times
    simulation.config(config).run().record();
  });
  return 0;
}
