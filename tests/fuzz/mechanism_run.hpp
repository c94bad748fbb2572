// What the targets do with the text of a mechanism.
#pragma once

#include <hamel/framework/run/run/own_system.hpp>
#include <hamel/framework/run/run/simulation.hpp>
#include <hamel/systems/mechanisms/mechanism_file.hpp>

#include "registry.hpp"

namespace hamel::fuzz {

/// Reads and assembles a mechanism, and runs it for two steps.
inline void run_mechanism(const std::string& text) {
  constexpr int kMostFuzzed = 40;  // a step takes n^3 operations
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
}

}  // namespace hamel::fuzz
