// The motions on which the verification tests measure: full inertia, a tilted axis, sleigh, disk.
#pragma once

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include <hamel/framework/check/scheme_laws.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel::verification {

struct Motion {
  std::string name;
  SchemeCase base;  // system, parameters, start, step, until
};

inline void PrintTo(const Motion& motion, std::ostream* out) { *out << motion.name; }

inline const std::vector<Motion>& motions() {
  static const std::vector<Motion> all = {
      {"suslov, full inertia",
       {.system = "suslov",
        .parameters = {{"inertia", {2, .3, .5, 3, .4, 4}}},
        .start = {.velocity = {1, 0.5, 0}},
        .step = 0.05,
        .until = 2}},
      {"suslov, full inertia and tilted axis",
       {.system = "suslov",
        .parameters = {{"inertia", {2, .3, .5, 3, .4, 4}}, {"normal", {0.3, -0.5, 0.8}}},
        .start = {.velocity = {1, 0.9, 0.1875}},
        .step = 0.05,
        .until = 2}},
      {"chaplygin_sleigh",
       {.system = "chaplygin_sleigh",
        .start = {.velocity = {0.9, -1, 0}},
        .step = 0.05,
        .until = 2}},
      {"rolling_disk",
       {.system = "rolling_disk", .start = {.velocity = {0.7, 1, 0, 2}}, .step = 0.05, .until = 2}},
  };
  return all;
}

inline bool has_motion(const std::string& system) {
  return std::any_of(motions().begin(), motions().end(),
                     [&](const Motion& m) { return m.base.system == system; });
}

/// Each s that a scheme is run with: four where it uses s, else one.
inline std::vector<double> values_of_s(const SchemeInfo& scheme) {
  return scheme.uses_s ? std::vector<double>{0, 0.25, 0.5, 1} : std::vector<double>{0};
}

}  // namespace hamel::verification
