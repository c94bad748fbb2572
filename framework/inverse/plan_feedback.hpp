// Feedback along a plan: time-varying linear gains from the last sweep of its solver. Not
// installed.
//
//   u = u_k + K_k e,   e = (eta, dy) from the plan's state z_k to the state (step_map.hpp)
// K_k is that of the quadratic problem around the plan (stage_solver.hpp): to first order the
// inputs of the plan from the state on (neighbouring optimal control). Source: Bryson and Ho,
// Applied Optimal Control (1975), 6.4.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/inverse/plan_stages.hpp>
#include <hamel/framework/stages/stage_solver.hpp>

namespace hamel {

class PlanFeedback {
 public:
  PlanFeedback(std::unique_ptr<PlanStages> stages, const StageSolution& solution,
               std::vector<std::string> inputs);

  /// Within the bounds of the inputs. Throws std::invalid_argument where the numbers are no state.
  std::vector<double> inputs(long step, std::span<const double> configuration,
                             std::span<const double> velocity);
  /// "t" and, for each input, derivatives by eta and by xi - xi_k, named as the velocities are.
  std::string csv();

 private:
  MotionState planned(long step) const;

  std::unique_ptr<PlanStages> stages_;
  std::vector<std::string> names_;
  std::vector<Eigen::VectorXd> states_, inputs_;
  std::vector<Eigen::MatrixXd> gains_;  // by (eta, dy)
};

}  // namespace hamel
