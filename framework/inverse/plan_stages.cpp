#include <hamel/framework/inverse/plan_stages.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/mechanics/natural_units.hpp>

namespace hamel {

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

void PlanStages::set_scales(const Eigen::VectorXd& way, const Eigen::VectorXd& last_velocity) {
  const MotionState first = map.start();
  const Mechanics& mechanics = *map.plan().setup.mechanics;
  const Eigen::Index n = map.velocities();
  Eigen::MatrixXd inertia(n, n);
  mechanics.inertia(first.g.data(), inertia);
  const std::vector<double> own = own_scales(components_of(system()), mechanics, first.g.data());
  const double duration = kUnitTime * steps * step;
  Eigen::VectorXd sizes = Eigen::Map<const Eigen::VectorXd>(own.data(), n);
  double energy = inertia.diagonal().cwiseProduct(sizes.cwiseAbs2()).maxCoeff();
  energy /= duration * duration;
  if (energy == 0) {
    const auto square = [&](const auto& x) { return x.dot(inertia * x); };
    energy = std::max(
        {square(way.head(n)) / (duration * duration), square(first.xi), square(last_velocity)});
  }
  if (!(energy > 0)) energy = 1;  // it states none
  for (Eigen::Index i = 0; i < n; ++i)
    if (sizes[i] == 0) sizes[i] = duration * std::sqrt(energy / inertia(i, i));
  state_scales.setConstant(state_increments(), std::sqrt(energy));
  state_scales.head(n) = sizes;
  if (free_time) state_scales[state_increments() - 1] = step;
  if (equation_ != nullptr) equation_->set_units(sizes);
  find_input_scales(first, std::sqrt(energy) / duration);
}

// Forces are linear in inputs: by those of inputs that are large enough to show beside the others.
void PlanStages::find_input_scales(const MotionState& at, double acceleration) {
  const auto count = static_cast<Eigen::Index>(map.inputs().size());
  const Mechanics& mechanics = *map.plan().setup.mechanics;
  const Eigen::MatrixXd& basis = map.basis(at);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(count), still(map.velocities()), pushed = still;
  map.set_inputs(u);
  mechanics.applied_force(at.time, at.g.data(), at.xi, still);
  input_scales.setOnes(count);
  constexpr double kMore = 1e6;
  for (Eigen::Index i = 0; i < count; ++i) {
    u[i] = 1;
    for (int n = 0; n < 4; ++n, u[i] *= kMore) {
      map.set_inputs(u);
      mechanics.applied_force(at.time, at.g.data(), at.xi, pushed);
      pushed -= still;
      if (pushed.norm() * kMore > still.norm()) break;
    }
    const double moved = (basis.transpose() * pushed).norm();
    if (moved > 0 && std::isfinite(moved)) input_scales[i] = u[i] * acceleration / moved;
    u[i] = 0;
  }
  map.set_inputs(u);
}

Eigen::VectorXd PlanStages::goal_scales() const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(goals());
  for (std::size_t i = 0; i < goal_rows.size(); ++i) {
    const int component = goal_rows[i].place - map.coordinate_count();
    if (component >= 0)
      out[static_cast<Eigen::Index>(i)] = state_scales[component] / (kUnitTime * steps * step);
  }
  return out;
}

void PlanStages::retract(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& increment,
                         Eigen::VectorXd& out) const {
  map.choose_stage(k);
  set_motion_state(time_of(k, state), state, here_);
  map.retract(here_, increment.head(map.increments()), moved_);
  out.resize(state.size());
  map.geometry().coordinates(moved_.g.data(), out.data());
  out.segment(map.coordinate_count(), map.velocities()) = moved_.xi;
  if (free_time) out[state.size() - 1] = step_of(state) + increment[increment.size() - 1];
}

Eigen::VectorXd PlanStages::numbers(const MotionState& state) const {
  const std::vector<double> g = map.coordinates(state);
  Eigen::VectorXd out(numbers_of_motion());
  out << Eigen::Map<const Eigen::VectorXd>(g.data(), map.coordinate_count()), state.xi;
  return out;
}

MotionState PlanStages::motion_state(double t, const Eigen::VectorXd& state) const {
  MotionState out;
  set_motion_state(t, state, out);
  return out;
}

void PlanStages::set_motion_state(double t, const Eigen::VectorXd& state, MotionState& out) const {
  const auto columns = static_cast<std::size_t>(map.coordinate_count());
  const std::span<const double> all(state.data(), static_cast<std::size_t>(numbers_of_motion()));
  map.set_state(t, all.first(columns), all.subspan(columns), out);
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
  const auto number = [&](const StateFormula& f) {
    return f.value(t, all.first(columns), all.subspan(columns));
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
    const Eigen::Index n = map.velocities();
    const double duration = steps * step;
    const auto sizes = state_scales.head(n);
    const double rate = duration * by_run.xi.cwiseQuotient(sizes).lpNorm<Eigen::Infinity>();
    if (!(off.head(n).cwiseQuotient(sizes).lpNorm<Eigen::Infinity>() <= kSame) ||
        !(duration * off.tail(n).cwiseQuotient(sizes).lpNorm<Eigen::Infinity>() <=
          kSame * (1 + rate)))
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
    map.choose_stage(k);
    map.set_inputs(inputs);
    set_motion_state(t, state, there_);
    if (!take_step(k, there_, h, next_) || !next_.xi.allFinite()) return false;
    set_motion_state(time_of(k + 1, *next), *next, there_);
    if (!map.difference(there_, next_, difference_)) return false;
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
