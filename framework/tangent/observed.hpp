// Quantities of a motion that were measured: its columns by name or number, and formulas of them
// and of parameters. Not installed.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/run/data/event_formula.hpp>
#include <hamel/framework/tangent/moved_motion.hpp>

namespace hamel {

/// Numbers of a state beside a recording, each a formula; of motions with other parameters too.
class ObservedQuantities {
 public:
  ObservedQuantities() = default;
  /// The quantity of this name or formula. ConfigError begins with where.
  void add(const SystemModel& system, const std::string& where, const std::string& formula);
  std::size_t size() const { return formulas_.size(); }
  const std::string& unit(std::size_t i) const { return units_[i]; }

  void operator()(const MovedMotion& motion, const MotionState& state, Eigen::VectorXd& out);
  /// Forgets the motions that there were.
  void clear() { values_.clear(); }

 private:
  using Value = StateVariables::Value;  // empty: the energy
  static Value value_of(const SystemModel& system, const std::string& formula);

  std::vector<std::string> formulas_, units_;
  std::map<const MovedMotion*, std::vector<Value>> values_;
};

}  // namespace hamel
