#include <hamel/framework/stages/stage_newton.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hamel {
namespace {

constexpr double kProximal = 1e-8;  // rho
constexpr double kDeltaGrowth = 8, kMostDelta = 1e12;
constexpr int kPatience = 60;  // iterations in which the defect does not halve
constexpr double kInfinite = std::numeric_limits<double>::infinity();

double largest(const Eigen::VectorXd& x) { return x.size() == 0 ? 0 : x.lpNorm<Eigen::Infinity>(); }

}  // namespace

bool StageNewton::evaluate(Values& at) {
  at.cost = 0;
  for (size_t k = 0; k <= last_; ++k) {
    const Eigen::VectorXd* next = k < last_ ? &at.point.states[k + 1] : nullptr;
    StageValues& v = at.stages[k];
    if (!problem_.values(static_cast<int>(k), at.point.states[k], at.point.inputs[k], next, v))
      return false;
    at.cost += v.cost;
    if (!v.defect.allFinite() || !v.path.allFinite()) return false;
  }
  if (at.goal.size() > 0) problem_.goal(at.point.states[last_], at.goal);
  return std::isfinite(at.cost) && at.goal.allFinite();
}

bool StageNewton::differentiate() {
  if (weight_ > 0) nu_ = weight_ * now_.goal;
  for (size_t k = 0; k <= last_; ++k) {
    StageDerivatives& d = derivatives_[k];
    for (Eigen::MatrixXd* m : {&d.F, &d.B, &d.hessian, &d.path_jacobian}) m->setZero();
    d.cost_gradient.setZero();
    next_lambda_ = k < last_ ? lambda_[k + 1] : Eigen::VectorXd();
    const Eigen::VectorXd* next = k < last_ ? &now_.point.states[k + 1] : nullptr;
    if (!problem_.derivatives(static_cast<int>(k), now_.point.states[k], now_.point.inputs[k], next,
                              next_lambda_, rows_[k].path.y, d))
      return false;
    if (!d.F.allFinite() || !d.B.allFinite() || !d.hessian.allFinite()) return false;
  }
  goal_jacobian_.setZero();
  goal_hessian_.setZero();
  if (nu_.size() > 0)
    problem_.goal_derivatives(now_.point.states[last_], nu_, goal_jacobian_, goal_hessian_);
  return true;
}

// l' + [F B]^T lambda_{k+1} - (lambda_k, 0) - J^T y, and C^T nu at the end.
void StageNewton::stage_residual(size_t k, Residuals& out) {
  const StageDerivatives& d = derivatives_[k];
  StageRows& rows = rows_[k];
  const StageValues& v = now_.stages[k];
  const int n = sizes_[k].state, inputs = sizes_[k].inputs;
  gradient_ = d.cost_gradient;
  gradient_.noalias() -= d.path_jacobian.transpose() * rows.path.y;
  gradient_.noalias() -= rows.bound_jacobian.transpose() * rows.bounds.y;
  if (k < last_) {
    gradient_.head(n).noalias() += d.F.transpose() * lambda_[k + 1];
    gradient_.tail(inputs).noalias() += d.B.transpose() * lambda_[k + 1];
  } else if (nu_.size() > 0) {
    gradient_.head(n).noalias() += goal_jacobian_.transpose() * nu_;
  }
  if (k > 0) {
    gradient_.head(n) -= lambda_[k];
    out.scale = std::max(out.scale, largest(lambda_[k]));
  } else {
    lambda_[0] = gradient_.head(n);  // not an equation but for the free directions
    gradient_.head(n).setZero();
    if (linear_.start.cols() > 0)
      out.kkt = std::max(out.kkt, largest(linear_.start.transpose() * lambda_[0]));
  }
  out.kkt = std::max(out.kkt, largest(gradient_));
  const double softness = weight_ > 0 ? 1 / weight_ : 0;
  out.defect = std::max(
      {out.defect, largest(v.defect), largest(v.path - rows.path.s + softness * rows.path.y)});
  out.complement =
      std::max({out.complement, rows.path.complement(mu_), rows.bounds.complement(mu_)});
}

StageNewton::Residuals StageNewton::residuals() {
  Residuals out;
  for (size_t k = 0; k <= last_; ++k) stage_residual(k, out);
  if (weight_ == 0) out.defect = std::max(out.defect, largest(now_.goal));
  return out;
}

