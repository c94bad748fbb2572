#include <hamel/framework/tangent/moved_motion.hpp>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {
namespace {

// Motions whose tangent would be a wrong number.
void refuse_uncovered(const std::string& what, const RunPlan& plan) {
  std::vector<std::string> mistakes;
  const std::string& name = plan.system->name;
  if (plan.geometry == nullptr)
    mistakes.push_back(fmt::format("{}: the group of {} is not registered", what, name));
  if (plan.contacts != nullptr)
    mistakes.push_back(
        fmt::format("{}: contacts of {} may slide or open: there is no tangent through an impact "
                    "or a switch of "
                    "contacts yet; leave friction and restitution unset",
                    what, name));
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

}  // namespace

MovedMotion::MovedMotion(const std::string& what, const MotionVariables& variables,
                         const Eigen::VectorXd& values)
    : run_(variables.with(values).build()) {
  refuse_uncovered(what, plan());
  map_ =
      std::make_unique<StepMap>(std::shared_ptr<const RunPlan>(std::shared_ptr<void>(), &plan()));
  start_ = start_at(variables, values);
}

Run MovedMotion::run_of(const MotionVariables& variables, const Eigen::VectorXd& values) const {
  Run out = variables.with(values).build();
  out.restart({.configuration = map_->coordinates(start_),
               .velocity = {start_.xi.data(), start_.xi.data() + start_.xi.size()},
               .momentum = {}});
  return out;
}

MotionState MovedMotion::start_at(const MotionVariables& variables, const Eigen::VectorXd& values) {
  const Start start = variables.start_of(run_, values);
  return map_->state_of(plan().config.from, start.configuration, start.velocity);
}

}  // namespace hamel
