#include <hamel/framework/inverse/plan_stages.hpp>

#include <algorithm>
#include <cmath>

namespace hamel {
namespace {

// Differences of order 6: truncation delta^6 f7/140, round-off eps/delta. Of increments in rad, m
// and their rates, of inputs in a part of their size, of the step in a part of it.
constexpr double kDelta = 3e-3, kInputDelta = 1e-2, kStepDelta = 2e-2;

}  // namespace

double PlanStages::step_of(const Eigen::VectorXd& state) const {
  return free_time ? state[state.size() - 1] : step;
}

std::string PlanStages::row_name(int row) const {
  const auto at = static_cast<std::size_t>(row);
  return at < path_names.size() ? path_names[at] : "until";
}

// Bounds of the step are rows of the second stage: those of the first are not varied.
int PlanStages::path_rows(int k) const {
  if (k == 0) return 0;
  return static_cast<int>(path.size()) + (free_time && k == 1 ? 2 : 0);
}

StageSizes PlanStages::sizes(int k) const {
  return {.state = state_increments(),
          .inputs = k < steps ? static_cast<int>(weights.size()) : 0,
          .path = path_rows(k)};
}

void PlanStages::retract(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& increment,
                         Eigen::VectorXd& out) const {
  map.retract(motion_state(time_of(k, state), state), increment.head(map.increments()), moved_);
  out.resize(state.size());
  out.head(numbers_of_motion()) = numbers(moved_);
  if (free_time) out[state.size() - 1] = step_of(state) + increment[increment.size() - 1];
}

Eigen::VectorXd PlanStages::numbers(const MotionState& state) const {
  const std::vector<double> g = map.coordinates(state);
  Eigen::VectorXd out(numbers_of_motion());
  out << Eigen::Map<const Eigen::VectorXd>(g.data(), map.coordinate_count()), state.xi;
  return out;
}

MotionState PlanStages::motion_state(double t, const Eigen::VectorXd& state) const {
  const auto columns = static_cast<std::size_t>(map.coordinate_count());
  const std::span<const double> all(state.data(), static_cast<std::size_t>(numbers_of_motion()));
  return map.state_of(t, all.first(columns), all.subspan(columns));
}

void PlanStages::bounds(int k, Eigen::VectorXd& low_inputs, Eigen::VectorXd& high_inputs) const {
  if (k == steps) return;
  low_inputs = low;
  high_inputs = high;
}

void PlanStages::state_values(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                              bool last, Eigen::VectorXd& out) const {
  const int rows = path_rows(k);
  out.resize(rows + 1);
  const double h = step_of(state), t = time_of(k, state);
  const auto columns = static_cast<std::size_t>(map.coordinate_count());
  const std::span<const double> all(state.data(), static_cast<std::size_t>(numbers_of_motion()));
  const auto number = [&](const StateNumber& f) {
    return f(t, all.first(columns), all.subspan(columns));
  };
  for (int i = 0; i < rows; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (at < path.size()) out[i] = number(path[at]);
    else out[i] = steps * (at == path.size() ? h - least_step : most_step - h);
  }
  double& cost = out[rows] = 0;
  if (!last) {
    cost = time_weight + 0.5 * weights.dot(inputs.cwiseAbs2());
    if (running) cost += number(running);
    cost *= h;
  } else if (terminal) {
    cost = number(terminal);
  }
}

// By the equation from its last solution; the first one, and where that fails, by the run's kernel.
bool PlanStages::take_step(int k, const MotionState& begin, double h, MotionState& to) {
  if (equation_ == nullptr) return map.step(begin, begin.time + h, to).ok;
  unknowns_.resize(static_cast<std::size_t>(steps));
  RecordedLift::Unknowns& x = unknowns_[static_cast<std::size_t>(k)];
  if (equation_->solve(begin, map.plan().setup.inputs->at(begin.time), h, x) && equation_->end(to))
    return true;
  x.resize(0);
  return map.step(begin, begin.time + h, to).ok;
}

bool PlanStages::repeats(const StagePoint& point) {
  if (equation_ == nullptr) return true;
  constexpr double kSame = 1e-9;
  MotionState by_equation, by_run;
  Eigen::VectorXd off;
  for (int k = 0; k < steps; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const MotionState begin = motion_state(time_of(k, point.states[at]), point.states[at]);
    const double h = step_of(point.states[at]);
    map.set_inputs(point.inputs[at]);
    if (!take_step(k, begin, h, by_equation) || !map.step(begin, begin.time + h, by_run).ok ||
        !displacement(map.geometry(), by_run, by_equation, off))
      return false;
    if (!(off.lpNorm<Eigen::Infinity>() <= kSame * (1 + by_run.xi.lpNorm<Eigen::Infinity>())))
      return false;
  }
  return true;
}

bool PlanStages::all_values(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                            const Eigen::VectorXd* next, Eigen::VectorXd& out) {
  const int width = next != nullptr ? state_increments() : 0;
  state_values(k, state, inputs, next == nullptr, beside_);
  out.resize(width + beside_.size());
  out.tail(beside_.size()) = beside_;
  const double h = step_of(state), t = time_of(k, state);
  if (next != nullptr) {
    if (!(h > 0)) return false;
    map.set_inputs(inputs);
    if (!take_step(k, motion_state(t, state), h, next_) || !next_.xi.allFinite()) return false;
    if (!map.difference(motion_state(time_of(k + 1, *next), *next), next_, difference_))
      return false;
    out.head(map.increments()) = difference_;
    if (free_time) out[width - 1] = h - step_of(*next);
  }
  return out.allFinite();
}

bool PlanStages::values(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                        const Eigen::VectorXd* next, StageValues& out) {
  if (!all_values(k, state, inputs, next, all_)) return false;
  out.defect = all_.head(out.defect.size());
  out.path = all_.segment(out.defect.size(), out.path.size());
  out.cost = all_[all_.size() - 1];
  return true;
}

Eigen::VectorXd PlanStages::deltas(const Eigen::VectorXd& state,
                                   const Eigen::VectorXd& inputs) const {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(state_increments() + inputs.size(), kDelta);
  if (free_time) out[state_increments() - 1] = kStepDelta * step_of(state);
  out.tail(inputs.size()) = kInputDelta * (1 + inputs.array().abs());
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
  return path_rows(k) > 0 || (k < steps ? running : terminal) != nullptr;
}

// q = (eta, w, u, h, t) of the equation by the increments (eta, dy, dh) and u: w = xi + E dy, t =
// from + k h.
bool PlanStages::step_derivatives(int k, const Eigen::VectorXd& state,
                                  const Eigen::VectorXd& inputs, const Eigen::VectorXd& next,
                                  const Eigen::VectorXd& lambda, StageDerivatives& out) {
  const double h = step_of(state), t = time_of(k, state);
  const MotionState begin = motion_state(t, state);
  map.set_inputs(inputs);
  unknowns_.resize(static_cast<std::size_t>(steps));
  if (!equation_->solve(begin, map.plan().setup.inputs->at(t), h,
                        unknowns_[static_cast<std::size_t>(k)]) ||
      !equation_->linearise({next.data(), static_cast<std::size_t>(map.coordinate_count())}))
    return false;
  const Eigen::Index n = map.velocities(), m = map.increments() - n, width = state_increments(),
                     count = width + inputs.size(), last = equation_->parameters() - 1;
  by_increments_.setZero(equation_->parameters(), count);
  by_increments_.topLeftCorner(n, n).setIdentity();
  by_increments_.block(n, n, n, m) = map.basis(begin);
  for (std::size_t i = 0; i < map.inputs().size(); ++i)
    by_increments_(2 * n + static_cast<Eigen::Index>(map.inputs()[i]),
                   width + static_cast<Eigen::Index>(i)) = 1;
  if (free_time) {
    by_increments_(last - 1, width - 1) = 1;
    by_increments_(last, width - 1) = k;
  }
  const Eigen::MatrixXd& inverse = map.left_inverse(motion_state(time_of(k + 1, next), next));
  slopes_.noalias() = equation_->jacobian() * by_increments_;
  out.F.topRows(n) = slopes_.topLeftCorner(n, width);
  out.B.topRows(n) = slopes_.topRightCorner(n, inputs.size());
  out.F.middleRows(n, m).noalias() = inverse * slopes_.bottomLeftCorner(n, width);
  out.B.middleRows(n, m).noalias() = inverse * slopes_.bottomRightCorner(n, inputs.size());
  if (free_time) out.F(width - 1, width - 1) = 1;
  pulled_.resize(2 * n);
  pulled_.head(n) = lambda.head(n);
  pulled_.tail(n).noalias() = inverse.transpose() * lambda.segment(n, m);
  slopes_.noalias() = equation_->hessian(pulled_) * by_increments_;
  out.hessian.noalias() = by_increments_.transpose() * slopes_;
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

int PlanStages::goals() const {
  return static_cast<int>(goal_rows.size()) + (goal_place ? map.velocities() : 0);
}

bool PlanStages::goal_values(const Eigen::VectorXd& last, Eigen::VectorXd& out) {
  out.resize(goals());
  Eigen::Index row = 0;
  for (const PlanGoal& goal : goal_rows) out[row++] = last[goal.place] - goal.value;
  if (!goal_place) return true;
  if (!map.difference(*goal_place, motion_state(time_of(steps, last), last), difference_))
    return false;
  out.tail(map.velocities()) = difference_.head(map.velocities());
  return true;
}

void PlanStages::goal(const Eigen::VectorXd& last, Eigen::VectorXd& value) {
  if (!goal_values(last, value))
    value.setConstant(goals(), std::numeric_limits<double>::quiet_NaN());
}

void PlanStages::goal_derivatives(const Eigen::VectorXd& last, const Eigen::VectorXd& nu,
                                  Eigen::MatrixXd& jacobian, Eigen::MatrixXd& hessian) {
  Eigen::VectorXd moved;
  const Values at = [&](const Eigen::VectorXd& increment, Eigen::VectorXd& f) {
    retract(steps, last, increment, moved);
    return goal_values(moved, f);
  };
  differentiate(at, deltas(last, Eigen::VectorXd()), nu, jacobian, hessian);
}

Eigen::MatrixXd PlanStages::start_directions() const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(state_increments(), free_time ? 1 : 0);
  if (free_time) out(state_increments() - 1, 0) = 1;
  return out;
}

}  // namespace hamel