// (13): mu <- max(tolerance/10, min(mu/5, mu^1.5)) once the problem at mu is solved well enough.
void StageNewton::lower_barrier(const Residuals& r) {
  const double least = options_.tolerance / 10;
  const double reached = r.worst();
  while (mu_ > least && reached < 10 * mu_) {
    mu_ = std::max(least, std::min(mu_ / 5, std::pow(mu_, 1.5)));
    history_.clear();
  }
}

void StageNewton::assemble() {
  const double softness = weight_ > 0 ? 1 / weight_ : 0;
  unit_delta_ = 0;
  for (size_t k = 0; k <= last_; ++k) {
    LinearStage& s = linear_.stages[k];
    const StageDerivatives& d = derivatives_[k];
    s.F = d.F;
    s.B = d.B;
    s.d = now_.stages[k].defect;
    s.H = d.hessian;
    s.g = d.cost_gradient;
    unit_delta_ = std::max(unit_delta_, d.hessian.diagonal().cwiseAbs().maxCoeff());
    rows_[k].path.condense(now_.stages[k].path, d.path_jacobian, mu_, softness, s.H, s.g);
    rows_[k].bounds.condense(rows_[k].bound_values, rows_[k].bound_jacobian, mu_, 0, s.H, s.g);
  }
  unit_delta_ = unit_delta_ > 0 ? 1e-4 * unit_delta_ : 1e-4;
  if (nu_.size() == 0) return;
  // Hard: nu+ = nu + (c + C dz)/rho; elastic: w (c + C dz).
  const double rate = weight_ > 0 ? weight_ : 1 / kProximal;
  LinearStage& s = linear_.stages[last_];
  s.H += goal_hessian_;
  s.H.noalias() += rate * goal_jacobian_.transpose() * goal_jacobian_;
  gradient_ = rate * now_.goal;
  if (weight_ == 0) gradient_ += nu_;
  s.g.noalias() += goal_jacobian_.transpose() * gradient_;
}

bool StageNewton::find_direction(double least_delta) {
  double delta = least_delta;
  while (true) {
    ++sweeps_;
    if (linear_.sweep(delta)) break;
    delta = delta == 0 ? std::max(unit_delta_, delta_ / 3) : kDeltaGrowth * delta;
    if (!(delta < kMostDelta * unit_delta_)) return false;
  }
  delta_ = delta;
  linear_.roll();
  const double softness = weight_ > 0 ? 1 / weight_ : 0;
  for (size_t k = 0; k <= last_; ++k) {
    StageRows& rows = rows_[k];
    const LinearStage& s = linear_.stages[k];
    rows.dx.resize(s.dz.size() + s.du.size());
    rows.dx.head(s.dz.size()) = s.dz;
    rows.dx.tail(s.du.size()) = s.du;
    rows.path.step(now_.stages[k].path, derivatives_[k].path_jacobian, rows.dx, mu_, softness);
    rows.bounds.step(rows.bound_values, rows.bound_jacobian, rows.dx, mu_, 0);
  }
  return linear_.stages[last_].dz.allFinite();
}

void StageNewton::accept(double length) {
  std::swap(now_, trial_);
  double dual = 1;
  for (const StageRows& rows : rows_)
    dual = std::min({dual, rows.path.longest_dual(), rows.bounds.longest_dual()});
  if (nu_.size() > 0 && weight_ == 0) {
    // nu+ of the step, before the point moves: now in trial_.
    gradient_ = trial_.goal;
    gradient_.noalias() += goal_jacobian_ * linear_.stages[last_].dz;
    nu_ += length / kProximal * gradient_;
  }
  for (size_t k = 0; k <= last_; ++k) {
    linear_.multiplier(static_cast<int>(k), next_lambda_);
    lambda_[k] += length * (next_lambda_ - lambda_[k]);
    rows_[k].path.move(length, dual, mu_);
    rows_[k].bounds.move(length, dual, mu_);
    bound_values(k, now_.point.inputs[k], rows_[k].bound_values);
  }
}

