#include <hamel/framework/tangent/tangent_motion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/tangent/displacement_units.hpp>
#include <hamel/framework/tangent/step_differences.hpp>

namespace hamel {
namespace {

constexpr double kDisplacement = 0x1p-6;        // the largest of a difference, in natural units
constexpr double kPlainDisplacement = 0x1p-13;  // and of a plain one, which is a quarter of it
constexpr double kRepeats = 1e-8;               // a repeated step, in natural units
constexpr double kStepOfZero = 1e-2;            // of a displacement, in one step

Status no_tangent(double t, const std::string& why) {
  return {false, 0, t, 0, fmt::format("no tangent of the step from t = {:.10g}: {}", t, why)};
}

// Are the inputs of a step the same along it?
bool has_held_inputs(const RunPlan& plan) {
  const auto& inputs = plan.setup.inputs;
  return inputs == nullptr || std::ranges::all_of(inputs->tables(), [](const auto& table) {
           return table.times.size() <= 1;
         });
}

}  // namespace

TangentMotion::TangentMotion(const std::string& what, const MotionVariables& variables,
                             const Eigen::VectorXd& values, Carries carries)
    : motion_(what, variables, values),
      run_(motion_.run_of(variables, values)),
      measure_(carries == Carries::errors),
      plain_(carries == Carries::ten_digits) {
  const RunPlan& plan = motion_.plan();
  node_.state = motion_.start();
  units_ = displacement_units(motion_.map(), node_.state, run_.driver().next_step());
  if (carries != Carries::values && has_held_inputs(plan))
    equation_ = RecordedLift::of(plan, RecordedLift::Order::first);
  if (equation_ != nullptr) equation_->set_units(units_);
  if (carries == Carries::values) {
    begin_with(Eigen::MatrixXd(2 * units_.size(), 0));
    return;
  }
  moved_.resize(variables.size());
  sizes_.resize(values.size());
  for (size_t i = 0; i < variables.size(); ++i) move_variable(what, variables, values, i);
  begin(variables, values);
}

// Motions beside it, as near as the range of a parameter requires.
void TangentMotion::move_variable(const std::string& what, const MotionVariables& variables,
                                  const Eigen::VectorXd& values, size_t i) {
  const MotionVariable& one = variables.all()[i];
  MovedVariable& moved = moved_[i];
  const auto at = static_cast<Eigen::Index>(i);
  const double now = values[at];
  if (!one.of_system()) sizes_[at] = natural_change(one, variables.direction(one));
  else sizes_[at] = now == 0 ? change_of_zero(what, variables, values, at) : std::abs(now);
  moved.size = std::exp2(std::ilogb(largest() * sizes_[at]));  // sums with it have less round-off
  if (!one.of_system()) return;
  constexpr int tries = 12;
  for (int n = 0; n < tries; ++n) {
    try {
      for (size_t level = 0; level < moved.pairs.size(); ++level) {
        if (weights()[level] == 0) continue;
        const double x = moved.size * ThreeDifferences::parts[level];
        Eigen::VectorXd there = values;
        there[at] = now + x;
        moved.pairs[level].plus = std::make_unique<MovedMotion>(what, variables, there);
        there[at] = now - x;
        moved.pairs[level].minus = std::make_unique<MovedMotion>(what, variables, there);
      }
      return;
    } catch (const ConfigError&) {  // out of the range of the parameter
      moved.size /= 4;
    }
  }
  throw ConfigError({fmt::format(
      "{}: {} = {}: at the edge of what it may be: there is no derivative", what, one.name, now)});
}

void TangentMotion::begin(const MotionVariables& variables, const Eigen::VectorXd& values) {
  const Eigen::Index q = values.size(), n = node_.state.xi.size();
  node_.columns.setZero(2 * n, q);
  for (Eigen::Index j = 0; j < q; ++j) {
    MovedVariable& moved = moved_[static_cast<size_t>(j)];
    const bool of_system = variables.all()[static_cast<size_t>(j)].of_system();
    Eigen::VectorXd column;
    const auto start_of = [&](double x, Eigen::VectorXd& out) {
      MotionState there;
      if (of_system) {
        for (size_t level = 0; level < moved.pairs.size(); ++level)
          if (std::abs(x) == moved.size * ThreeDifferences::parts[level])
            there = (x > 0 ? moved.pairs[level].plus : moved.pairs[level].minus)->start();
      } else {
        Eigen::VectorXd other = values;
        other[j] += x;
        there = motion_.start_at(variables, other);
      }
      return displacement(motion_.geometry(), node_.state, there, out);
    };
    if (!ThreeDifferences::derivative(weights(), moved.size, start_of, column))
      throw ConfigError({fmt::format("start: no derivative by {}",
                                     variables.all()[static_cast<size_t>(j)].name)});
    node_.columns.col(j) = column;
  }
  if (measure_) node_.coarse = node_.columns;
}

void TangentMotion::begin_with(const Eigen::MatrixXd& columns) {
  moved_.clear();
  moved_.resize(static_cast<size_t>(columns.cols()));
  node_.columns = columns;
  if (measure_) node_.coarse = columns;
}

double TangentMotion::largest() const { return plain_ ? kPlainDisplacement : kDisplacement; }
const std::array<double, 3>& TangentMotion::weights() const {
  return plain_ ? ThreeDifferences::plain : ThreeDifferences::fine;
}

// Velocities beside the motion's, or so slow a one that nothing moves in a step.
double TangentMotion::length_of(const MotionState& at, const Eigen::VectorXd& column,
                                double h) const {
  const Eigen::Index n = at.xi.size();
  const double still = 1e-3 / std::abs(h);
  const double rate = std::max(at.xi.cwiseQuotient(units_).lpNorm<Eigen::Infinity>(), still);
  return std::max(column.head(n).cwiseQuotient(units_).lpNorm<Eigen::Infinity>(),
                  column.tail(n).cwiseQuotient(units_).lpNorm<Eigen::Infinity>() / rate);
}

// The factor of a column that makes it a displacement of largest().
double TangentMotion::size_of(const MotionState& at, const Eigen::VectorXd& column,
                              double h) const {
  const double length = length_of(at, column, h);
  return length > 0 ? largest() / length : 0;
}

// Change of a number of the start that is a displacement of length 1.
double TangentMotion::natural_change(const MotionVariable& one,
                                     const Eigen::VectorXd& direction) const {
  const Eigen::Index n = units_.size();
  const auto index = static_cast<Eigen::Index>(one.index);
  Eigen::VectorXd column = direction;
  if (one.kind == MotionVariable::Kind::velocity) column = Eigen::VectorXd::Unit(2 * n, n + index);
  if (one.kind == MotionVariable::Kind::coordinate) {
    if (one.unit.starts_with("rad")) return 1;
    Eigen::Index i = motion_.geometry().columns() == n ? index : n;
    const std::vector<Component> components = components_of(*motion_.plan().system);
    for (Eigen::Index k = n; i == n && k-- > 0;)
      if (components[static_cast<size_t>(k)].unit == one.unit + "/s") i = k;
    return i < n ? units_[i] : 1;
  }
  const double length = natural_length(node_.state, column);
  return length > 0 ? 1 / length : 1;
}

// A change of a parameter or an input that is 0, whose size is not known: what displaces the end of
// a step by a part of a unit, as far as one step feels it; else 1.
double TangentMotion::change_of_zero(const std::string& what, const MotionVariables& variables,
                                     Eigen::VectorXd values, Eigen::Index at) {
  constexpr int tries = 40;
  constexpr double factor = 1e3, near = 2, round_off = 1e-11;
  const MotionState& start = node_.state;
  const double h = run_.driver().next_step(), t = start.time + h;
  MotionState end, beside;
  if (!motion_.map().step(start, t, end).ok) return 1;
  double out = 1;
  for (int n = 0; n < tries; ++n) {
    values[at] = out * largest();
    Eigen::VectorXd by;
    bool found = false;
    try {
      MovedMotion other(what, variables, values);
      found = other.map().step(start, t, beside).ok &&
              displacement(motion_.geometry(), end, beside, by);
    } catch (const ConfigError&) {  // out of range
    }
    const double length = found ? length_of(start, by, h) : HUGE_VAL;
    if (!std::isfinite(length)) out /= factor;
    else if (length < round_off) out *= factor;
    else if (length > near * kStepOfZero * largest() || near * length < kStepOfZero * largest())
      out *= kStepOfZero * largest() / length;
    else return out;
  }
  return 1;
}

bool TangentMotion::step_beside(MovedMotion& motion, const MotionState& from, const MotionState& to,
                                Eigen::VectorXd& by) {
  MotionState begin = from, end;
  if (projects_ && !motion.map().make_admissible(begin)) {
    failure_ = "the constraints do not hold at its beginning";
    return false;
  }
  const Status status = motion.map().step(begin, to.time, end);
  if (!status.ok) failure_ = status.reason;
  else if (!displacement(motion.geometry(), to, end, by)) failure_ = "it leads too far";
  else return true;
  return false;
}

bool TangentMotion::solve_equation(const MotionState& from, const MotionState& to) {
  if (equation_ == nullptr) return false;
  const auto& inputs = motion_.plan().setup.inputs;
  const Eigen::VectorXd u = inputs == nullptr ? InputValues() : inputs->at(from.time);
  const std::vector<double> there = motion_.map().coordinates(to);
  MotionState end;
  Eigen::VectorXd off;
  if (!equation_->solve(from, u, to.time - from.time, unknowns_) || !equation_->end(end) ||
      !displacement(motion_.geometry(), to, end, off) || !equation_->linearise(there))
    return false;
  const double factor = size_of(to, off, to.time - from.time);
  return factor == 0 || factor >= largest() / kRepeats;
}

bool TangentMotion::push(const TangentState& from, const MotionState& to,
                         const std::array<double, 3>& weights, bool exact,
                         const Eigen::MatrixXd& columns, Eigen::MatrixXd& out) {
  const Geometry& geometry = motion_.geometry();
  const double h = to.time - from.state.time;
  out.setZero(columns.rows(), columns.cols());
  if (exact && columns.cols() > 0)
    out.noalias() = equation_->jacobian().leftCols(columns.rows()) * columns;
  MotionState begin;
  Eigen::VectorXd column;
  for (Eigen::Index j = 0; j < columns.cols(); ++j) {
    const double e = size_of(from.state, columns.col(j), h);
    const auto moved_state = [&](double x, Eigen::VectorXd& by) {
      displace(geometry, from.state, columns.col(j), x, begin);
      return step_beside(motion_, begin, to, by);
    };
    if (e > 0 && !exact) {
      if (!ThreeDifferences::derivative(weights, e, moved_state, column)) return false;
      out.col(j) = column;
    }
    MovedVariable& moved = moved_[static_cast<size_t>(j)];
    if (!moved.moves_system()) continue;
    const auto moved_parameter = [&](double x, Eigen::VectorXd& by) {
      for (size_t level = 0; level < moved.pairs.size(); ++level) {
        if (std::abs(x) != moved.size * ThreeDifferences::parts[level]) continue;
        MovedMotion& other = x > 0 ? *moved.pairs[level].plus : *moved.pairs[level].minus;
        return step_beside(other, from.state, to, by);
      }
      return false;
    };
    if (!ThreeDifferences::derivative(weights, moved.size, moved_parameter, column)) return false;
    out.col(j) += column;
  }
  return true;
}

// known: the end of the step as the run has it, which interpolates it at an event.
Status TangentMotion::step(const TangentState& from, double t, TangentState& to,
                           const MotionState* known, bool by_dense_output) {
  MotionState end;
  if (Status status = motion_.map().step(from.state, t, end); !status.ok) return status;
  if (by_dense_output) end = *known;
  else if (known != nullptr) {
    Eigen::VectorXd off;
    const double h = t - from.state.time;
    const bool near = displacement(motion_.geometry(), end, *known, off);
    const double factor = near ? size_of(end, off, h) : 0;
    if (!near || (factor > 0 && factor < largest() / kRepeats))
      return no_tangent(from.state.time, "the step of the run is not repeated from its state");
    end = *known;
  }
  const bool exact = from.columns.cols() > 0 && solve_equation(from.state, end);
  Eigen::MatrixXd columns, coarse;
  const auto pushed = [&] {
    return push(from, end, weights(), exact, from.columns, columns) &&
           (!measure_ || push(from, end, ThreeDifferences::coarse, false, from.coarse, coarse));
  };
  if (!pushed() && (std::exchange(projects_, true) || !pushed()))
    return no_tangent(from.state.time, "a step beside it fails: " + failure_);
  to = {std::move(end), std::move(columns), std::move(coarse), {}};
  ++steps_;
  return {};
}

Status TangentMotion::advance_to(double t) {
  side_ = false;
  const bool chosen = motion_.plan().config.chooses_steps();
  while (!run_.over()) {
    const double h = run_.driver().next_step(), left = t - node_.state.time;
    const double tiny = 1e-10 * std::abs(chosen ? left == 0 ? 1 : left : h);
    if (std::abs(left) <= (chosen ? 0 : tiny) || left * h < 0) return {};
    if (!chosen && std::abs(left) < std::abs(h) - tiny) break;
    const double before = node_.state.time;
    if (Status status = run_.step_towards(t); !status.ok) return status;
    if (Status status = follow(); !status.ok) return status;
    if (node_.state.time == before) return {};
  }
  if (run_.over()) return {};
  if (Status status = step(node_, t, shown_, nullptr); !status.ok) return status;
  if (misses_event(t))
    return no_tangent(node_.state.time,
                      "an event within it changes the state: choose steps by a tolerance");
  side_ = true;
  return {};
}

bool TangentMotion::derivative(const TangentState& at, const Function& f, Eigen::VectorXd& here,
                               Eigen::MatrixXd& out) {
  Eigen::VectorXd column;
  f(motion_, at.state, here);
  out.setZero(here.size(), at.columns.cols());
  MotionState there;
  for (Eigen::Index j = 0; j < at.columns.cols(); ++j) {
    const double e = size_of(at.state, at.columns.col(j), run_.driver().next_step());
    const auto moved_state = [&](double x, Eigen::VectorXd& values) {
      displace(motion_.geometry(), at.state, at.columns.col(j), x, there);
      if (at.time.size() > 0) there.time += x * at.time[j];
      f(motion_, there, values);
      return true;
    };
    if (e > 0) {
      if (!ThreeDifferences::derivative(weights(), e, moved_state, column)) return false;
      out.col(j) = column;
    }
    if (static_cast<size_t>(j) >= moved_.size()) continue;  // along the motion itself
    MovedVariable& moved = moved_[static_cast<size_t>(j)];
    if (!moved.moves_system()) continue;
    const auto moved_parameter = [&](double x, Eigen::VectorXd& values) {
      for (size_t level = 0; level < moved.pairs.size(); ++level) {
        if (std::abs(x) != moved.size * ThreeDifferences::parts[level]) continue;
        f(x > 0 ? *moved.pairs[level].plus : *moved.pairs[level].minus, at.state, values);
        return true;
      }
      return false;
    };
    if (!ThreeDifferences::derivative(weights(), moved.size, moved_parameter, column)) return false;
    out.col(j) += column;
  }
  return true;
}

}  // namespace hamel
