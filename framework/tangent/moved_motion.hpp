// A motion with its variables at some values: its start, and steps from any state. Not installed.
//
// A step repeats an accepted step of the run from its beginning to its end, of one size: h is
// frozen. Implicit equations are solved to their round-off.
#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/tangent/motion_variables.hpp>

namespace hamel {

/// Place and velocity: the element as its Geometry lays it out, and xi.
struct MotionState {
  double time = 0;
  Eigen::VectorXd g, xi;
};

class MovedMotion {
 public:
  /// ConfigError as from build(), and for motions that no tangent is known of; what begins it.
  MovedMotion(const std::string& what, const MotionVariables& variables,
              const Eigen::VectorXd& values);

  const RunPlan& plan() const { return run_.driver().plan(); }
  const Geometry& geometry() const { return *plan().geometry; }
  const MotionState& start() const { return start_; }
  /// The start at other values of the variables that are of the start alone.
  MotionState start_at(const MotionVariables& variables, const Eigen::VectorXd& values);
  /// A step from there to time t. Not ok: it has no solution.
  Status step(const MotionState& from, double t, MotionState& to);
  /// The admissible state next to one, as a start there; false where there is none.
  bool project(MotionState& state);
  /// The kernel of the run itself, which chooses the steps.
  std::unique_ptr<Kernel> kernel() const { return plan().run_kernel()(setup_); }
  MotionState state_of(const Snapshot& node) const;
  std::vector<double> coordinates(const MotionState& state) const;

 private:
  Run run_;
  KernelSetup setup_;
  Config there_;  // that starts at a state
  MotionState start_;
  std::unique_ptr<Kernel> steps_;
  Snapshot node_;
};

/// A displacement of a state: g tau(eta), xi + dxi, and back.
void displace(const Geometry& geometry, const MotionState& from, const Eigen::VectorXd& by,
              double factor, MotionState& to);
/// (eta, dxi) from one state to another near it; false where tau has no inverse there.
bool displacement(const Geometry& geometry, const MotionState& from, const MotionState& to,
                  Eigen::VectorXd& by);

}  // namespace hamel
