// Derivatives of the stages of a plan: of the equation of a step, else differences.
#include <hamel/framework/inverse/plan_stages.hpp>

#include <algorithm>
#include <utility>

namespace hamel {
namespace {

// Differences of order 6: truncation delta^6 f7/140, round-off eps/delta. Of increments and inputs
// in parts of their sizes, of the step in a part of it.
constexpr double kDelta = 3e-3, kInputDelta = 1e-2, kStepDelta = 2e-2;

}  // namespace

Eigen::VectorXd PlanStages::deltas(const Eigen::VectorXd& state,
                                   const Eigen::VectorXd& inputs) const {
  Eigen::VectorXd out(state_increments() + inputs.size());
  out.head(state_increments()) = kDelta * state_scales;
  if (free_time) out[state_increments() - 1] = kStepDelta * step_of(state);
  if (inputs.size() > 0) out.tail(inputs.size()) = kInputDelta * (input_scales + inputs.cwiseAbs());
  return out;
}

bool PlanStages::differentiate(const Values& values, const Eigen::VectorXd& delta,
                               const Eigen::VectorXd& weights, Eigen::MatrixXd& jacobian,
                               Eigen::MatrixXd& hessian) {
  const Eigen::Index count = delta.size();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(count), f;
  if (!values(x, f)) return false;
  const double middle = weights.dot(f);
  jacobian.setZero(f.size(), count);
  hessian.setZero(count, count);
  constexpr double kFactors[] = {45, -9, 1};
  Eigen::VectorXd outer = Eigen::VectorXd::Zero(count);  // sums of both values at 3 delta
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int j = 1; j <= 3; ++j) {
      for (const int sign : {1, -1}) {
        x[i] = sign * j * delta[i];
        if (!values(x, f)) return false;
        jacobian.col(i) += sign * kFactors[j - 1] / (60 * delta[i]) * f;
        if (j == 3) outer[i] += weights.dot(f);
      }
    }
    x[i] = 0;
    hessian(i, i) = (outer[i] - 2 * middle) / (9 * delta[i] * delta[i]);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      double both = 0;
      for (const int sign : {1, -1}) {
        x[i] = sign * 3 * delta[i];
        x[j] = sign * 3 * delta[j];
        if (!values(x, f)) return false;
        both += weights.dot(f);
      }
      x[i] = x[j] = 0;
      hessian(i, j) = hessian(j, i) =
          (both - outer[i] - outer[j] + 2 * middle) / (18 * delta[i] * delta[j]);
    }
  }
  return true;
}

bool PlanStages::has_formulas(int k) const {
  return path_rows(k) > 0 || (k < steps ? running : terminal).value != nullptr;
}

// q = (eta, w, u, h, t) of the equation by the increments (eta, dy, dh) and u: w = xi + E dy, t =
// from + k h.
void PlanStages::by_increments(int k, const Eigen::MatrixXd& basis, const Eigen::MatrixXd& by_q,
                               Eigen::MatrixXd& out) const {
  const Eigen::Index n = map.velocities(), m = map.increments() - n, width = state_increments(),
                     last = by_q.cols() - 1;
  const auto inputs = static_cast<Eigen::Index>(map.inputs().size());
  out.resize(by_q.rows(), width + inputs);
  out.leftCols(n) = by_q.leftCols(n);
  out.middleCols(n, m) = by_q.middleCols(n, n).lazyProduct(basis);
  if (free_time) out.col(width - 1) = by_q.col(last - 1) + k * by_q.col(last);
  for (Eigen::Index i = 0; i < inputs; ++i)
    out.col(width + i) =
        by_q.col(2 * n + static_cast<Eigen::Index>(map.inputs()[static_cast<std::size_t>(i)]));
}