bool StageNewton::step() {
  double delta = 0;
  for (int i = 0; i < 4; ++i) {
    if (!find_direction(delta)) {
      reason_ = "the Hessian has no positive correction";
      return false;
    }
    double length = longest_primal();
    if (search(length)) {
      accept(length);
      report(residuals_, length);
      return true;
    }
    history_.pop_back();
    delta = std::max(unit_delta_, 64 * delta_);
  }
  reason_ = "no step along the search direction lessens the merit";
  return false;
}

bool StageNewton::stagnates(double defect) {
  if (defect < 0.5 * least_defect_ || defect < 100 * options_.tolerance) {
    least_defect_ = defect;
    since_least_ = 0;
    return false;
  }
  return ++since_least_ > kPatience;
}

StageNewton::End StageNewton::give_up(const std::string& reason) {
  reason_ = reason;
  return End::stuck;
}

StageNewton::End StageNewton::iterate(double weight) {
  weight_ = weight;
  penalty_ = 1;
  delta_ = 0;
  since_least_ = 0;
  least_defect_ = kInfinite;
  history_.clear();
  if (!evaluate(now_)) return give_up("a step of the guess has no solution");
  start_rows();
  for (const int first = iterations_;; ++iterations_) {
    if (!differentiate()) return give_up("derivatives of a step are not finite");
    residuals_ = residuals();
    if (residuals_.worst() <= options_.tolerance && mu_ <= options_.tolerance) return End::solved;
    if (options_.stop != nullptr && options_.stop->load()) {
      reason_ = "stopped";
      return End::stopped;
    }
    if (iterations_ - first >= options_.iterations) return give_up("too many iterations");
    if (weight_ == 0 && stagnates(residuals_.defect)) return give_up("defects do not lessen");
    lower_barrier(residuals_);
    assemble();
    if (!step()) return End::stuck;
  }
}

void StageNewton::report(const Residuals& r, double length) const {
  if (!options_.progress) return;
  options_.progress({.iteration = iterations_,
                     .objective = now_.cost,
                     .kkt = r.kkt,
                     .defect = r.defect,
                     .barrier = mu_,
                     .step = length});
}

double StageNewton::missed() const {
  double out = largest(now_.goal);
  for (const StageValues& v : now_.stages)
    if (v.path.size() > 0) out = std::max(out, -v.path.minCoeff());
  return out;
}

bool StageNewton::is_least() {
  if (!differentiate()) return false;
  residuals();
  assemble();
  return linear_.sweep(0);
}

void StageNewton::restart(const StagePoint& guess) {
  now_.point = guess;
  for (size_t k = 0; k <= last_; ++k) {
    lambda_[k].setZero();
    set_bounds(static_cast<int>(k));
  }
}

void StageNewton::fill(StageSolution& out) {
  out.point = now_.point;
  out.objective = now_.cost;
  out.kkt = residuals_.kkt;
  out.defect = residuals_.defect;
  out.complement = residuals_.complement;
  out.iterations = iterations_;
  out.sweeps = sweeps_;
  out.multipliers = lambda_;
  out.goal_multipliers = nu_;
  out.missed = now_.goal;
  for (size_t k = 0; k <= last_; ++k) {
    const StageRows& rows = rows_[k];
    out.path_multipliers.push_back(rows.path.y);
    Eigen::VectorXd low = Eigen::VectorXd::Zero(sizes_[k].inputs), high = low;
    for (Eigen::Index i = 0; i < rows.bounds.y.size(); ++i) {
      Eigen::Index input = 0;
      rows.bound_jacobian.row(i).tail(low.size()).cwiseAbs().maxCoeff(&input);
      (i < rows.lows ? low : high)[input] = rows.bounds.y[i];
    }
    out.low_multipliers.push_back(low);
    out.high_multipliers.push_back(high);
    out.gains.push_back(linear_.stages[k].K);
    Eigen::Index row = 0;
    const Eigen::VectorXd& path = now_.stages[k].path;
    if (path.size() > 0 && -path.minCoeff(&row) > out.path_missed) {
      out.path_missed = -path[row];
      out.path_missed_at = static_cast<int>(k);
      out.path_missed_row = static_cast<int>(row);
    }
  }
  // The last assembly precedes the last step: the gains and P_0 of the solution itself.
  if (is_least() || linear_.sweep(delta_)) {
    out.start_information = linear_.start_information();
    for (size_t k = 0; k <= last_; ++k) out.gains[k] = linear_.stages[k].K;
  }
}

}  // namespace hamel
