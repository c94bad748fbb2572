// A motion with its variables at some values: its start, and its step as a map. Not installed.
//
// A step repeats an accepted step of the run from its beginning to its end, of one size: h is
// frozen.
#pragma once

#include <memory>

#include <Eigen/Core>

#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/tangent/motion_variables.hpp>
#include <hamel/framework/tangent/step_map.hpp>

namespace hamel {

class MovedMotion {
 public:
  /// ConfigError as from build(), and for motions that no tangent is known of; what begins it.
  MovedMotion(const std::string& what, const MotionVariables& variables,
              const Eigen::VectorXd& values);

  const RunPlan& plan() const { return run_.driver().plan(); }
  const Geometry& geometry() const { return *plan().geometry; }
  StepMap& map() { return *map_; }
  const StepMap& map() const { return *map_; }
  const MotionState& start() const { return start_; }
  /// A run of its own from this start: the run itself.
  Run run_of(const MotionVariables& variables, const Eigen::VectorXd& values) const;
  /// The start at other values of the variables that are of the start alone.
  MotionState start_at(const MotionVariables& variables, const Eigen::VectorXd& values);

 private:
  Run run_;
  std::unique_ptr<StepMap> map_;
  MotionState start_;
};

}  // namespace hamel
