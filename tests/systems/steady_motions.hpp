// Steady motions of registered systems, as their tests ask for them.
#pragma once

#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel::test {

inline SystemModel model(const std::string& name) { return registry().system(name)->make({}); }
inline SteadyMotion at_speed(const SystemModel& system, double speed) {
  return steady_motion(registry(), system, system.start_at_speed(speed, 0));
}

inline double nearest(const std::vector<std::complex<double>>& all, std::complex<double> value) {
  double least = 1e9;
  for (const auto& x : all) least = std::min(least, std::abs(x - value));
  return least;
}

}  // namespace hamel::test
