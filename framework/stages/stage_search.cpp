// The search along a direction of the solver, and its merit.
#include <hamel/framework/stages/stage_newton.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hamel {
namespace {

constexpr double kArmijo = 1e-4, kHalf = 0.5;
constexpr int kMostHalvings = 25, kMemory = 4;

}  // namespace

double StageNewton::longest_primal() const {
  double out = 1;
  for (const StageRows& rows : rows_)
    out = std::min({out, rows.path.longest_primal(), rows.bounds.longest_primal()});
  return out;
}

// Derivative of the merit's cost along the step.
double StageNewton::slope() const {
  double out = 0;
  for (size_t k = 0; k <= last_; ++k) {
    const StageRows& rows = rows_[k];
    out += derivatives_[k].cost_gradient.dot(rows.dx);
    for (const InteriorRows* r : {&rows.path, &rows.bounds})
      for (Eigen::Index i = 0; i < r->s.size(); ++i) out -= mu_ * r->ds[i] / r->s[i];
    if (weight_ > 0 && rows.path.s.size() > 0) {
      out += weight_ * (now_.stages[k].path - rows.path.s)
                           .dot(derivatives_[k].path_jacobian * rows.dx - rows.path.ds);
    }
  }
  if (weight_ > 0 && nu_.size() > 0)
    out += weight_ * now_.goal.dot(goal_jacobian_ * linear_.stages[last_].dz);
  return out;
}

StageNewton::Merit StageNewton::merit(const Values& at, double length) const {
  Merit out{.cost = at.cost, .infeasible = 0};
  for (size_t k = 0; k <= last_; ++k) {
    const StageRows& rows = rows_[k];
    for (const InteriorRows* r : {&rows.path, &rows.bounds})
      for (Eigen::Index i = 0; i < r->s.size(); ++i)
        out.cost -= mu_ * std::log(r->s[i] + length * r->ds[i]);
    out.infeasible += at.stages[k].defect.lpNorm<1>();
    if (rows.path.s.size() == 0) continue;
    const Eigen::VectorXd lacks = at.stages[k].path - rows.path.s - length * rows.path.ds;
    if (weight_ > 0) out.cost += weight_ / 2 * lacks.squaredNorm();
    else out.infeasible += lacks.lpNorm<1>();
  }
  if (weight_ > 0) out.cost += weight_ / 2 * at.goal.squaredNorm();
  else out.infeasible += at.goal.lpNorm<1>();
  return out;
}

// The merit falls along the step: slope - pi infeasible < 0, with a tenth of it to spare.
void StageNewton::raise_penalty(double slope, double infeasible) {
  if (!(infeasible > 0)) return;
  const double needed = slope / (0.9 * infeasible);
  if (needed > penalty_) penalty_ = 1.5 * needed;
}

bool StageNewton::search(double& length) {
  const double along = slope();
  const Merit here = merit(now_, 0);
  raise_penalty(along, here.infeasible);
  if (history_.size() == kMemory) history_.erase(history_.begin());
  history_.push_back(here);
  double reference = std::numeric_limits<double>::lowest();
  for (const Merit& m : history_) reference = std::max(reference, m.cost + penalty_ * m.infeasible);
  const double fall = along - penalty_ * here.infeasible;
  const double noise = 1e-13 * (std::abs(reference) + std::abs(here.cost));
  for (int i = 0; i < kMostHalvings; ++i, length *= kHalf) {
    for (size_t k = 0; k <= last_; ++k) {
      const LinearStage& s = linear_.stages[k];
      problem_.retract(static_cast<int>(k), now_.point.states[k], length * s.dz,
                       trial_.point.states[k]);
      trial_.point.inputs[k] = now_.point.inputs[k] + length * s.du;
    }
    if (!evaluate(trial_)) continue;
    const Merit there = merit(trial_, length);
    if (there.cost + penalty_ * there.infeasible <=
        reference + std::min(0.0, kArmijo * length * fall) + noise)
      return true;
  }
  return false;
}

}  // namespace hamel
