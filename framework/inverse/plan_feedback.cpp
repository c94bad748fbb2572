#include <hamel/framework/inverse/plan_feedback.hpp>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace hamel {

PlanFeedback::PlanFeedback(std::unique_ptr<PlanStages> stages, const StageSolution& solution,
                           std::vector<std::string> inputs)
    : stages_(std::move(stages)),
      names_(std::move(inputs)),
      states_(solution.point.states),
      inputs_(solution.point.inputs) {
  for (int k = 0; k < stages_->steps; ++k)
    gains_.push_back(
        solution.gains[static_cast<std::size_t>(k)].leftCols(stages_->map.increments()));
}

MotionState PlanFeedback::planned(long step) const {
  const Eigen::VectorXd& state = states_[static_cast<std::size_t>(step)];
  return stages_->motion_state(stages_->time_of(static_cast<int>(step), state), state);
}

std::vector<double> PlanFeedback::inputs(long step, std::span<const double> configuration,
                                         std::span<const double> velocity) {
  if (step < 0 || step >= stages_->steps)
    throw std::invalid_argument(
        fmt::format("feedback: got step {}, expected 0 to {}", step, stages_->steps - 1));
  StepMap& map = stages_->map;
  if (configuration.size() != static_cast<std::size_t>(map.coordinate_count()) ||
      velocity.size() != static_cast<std::size_t>(map.velocities()))
    throw std::invalid_argument(fmt::format(
        "feedback: got {} coordinates and {} velocities, expected {} and {}", configuration.size(),
        velocity.size(), map.coordinate_count(), map.velocities()));
  const MotionState plan = planned(step);
  Eigen::VectorXd off;
  if (!map.difference(plan, map.state_of(plan.time, configuration, velocity), off))
    throw std::invalid_argument("feedback: the configuration is too far from the plan's");
  const auto at = static_cast<std::size_t>(step);
  Eigen::VectorXd out = inputs_[at] + gains_[at] * off;
  out = out.cwiseMax(stages_->low).cwiseMin(stages_->high);
  return {out.data(), out.data() + out.size()};
}

std::string PlanFeedback::csv() {
  const std::vector<Component> components = components_of(stages_->system());
  std::string out = "t";
  for (const std::string& input : names_) {
    for (const Component& c : components) out += fmt::format(",d({})/d(eta.{})", input, c.name);
    for (const Component& c : components) out += fmt::format(",d({})/d({})", input, c.name);
  }
  out += "\n";
  const Eigen::Index n = stages_->map.velocities();
  for (long k = 0; k < stages_->steps; ++k) {
    const MotionState plan = planned(k);
    const Eigen::MatrixXd& gain = gains_[static_cast<std::size_t>(k)];
    Eigen::MatrixXd row(gain.rows(), 2 * n);
    row << gain.leftCols(n), gain.rightCols(gain.cols() - n) * stages_->map.left_inverse(plan);
    out += fmt::format("{:.17g}", plan.time);
    for (Eigen::Index i = 0; i < row.rows(); ++i)
      for (Eigen::Index j = 0; j < row.cols(); ++j) out += fmt::format(",{:.17g}", row(i, j));
    out += "\n";
  }
  return out;
}

}  // namespace hamel
