#include <hamel/framework/tangent/moved_motion.hpp>

#include <cmath>
#include <limits>

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
    mistakes.push_back(fmt::format(
        "{}: contacts of {} may slide or open: the change of mode has no tangent yet; leave "
        "friction and restitution unset",
        what, name));
  if (!plan.config.events.empty() || !plan.config.stop_at.empty())
    mistakes.push_back(fmt::format(
        "{}: events and stops have no tangent yet: leave events and stop_at out", what));
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

}  // namespace

MovedMotion::MovedMotion(const std::string& what, const MotionVariables& variables,
                         const Eigen::VectorXd& values)
    : run_(variables.with(values).build()) {
  refuse_uncovered(what, plan());
  setup_ = plan().setup;
  there_ = plan().config;
  KernelSetup fixed = setup_;
  fixed.errors = {};
  fixed.first_chosen = false;
  fixed.tolerance = std::numeric_limits<double>::epsilon();
  steps_ = plan().run_kernel()(fixed);
  start_ = start_at(variables, values);
  std::vector<double> xi(start_.xi.data(), start_.xi.data() + start_.xi.size());
  setup_.configuration = coordinates(start_);
  setup_.velocity = xi;
}

MotionState MovedMotion::start_at(const MotionVariables& variables, const Eigen::VectorXd& values) {
  const Start start = variables.start_of(run_, values);
  MotionState out;
  out.time = plan().config.from;
  out.g.resize(geometry().size());
  geometry().from_coordinates(start.configuration, out.g.data());
  out.xi = Eigen::Map<const Eigen::VectorXd>(start.velocity.data(),
                                             static_cast<Eigen::Index>(start.velocity.size()));
  return out;
}

MotionState MovedMotion::state_of(const Snapshot& node) const {
  MotionState out;
  out.time = node.time;
  out.g.resize(geometry().size());
  geometry().from_coordinates(node.coordinates, out.g.data());
  out.xi = Eigen::Map<const Eigen::VectorXd>(node.velocity.data(),
                                             static_cast<Eigen::Index>(node.velocity.size()));
  return out;
}

std::vector<double> MovedMotion::coordinates(const MotionState& state) const {
  std::vector<double> out(static_cast<size_t>(geometry().columns()));
  geometry().coordinates(state.g.data(), out.data());
  return out;
}

bool MovedMotion::project(MotionState& state) {
  const RunPlan& of = plan();
  there_.from = state.time;
  there_.start = {coordinates(state), {state.xi.data(), state.xi.data() + state.xi.size()}, {}};
  Mistakes mistakes;
  PlannedStart planned = plan_start(*of.system, there_, mistakes);
  if (mistakes.none())
    evaluate_start(*of.system, of.setup.inputs, &geometry(), there_, planned, mistakes);
  if (!mistakes.none()) return false;
  project_start(*of.system, planned);
  geometry().from_coordinates(planned.start.configuration, state.g.data());
  state.xi = Eigen::Map<const Eigen::VectorXd>(planned.start.velocity.data(), state.xi.size());
  return true;
}

Status MovedMotion::step(const MotionState& from, double t, MotionState& to) {
  const double h = t - from.time;
  steps_->restart(from.time, coordinates(from),
                  {from.xi.data(), static_cast<size_t>(from.xi.size())}, h);
  steps_->set_end_time(t);
  while (std::abs(t - steps_->time()) > 1e-12 * std::abs(h)) {  // parts, where an input jumps
    const double before = steps_->time();
    if (Status status = steps_->advance(1); !status.ok) return status;
    if (steps_->time() == before) break;
  }
  steps_->node(node_);
  to = state_of(node_);
  to.time = t;
  return {};
}

void displace(const Geometry& geometry, const MotionState& from, const Eigen::VectorXd& by,
              double factor, MotionState& to) {
  const Eigen::Index n = from.xi.size();
  to.time = from.time;
  const Eigen::VectorXd eta = factor * by.head(n);
  to.g.resize(from.g.size());
  geometry.tau(eta.data(), to.g.data());
  geometry.compose(from.g.data(), to.g.data(), to.g.data());
  to.xi = from.xi + factor * by.tail(n);
}

bool displacement(const Geometry& geometry, const MotionState& from, const MotionState& to,
                  Eigen::VectorXd& by) {
  const Eigen::Index n = from.xi.size();
  by.resize(2 * n);
  Eigen::VectorXd way(from.g.size());
  geometry.inverse(from.g.data(), way.data());
  geometry.compose(way.data(), to.g.data(), way.data());
  if (!geometry.tau_inverse(way.data(), by.data())) return false;
  by.tail(n) = to.xi - from.xi;
  return true;
}

}  // namespace hamel
