#include <hamel/framework/tangent/recorded_lift.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hamel {
namespace {

constexpr int kMostCorrections = 12;  // of Newton's method
constexpr double kSolved = 1e-14;

}  // namespace

std::unique_ptr<RecordedLift> RecordedLift::of(const RunPlan& plan) {
  const KernelSetup& setup = plan.setup;
  const Mechanics& mechanics = *plan.system->mechanics;
  auto geometry = recorded_geometry(plan.system->group, plan.config.retraction);
  if (geometry == nullptr || plan.config.scheme != "lift" || setup.composition.size() != 1 ||
      plan.contacts != nullptr)
    return nullptr;
  std::vector<double> element(static_cast<std::size_t>(plan.geometry->size()));
  plan.geometry->from_coordinates(setup.configuration, element.data());
  RecordedFormulas formulas = recorded_formulas(*plan.system, mechanics, element.data());
  if (!formulas) return nullptr;
  std::unique_ptr<RecordedLift> out(new RecordedLift);
  out->plan_ = &plan;
  out->formulas_ = std::move(formulas);
  out->geometry_ = std::move(geometry);
  out->n_ = static_cast<std::size_t>(mechanics.dim());
  out->k_ = static_cast<std::size_t>(mechanics.constraint_count());
  out->held_ = static_cast<std::size_t>(mechanics.holonomic_rows());
  out->inputs_ = setup.inputs == nullptr ? 0 : setup.inputs->fields().size();
  out->columns_ = static_cast<std::size_t>(plan.geometry->columns());
  out->projects_ = out->k_ > 0 && !(mechanics.constant_inertia() &&
                                    mechanics.constant_constraints() && !mechanics.has_drift());
  out->unknowns_ = (out->projects_ ? 3 : 2) * (out->n_ + out->k_);
  std::size_t next = 0;
  const auto place = [&next](std::size_t count) { return std::exchange(next, next + count); };
  Places& at = out->at_;
  at.from = place(out->columns_);
  at.reference = place(out->columns_);
  at.w = place(out->n_);
  at.u = place(out->inputs_);
  at.h = place(1);
  at.t = place(1);
  at.eta = place(out->n_);
  at.zero = place(out->n_);
  at.x = place(out->unknowns_);
  at.lambda = place(2 * out->n_);
  at.rho = place(out->unknowns_);
  at.all = next;
  out->in_.assign(next, 0.0);
  return out;
}

// False where a guard has changed: the record is of another branch.
bool RecordedLift::evaluate(const graph::Code& code, std::size_t guards_at) {
  code(in_.data(), out_.data(), work_.data());
  for (std::size_t i = 0; i < guards_.size(); ++i)
    if ((out_[guards_at + i] < 0) != guards_[i]) return false;
  return true;
}

bool RecordedLift::solve(const MotionState& from, const Eigen::VectorXd& inputs, double h,
                         Unknowns& x) {
  g_ = from.g;
  plan_->geometry->coordinates(from.g.data(), input(at_.from));
  std::copy_n(input(at_.from), columns_, input(at_.reference));
  std::copy_n(from.xi.data(), n_, input(at_.w));
  std::copy_n(inputs.data(), inputs_, input(at_.u));
  *input(at_.h) = h;
  *input(at_.t) = from.time;
  const auto count = static_cast<Eigen::Index>(unknowns_);
  if (x.size() != count) {
    x.setZero(count);
    Eigen::Index at = 0;
    const auto n = static_cast<Eigen::Index>(n_), k = static_cast<Eigen::Index>(k_);
    for (int i = projects_ ? 0 : 1; i < 3; ++i, at += n + k) x.segment(at, n) = from.xi;
  }
  Eigen::Map<Eigen::VectorXd> now(input(at_.x), count);
  now = x;
  if (equation_ == nullptr && !record()) return false;
  for (int i = 0; i < kMostCorrections; ++i) {
    if (!evaluate(*equation_, unknowns_) && (!record() || !evaluate(*equation_, unknowns_)))
      return false;
    for (const Sparse::Entry& e : equation_by_x_.entries) r_x_(e.row, e.column) = out_[e.output];
    factors_.compute(r_x_);
    step_ = factors_.solve(Eigen::Map<const Eigen::VectorXd>(out_.data(), count));
    if (!step_.allFinite()) return false;
    now -= step_;
    if (step_.lpNorm<Eigen::Infinity>() <= 1e-8 * (1 + now.lpNorm<Eigen::Infinity>()) &&
        (i > 0 || step_.lpNorm<Eigen::Infinity>() <= kSolved)) {
      // Newton's next correction is of the square of this one.
      x = now;
      return true;
    }
  }
  return false;
}

