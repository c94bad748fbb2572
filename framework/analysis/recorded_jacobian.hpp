// Exact derivatives of recorded accelerations (motion_formulas.hpp). Not installed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/analysis/motion_formulas.hpp>
#include <hamel/framework/graph/code.hpp>

namespace hamel {

/// Derivatives of xi', column by column, as a program of t, coordinates, velocities and inputs.
class RecordedJacobian {
 public:
  /// of: "velocity", "configuration" (along g tau(e_j x)), "time" or an input.
  RecordedJacobian(const MotionFormulas& motion, const std::string& of);
  std::vector<double> operator()(const std::vector<double>& at) const;

 private:
  std::optional<graph::Code> code_;
};

}  // namespace hamel
