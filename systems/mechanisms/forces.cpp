#include <hamel/systems/mechanisms/forces.hpp>

#include <algorithm>

namespace hamel::mechanisms {

bool Forces::damped() const {
  return std::any_of(springs.begin(), springs.end(),
                     [](const Spring& s) { return s.damping != 0; });
}
bool Forces::time_dependent() const {
  const auto changes = [](const auto& part) { return part.time_dependent; };
  return std::ranges::any_of(motors, changes) || std::ranges::any_of(forces, changes);
}
bool Forces::any() const { return has_signals() || damped(); }

}  // namespace hamel::mechanisms