bool RecordedLift::end(MotionState& to) const {
  const Geometry& geometry = *plan_->geometry;
  const auto n = static_cast<Eigen::Index>(n_);
  const double s = plan_->setup.s, h = in_[at_.h];
  const double* last = in_.data() + at_.x + unknowns_;
  z_ = h * Eigen::Map<const Eigen::VectorXd>(last - 2 * (n_ + k_), n);
  if (!geometry.in_domain(z_.data())) return false;
  part_.resize(geometry.size());
  to.time = in_[at_.t] + h;
  to.g = g_;
  if (s != 0) {
    to.xi = -s * z_;
    geometry.tau(to.xi.data(), part_.data());
    geometry.inverse(part_.data(), part_.data());
    geometry.compose(to.g.data(), part_.data(), to.g.data());
  }
  z_ *= 1 - s;
  geometry.tau(z_.data(), part_.data());
  geometry.compose(to.g.data(), part_.data(), to.g.data());
  to.xi = Eigen::Map<const Eigen::VectorXd>(last - (n_ + k_), n);
  return true;
}

bool RecordedLift::linearise(std::span<const double> reference) {
  std::ranges::copy(reference, input(at_.reference));
  return linearise();
}

bool RecordedLift::linearise() {
  if (!evaluate(*first_, unknowns_) && (!record() || !evaluate(*first_, unknowns_))) return false;
  for (const Sparse::Entry& e : by_x_.entries) r_x_(e.row, e.column) = out_[e.output];
  for (const Sparse::Entry& e : by_q_.entries) r_q_(e.row, e.column) = out_[e.output];
  for (const Sparse::Entry& e : end_by_x_.entries) s_x_(e.row, e.column) = out_[e.output];
  factors_.compute(r_x_);
  const Eigen::Index x = r_x_.rows(), q = r_q_.cols();
  way_.resize(x + q, q);  // [X; 1]
  way_.topRows(x) = -factors_.solve(r_q_);
  way_.bottomRows(q).setIdentity();
  jacobian_.noalias() = s_x_ * way_.topRows(x);
  for (const Sparse::Entry& e : end_by_q_.entries) jacobian_(e.row, e.column) += out_[e.output];
  return jacobian_.allFinite();
}

const Eigen::MatrixXd& RecordedLift::hessian(const Eigen::VectorXd& lambda) {
  if (!curved_) {  // recorded where it is asked for: fits and tangents never do
    curved_ = true;
    if (!record() || !linearise()) {
      hessian_.setConstant(parameters(), parameters(), std::numeric_limits<double>::quiet_NaN());
      return hessian_;
    }
  }
  step_.noalias() = s_x_.transpose() * lambda;
  rho_ = factors_.transpose().solve(step_);
  rho_ = -rho_;
  std::copy_n(lambda.data(), 2 * n_, input(at_.lambda));
  std::copy_n(rho_.data(), unknowns_, input(at_.rho));
  (*second_)(in_.data(), out_.data(), work_.data());
  half_.setZero(way_.rows(), way_.cols());
  for (const Sparse::Entry& e : curvature_.entries)
    half_.row(e.row) += (e.row == e.column ? 0.5 : 1) * out_[e.output] * way_.row(e.column);
  hessian_.noalias() = way_.transpose() * half_;
  half_ = hessian_.transpose();
  hessian_ += half_;
  return hessian_;
}

}  // namespace hamel