bool PlanStages::step_derivatives(int k, const Eigen::VectorXd& state,
                                  const Eigen::VectorXd& inputs, const Eigen::VectorXd& next,
                                  const Eigen::VectorXd& lambda, StageDerivatives& out) {
  const double h = step_of(state), t = time_of(k, state);
  map.choose_stage(k);
  set_motion_state(t, state, here_);
  map.set_inputs(inputs);
  unknowns_.resize(static_cast<std::size_t>(steps));
  if (!equation_->linearise(here_, map.plan().setup.inputs->at(t), h,
                            unknowns_[static_cast<std::size_t>(k)],
                            {next.data(), static_cast<std::size_t>(map.coordinate_count())}))
    return false;
  const Eigen::Index n = map.velocities(), m = map.increments() - n, width = state_increments();
  set_motion_state(time_of(k + 1, next), next, there_);
  const Eigen::MatrixXd& inverse = map.left_inverse(there_);
  const Eigen::MatrixXd& basis = map.basis(here_);
  by_increments(k, basis, equation_->jacobian(), slopes_);
  out.F.topRows(n) = slopes_.topLeftCorner(n, width);
  out.B.topRows(n) = slopes_.topRightCorner(n, inputs.size());
  out.F.middleRows(n, m) = inverse.lazyProduct(slopes_.bottomLeftCorner(n, width));
  out.B.middleRows(n, m) = inverse.lazyProduct(slopes_.bottomRightCorner(n, inputs.size()));
  if (free_time) out.F(width - 1, width - 1) = 1;
  pulled_.resize(2 * n);
  pulled_.head(n) = lambda.head(n);
  pulled_.tail(n) = inverse.transpose().lazyProduct(lambda.segment(n, m));
  by_increments(k, basis, equation_->hessian(pulled_), slopes_);
  half_ = slopes_.transpose();
  by_increments(k, basis, half_, out.hessian);
  return true;
}

// cost = h (w_t + 1/2 sum w_i u_i^2 + f(q)), or f(q) at the end; q = (eta, xi, t) by the increments
// (eta, dy, dh): xi + E dy, t = from + k h.
bool PlanStages::formula_derivatives(int k, const Eigen::VectorXd& state,
                                     const Eigen::VectorXd& inputs, bool last,
                                     const Eigen::VectorXd& y, StageDerivatives& out) {
  const StateFormula& cost = last ? terminal : running;
  Recorded& recorded = last ? at_last_ : at_stages_;
  if (!std::exchange(recorded.tried, true)) {
    std::vector<RecordedNumber> formulas;
    for (const StateFormula& one : path) formulas.push_back(one.record);
    if (cost) formulas.push_back(cost.record);
    recorded.formulas = RecordedPath::of(map.plan(), formulas);
  }
  if (recorded.formulas == nullptr) return false;
  RecordedPath& f = *recorded.formulas;
  const MotionState here = motion_state(time_of(k, state), state);
  const auto columns = static_cast<std::size_t>(map.coordinate_count());
  const std::span<const double> all(state.data(), static_cast<std::size_t>(numbers_of_motion()));
  if (!f.evaluate(here.time, all.first(columns), all.subspan(columns))) return false;

  const Eigen::Index n = map.velocities(), m = map.increments() - n, width = state_increments(),
                     count = width + inputs.size(), rows = y.size(),
                     paths = static_cast<Eigen::Index>(path.size()), held = std::min(rows, paths);
  const double h = step_of(state), scale = last ? 1 : h;
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(2 * n + 1, count);
  by.topLeftCorner(n, n).setIdentity();
  by.block(n, n, n, m) = map.basis(here);
  if (free_time) by(2 * n, width - 1) = k;
  const Eigen::MatrixXd slopes = f.slopes() * by;
  const Eigen::VectorXd values = f.values();

  out.path_jacobian.setZero(rows, count);
  out.path_jacobian.topRows(held) = slopes.topRows(held);
  for (Eigen::Index i = paths; i < rows; ++i)  // bounds of the step
    out.path_jacobian(i, width - 1) = i == paths ? steps : -steps;
  out.cost_gradient.setZero(count);
  Eigen::VectorXd factors = Eigen::VectorXd::Zero(values.size());
  factors.head(held) = -y.head(held);
  if (cost) {
    factors[paths] = scale;
    out.cost_gradient = scale * slopes.row(paths).transpose();
  }
  out.hessian += by.transpose() * f.hessian(factors) * by;
  if (last) return true;
  Eigen::VectorXd by_step = Eigen::VectorXd::Zero(count);  // slopes of the cost over h
  by_step.tail(inputs.size()) = weights.cwiseProduct(inputs);
  out.cost_gradient += h * by_step;
  out.hessian.diagonal().tail(inputs.size()) += h * weights;
  if (!free_time) return true;
  if (cost) by_step += slopes.row(paths).transpose();
  out.cost_gradient[width - 1] +=
      time_weight + 0.5 * inputs.dot(weights.cwiseProduct(inputs)) + (cost ? values[paths] : 0);
  out.hessian.row(width - 1) += by_step.transpose();
  out.hessian.col(width - 1) += by_step;
  return true;
}

