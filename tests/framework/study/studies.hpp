// Studies for the tests of studies: Suslov's body with a full inertia, in three steps.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hamel/hamel.hpp>

#include "../temporary_folder.hpp"

namespace hamel::test {

inline const StudySystem kFull = {.label = "full inertia",
                                  .name = "suslov",
                                  .parameters = {{"inertia", {2, 0.3, 0.5, 3, 0.4, 4}}},
                                  .start = {.velocity = {1, 0.5, 0}}};

inline StudyConfig small() {
  StudyConfig config;
  config.until = 2;
  config.repeats = 1;
  config.systems = {kFull};
  config.axes["step"] = {0.1, 0.05, 0.025};
  return config;
}

inline StudyResult run(const StudyConfig& config) {
  return Study(registry(), config).threads(2).run();
}

/// The mistakes for which a study is refused.
inline std::vector<std::string> mistakes_of(const StudyConfig& config) {
  try {
    Study(registry(), config);
  } catch (const ConfigError& error) {
    return error.mistakes();
  }
  return {};
}

/// Suslov's body without its exact motion.
struct Forgetful {
  using Group = SO3;
  std::vector<double> moments = {2, 0.3, 0.5, 3, 0.4, 4};
  static std::string name() { return "forgetful"; }
  Mat<3, 3> inertia() const { return Suslov{.moments = moments}.inertia(); }
  Mat<1, 3> constraints() const { return {0, 0, 1}; }
};

/// `small()` of a body without an exact motion, in a registry that has it.
inline Registry with_forgetful() {
  Registry all = registry();
  add_system<Forgetful>(all);
  return all;
}
inline StudyConfig forgetful() {
  StudyConfig config = small();
  config.systems = {{.label = "forgetful", .name = "forgetful", .start = kFull.start}};
  return config;
}

}  // namespace hamel::test
