#include <hamel/framework/tangent/step_map.hpp>

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace hamel {
namespace {

std::span<const double> numbers(const Eigen::VectorXd& x) {
  return {x.data(), static_cast<std::size_t>(x.size())};
}

// The kernel of steps of any given size.
std::unique_ptr<Kernel> kernel_of_steps(const RunPlan& plan) {
  KernelSetup setup = plan.setup;
  setup.errors = {};
  setup.first_chosen = false;
  setup.tolerance = std::numeric_limits<double>::epsilon();
  return plan.run_kernel()(setup);
}

}  // namespace

StepMap::StepMap(std::shared_ptr<const RunPlan> plan, std::vector<std::size_t> inputs)
    : plan_(std::move(plan)),
      inputs_(std::move(inputs)),
      kernel_(kernel_of_steps(*plan_)),
      n_(plan_->geometry->dim()),
      k_(plan_->system->mechanics->constraint_count()),
      m_(n_ - k_),
      config_there_(plan_->config),
      inertia_(n_, n_),
      rows_(k_, n_),
      drift_(k_),
      way_(plan_->geometry->size()) {
  const Mechanics& mechanics = *plan_->system->mechanics;
  constant_ =
      mechanics.constant_inertia() && mechanics.constant_constraints() && !mechanics.has_drift();
}

MotionState StepMap::start() const {
  return state_of(plan_->config.from, plan_->setup.configuration, plan_->setup.velocity);
}

MotionState StepMap::state_of(double t, std::span<const double> coordinates,
                              std::span<const double> velocity) const {
  MotionState out;
  set_state(t, coordinates, velocity, out);
  return out;
}

void StepMap::set_state(double t, std::span<const double> coordinates,
                        std::span<const double> velocity, MotionState& out) const {
  out.time = t;
  out.g.resize(geometry().size());
  geometry().from_coordinates(coordinates, out.g.data());
  out.xi = Eigen::Map<const Eigen::VectorXd>(velocity.data(),
                                             static_cast<Eigen::Index>(velocity.size()));
}

std::vector<double> StepMap::coordinates(const MotionState& state) const {
  std::vector<double> out(static_cast<std::size_t>(geometry().columns()));
  geometry().coordinates(state.g.data(), out.data());
  return out;
}

void StepMap::set_inputs(const Eigen::VectorXd& values) {
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    plan_->setup.inputs->set(inputs_[i], values[static_cast<Eigen::Index>(i)]);
}

Status StepMap::step(const MotionState& from, double t, MotionState& to) {
  const double h = t - from.time;
  kernel_->restart(from.time, coordinates(from), numbers(from.xi), h);
  kernel_->set_end_time(t);
  while (std::abs(t - kernel_->time()) > 1e-12 * std::abs(h)) {  // parts, where an input jumps
    const double before = kernel_->time();
    if (Status status = kernel_->advance(1); !status.ok) return status;
    if (kernel_->time() == before) break;
  }
  kernel_->node(node_);
  to = state_of(t, node_.coordinates, node_.velocity);
  return {};
}

bool StepMap::make_admissible(MotionState& state) {
  config_there_.from = state.time;
  config_there_.start = {
      coordinates(state), {state.xi.data(), state.xi.data() + state.xi.size()}, {}};
  Mistakes mistakes;
  PlannedStart planned = plan_start(*plan_->system, config_there_, mistakes);
  if (mistakes.none())
    evaluate_start(*plan_->system, plan_->setup.inputs, &geometry(), config_there_, planned,
                   mistakes);
  if (!mistakes.none()) return false;
  project_start(*plan_->system, planned);
  state = state_of(state.time, planned.start.configuration, planned.start.velocity);
  return true;
}

void StepMap::evaluate_matrices(double t, const double* element) {
  plan_->system->mechanics->inertia(element, inertia_);
  plan_->system->mechanics->constraints(t, element, rows_, drift_);
}

// xi - I^-1 A^T (A I^-1 A^T)^-1 (A xi - b).
void StepMap::project(MotionState& state) {
  if (k_ == 0) return;
  evaluate_matrices(state.time, state.g.data());
  weighted_ = inertia_.ldlt().solve(rows_.transpose());
  state.xi -= weighted_ * (rows_ * weighted_).ldlt().solve(rows_ * state.xi - drift_);
}

void StepMap::set(Frame& frame, const MotionState& state) {
  if (constant_ && frame.basis.size() > 0) return;
  if (frame.state.time == state.time && frame.state.g.size() == state.g.size() &&
      frame.state.g == state.g)
    return;
  frame.state = state;
  evaluate_matrices(state.time, state.g.data());
  // I = L L^T: E = L^-T Q, Q orthonormal with A L^-T Q = 0. Cholesky's factor and the reflections
  // follow a change of units D of xi: L' = D^-1 L, Q' = Q, E' = D E.
  const Eigen::LLT<Eigen::MatrixXd> factors(inertia_);
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n_, n_);
  if (k_ > 0) {
    weighted_ = factors.matrixL().solve(rows_.transpose());
    all = Eigen::HouseholderQR<Eigen::MatrixXd>(weighted_).householderQ();
  }
  frame.basis = factors.matrixU().solve(all.rightCols(m_));
  frame.inverse = frame.basis.transpose() * inertia_;
}

const Eigen::MatrixXd& StepMap::basis(const MotionState& state) {
  Frame& base = frames_[stage_].base;
  set(base, state);
  return base.basis;
}

const Eigen::MatrixXd& StepMap::left_inverse(const MotionState& state) {
  Frame& target = frames_[stage_].target;
  set(target, state);
  return target.inverse;
}

void StepMap::retract(const MotionState& state, const Eigen::VectorXd& increment,
                      MotionState& out) {
  const Eigen::MatrixXd& E = basis(state);
  out = state;
  out.xi += E * increment.segment(n_, m_);
  eta_ = increment.head(n_);
  if ((eta_.array() == 0).all()) return;
  geometry().tau(eta_.data(), way_.data());
  geometry().compose(state.g.data(), way_.data(), out.g.data());
  geometry().normalise(out.g.data());
  if (!constant_) project(out);
}

bool StepMap::difference(const MotionState& from, const MotionState& to, Eigen::VectorXd& out) {
  const Eigen::MatrixXd& inverse = left_inverse(from);
  geometry().inverse(from.g.data(), way_.data());
  geometry().compose(way_.data(), to.g.data(), way_.data());
  out.resize(n_ + m_);
  if (!geometry().tau_inverse(way_.data(), out.data())) return false;
  out.tail(m_) = inverse * (to.xi - from.xi);
  return true;
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
