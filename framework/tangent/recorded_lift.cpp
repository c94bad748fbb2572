#include <hamel/framework/tangent/recorded_lift.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <hamel/framework/mechanics/natural_units.hpp>

namespace hamel {
namespace {

constexpr int kMostCorrections = 12;  // of Newton's method
// Corrections of velocities over a step, in natural units. Newton's next one is of the square, and
// multipliers are linear in velocities.
constexpr double kNearlySolved = 1e-9, kSolved = 1e-13;

}  // namespace

std::unique_ptr<RecordedLift> RecordedLift::of(const RunPlan& plan, Order order) {
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
  const std::vector<double> units =
      natural_units(components_of(*plan.system), mechanics, element.data());
  out->units_ = Eigen::Map<const Eigen::VectorXd>(units.data(), mechanics.dim());
  out->curved_ = order == Order::second;
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
bool RecordedLift::holds(std::size_t at, Which which) {
  const Record& record = *records_[at];
  (*(record.*which))(in_.data(), out_.data(), work_.data());
  for (std::size_t i = 0; i < record.guards.size(); ++i)
    if ((out_[unknowns_ + i] < 0) != record.guards[i]) return false;
  return true;
}

// Of the record in use, else of another one that holds here, else of a new one.
bool RecordedLift::evaluate(Which which) {
  for (std::size_t i = records_.size(); i-- > 0;) {
    if (!holds(i, which)) continue;
    if (i + 1 < records_.size()) {
      std::swap(records_[i], records_.back());
      clear_matrices();
    }
    return true;
  }
  return record() && holds(records_.size() - 1, which);
}

// Entries that another record has.
void RecordedLift::clear_matrices() {
  const auto x = static_cast<Eigen::Index>(unknowns_);
  r_x_.setZero(x, x);
  s_x_.setZero(2 * static_cast<Eigen::Index>(n_), x);
}

void RecordedLift::set(const MotionState& from, const Eigen::VectorXd& inputs, double h,
                       const Unknowns& x) {
  g_ = from.g;
  plan_->geometry->coordinates(from.g.data(), input(at_.from));
  std::copy_n(from.xi.data(), n_, input(at_.w));
  std::copy_n(inputs.data(), inputs_, input(at_.u));
  *input(at_.h) = h;
  *input(at_.t) = from.time;
  std::copy_n(x.data(), unknowns_, input(at_.x));
}

// step_ = R_x^-1 R.
void RecordedLift::find_correction() {
  factors_.compute(r_x_, static_cast<Eigen::Index>(n_ + k_));
  step_ = Eigen::Map<const Eigen::VectorXd>(out_.data(), static_cast<Eigen::Index>(unknowns_));
  factors_.solve(step_);
}

bool RecordedLift::is_small(double size) const {
  const double h = std::abs(in_[at_.h]);
  const Eigen::Index n = units_.size(), each = static_cast<Eigen::Index>(n_ + k_);
  double largest = 0;
  for (Eigen::Index at = 0; at < step_.size(); at += each)
    largest =
        std::max(largest, step_.segment(at, n).cwiseQuotient(units_).lpNorm<Eigen::Infinity>());
  return h * largest <= size;
}

bool RecordedLift::solve(const MotionState& from, const Eigen::VectorXd& inputs, double h,
                         Unknowns& x) {
  const auto count = static_cast<Eigen::Index>(unknowns_);
  if (x.size() != count) {
    x.setZero(count);
    Eigen::Index at = 0;
    const auto n = static_cast<Eigen::Index>(n_), k = static_cast<Eigen::Index>(k_);
    for (int i = projects_ ? 0 : 1; i < 3; ++i, at += n + k) x.segment(at, n) = from.xi;
  }
  set(from, inputs, h, x);
  std::copy_n(input(at_.from), columns_, input(at_.reference));
  Eigen::Map<Eigen::VectorXd> now(input(at_.x), count);
  for (int i = 0; i < kMostCorrections; ++i) {
    if (!evaluate(&Record::equation)) return false;
    for (const Sparse::Entry& e : records_.back()->equation_by_x.entries)
      r_x_(e.row, e.column) = out_[e.output];
    find_correction();
    if (!step_.allFinite()) return false;
    now -= step_;
    if (i > 0 && is_small(kNearlySolved)) {
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

bool RecordedLift::linearise(const MotionState& from, const Eigen::VectorXd& inputs, double h,
                             Unknowns& x, std::span<const double> reference) {
  if (x.size() == static_cast<Eigen::Index>(unknowns_)) {
    set(from, inputs, h, x);
    if (linearise(reference) && is_small(kSolved)) return true;
  }
  return solve(from, inputs, h, x) && linearise(reference);
}

// Transposed: a column of way_, and of slopes_, is a row of X, and of the derivatives of the end.
bool RecordedLift::linearise() {
  if (!evaluate(&Record::first)) return false;
  const Record& record = *records_.back();
  for (const Sparse::Entry& e : record.by_x.entries) r_x_(e.row, e.column) = out_[e.output];
  find_correction();
  way_.setZero(parameters(), static_cast<Eigen::Index>(unknowns_));
  for (const Sparse::Entry& e : record.by_q.entries) way_(e.column, e.row) = -out_[e.output];
  factors_.solve_rows(way_);
  slopes_.setZero(parameters(), s_x_.rows());
  for (const Sparse::Entry& e : record.end_by_x.entries) {
    s_x_(e.row, e.column) = out_[e.output];
    slopes_.col(e.row) += out_[e.output] * way_.col(e.column);
  }
  for (const Sparse::Entry& e : record.end_by_q.entries) slopes_(e.column, e.row) += out_[e.output];
  jacobian_ = slopes_.transpose();
  return jacobian_.allFinite();
}

// Of the lower triangle of L'', half its diagonal: the sum over rows i of [X; 1]_i^T (L'' [X;
// 1])_i, and its transpose.
const Eigen::MatrixXd& RecordedLift::hessian(const Eigen::VectorXd& lambda) {
  const Record& record = *records_.back();
  rho_.setZero(static_cast<Eigen::Index>(unknowns_));
  for (const Sparse::Entry& e : record.end_by_x.entries)
    rho_[e.column] -= s_x_(e.row, e.column) * lambda[e.row];
  factors_.solve_transposed(rho_);
  std::copy_n(lambda.data(), 2 * n_, input(at_.lambda));
  std::copy_n(rho_.data(), unknowns_, input(at_.rho));
  (*record.second)(in_.data(), out_.data(), work_.data());
  const auto unknowns = static_cast<Eigen::Index>(unknowns_);
  half_.setZero(parameters(), parameters());
  const std::vector<Sparse::Entry>& entries = record.curvature.entries;
  for (std::size_t i = 0; i < entries.size();) {
    const Eigen::Index row = entries[i].row;
    row_.setZero(parameters());
    for (; i < entries.size() && entries[i].row == row; ++i) {
      const Sparse::Entry& e = entries[i];
      const double value = (e.row == e.column ? 0.5 : 1) * out_[e.output];
      if (e.column < unknowns) row_ += value * way_.col(e.column);
      else row_[e.column - unknowns] += value;
    }
    if (row >= unknowns) half_.col(row - unknowns) += row_;
    else half_.noalias() += row_ * way_.col(row).transpose();
  }
  hessian_ = half_ + half_.transpose();
  return hessian_;
}

}  // namespace hamel