// h (w_t + 1/2 sum w_i u_i^2) in closed form where no formulas are beside it.
bool PlanStages::state_derivatives(int k, const Eigen::VectorXd& state,
                                   const Eigen::VectorXd& inputs, bool last,
                                   const Eigen::VectorXd& y, StageDerivatives& out) {
  const Eigen::Index n = state_increments(), rows = y.size(), count = inputs.size();
  if (!has_formulas(k)) {
    if (last) return true;
    const Eigen::VectorXd weighted = weights.cwiseProduct(inputs);
    out.cost_gradient.tail(count) = step_of(state) * weighted;
    out.hessian.diagonal().tail(count) += step_of(state) * weights;
    if (!free_time) return true;
    out.cost_gradient[n - 1] = time_weight + 0.5 * weighted.dot(inputs);
    out.hessian.block(n - 1, n, 1, count) += weighted.transpose();
    out.hessian.block(n, n - 1, count, 1) += weighted;
    return true;
  }
  if (formula_derivatives(k, state, inputs, last, y, out)) return true;
  Eigen::VectorXd factors(rows + 1), moved, u;
  factors << -y, 1;
  const Values at = [&](const Eigen::VectorXd& increment, Eigen::VectorXd& f) {
    retract(k, state, increment.head(n), moved);
    u = inputs + increment.tail(count);
    state_values(k, moved, u, last, f);
    return f.allFinite();
  };
  Eigen::MatrixXd jacobian, hessian;
  if (!differentiate(at, deltas(state, inputs), factors, jacobian, hessian)) return false;
  out.hessian += hessian;
  out.path_jacobian = jacobian.topRows(rows);
  out.cost_gradient = jacobian.bottomRows(1).transpose();
  return true;
}

bool PlanStages::derivatives(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                             const Eigen::VectorXd* next, const Eigen::VectorXd& lambda,
                             const Eigen::VectorXd& y, StageDerivatives& out) {
  if (next == nullptr) return state_derivatives(k, state, inputs, true, y, out);
  if (equation_ != nullptr && step_derivatives(k, state, inputs, *next, lambda, out))
    return state_derivatives(k, state, inputs, false, y, out);
  const Eigen::Index n = state_increments(), width = lambda.size(), rows = y.size();
  Eigen::VectorXd factors(width + rows + 1), moved, u;
  factors << lambda, -y, 1;
  const Values at = [&](const Eigen::VectorXd& increment, Eigen::VectorXd& f) {
    retract(k, state, increment.head(n), moved);
    u = inputs + increment.tail(inputs.size());
    return all_values(k, moved, u, next, f);
  };
  Eigen::MatrixXd jacobian;
  if (!differentiate(at, deltas(state, inputs), factors, jacobian, out.hessian)) return false;
  out.F = jacobian.topLeftCorner(width, n);
  out.B = jacobian.topRightCorner(width, inputs.size());
  out.path_jacobian = jacobian.middleRows(width, rows);
  out.cost_gradient = jacobian.bottomRows(1).transpose();
  return true;
}

}  // namespace hamel
