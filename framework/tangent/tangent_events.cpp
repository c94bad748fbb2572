// The tangent of a motion through its events: saltation.
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/tangent/step_differences.hpp>
#include <hamel/framework/tangent/tangent_motion.hpp>

namespace hamel {
namespace {

constexpr double kPartOfStep = 0x1p-5;  // differences of a motion in time

Snapshot snapshot_at(const MovedMotion& motion, const MotionState& state) {
  Snapshot out;
  out.time = state.time;
  out.coordinates = motion.map().coordinates(state);
  out.velocity.assign(state.xi.data(), state.xi.data() + state.xi.size());
  return out;
}

// The state that an impact leaves, as the driver makes it.
MotionState behind_impact(const MovedMotion& motion, const EventMet& met, const Impact& impact,
                          const MotionState& before) {
  EventState state{before.time,
                   motion.map().coordinates(before),
                   {before.xi.data(), before.xi.data() + before.xi.size()}};
  impact(state);
  const RunPlan& plan = motion.plan();
  const std::vector<double> velocity = admissible(*plan.system, plan.geometry, state, met.name);
  return motion.map().state_of(state.time, state.coordinates, velocity);
}

}  // namespace

Status TangentMotion::follow() {
  const Snapshot& now =
      run_.state({.element = false, .momentum = false, .energy = false, .measures = false});
  const MotionState end = motion_.map().state_of(now.time, now.coordinates, now.velocity);
  const std::vector<EventMet>& events = run_.events();
  const bool news = events.size() > std::exchange(met_, events.size());
  const long impacts = run_.driver().impacts_met();
  const bool impact = impacts > std::exchange(impacts_, impacts), stops = news && run_.over();
  TangentState next;
  if (!impact && !stops) {
    if (end.time == node_.state.time) return {};
    if (Status status = step(node_, end.time, next, &end); !status.ok) return status;
    node_ = std::move(next);
    return {};
  }
  const EventMet& met = events.back();
  const MotionState there = motion_.map().state_of(met.time, met.coordinates, met.velocity);
  if (there.time == node_.state.time) next = node_;
  else if (Status status = step(node_, there.time, next, &there, true); !status.ok) return status;
  if (Status status = cross(met, next, impact ? &end : nullptr); !status.ok) return status;
  node_ = std::move(next);
  return {};
}

// Rates of a state, by the step itself.
bool TangentMotion::rate_at(const MotionState& state, Eigen::VectorXd& out) {
  const auto moved = [&](double x, Eigen::VectorXd& by) {
    MotionState to;
    return motion_.map().step(state, state.time + x, to).ok &&
           displacement(motion_.geometry(), state, to, by);
  };
  const double e = kPartOfStep * std::abs(run_.driver().next_step());
  return ThreeDifferences::derivative(ThreeDifferences::fine, e, moved, out);
}

bool TangentMotion::cross_columns(const EventMet& met, TangentState& there,
                                  const MotionState* behind, const Eigen::VectorXd& rate_before,
                                  const Eigen::VectorXd& rate_behind, Eigen::MatrixXd& columns) {
  const Eigen::Index q = columns.cols();
  TangentState along{there.state, {}, {}, Eigen::RowVectorXd::Zero(q + 1)};
  along.columns.resize(columns.rows(), q + 1);
  along.columns << columns, rate_before;
  along.time[q] = 1;
  const auto gamma = [&](MovedMotion& motion, const MotionState& state, Eigen::VectorXd& out) {
    out.setConstant(1, motion.plan().events->value(met.name, snapshot_at(motion, state)));
  };
  Eigen::VectorXd value;
  Eigen::MatrixXd slopes, changed;
  if (!derivative(along, gamma, value, slopes)) return false;
  const Eigen::RowVectorXd dt = -slopes.leftCols(q) / slopes(0, q);
  if (!dt.allFinite()) return false;
  if (behind == nullptr) {
    columns += rate_before * dt;
    there.time = dt;
    return true;
  }
  const Impact& impact = run_.driver().impacts().at(met.name);
  const auto changes = [&](MovedMotion& motion, const MotionState& state, Eigen::VectorXd& out) {
    if (!displacement(motion_.geometry(), *behind, behind_impact(motion, met, impact, state), out))
      out.setConstant(columns.rows(), std::nan(""));
  };
  if (!derivative(along, changes, value, changed)) return false;
  columns = changed.leftCols(q) + (changed.col(q) - rate_behind) * dt;
  return true;
}

// behind: the state after an impact; null where the run ends.
Status TangentMotion::cross(const EventMet& met, TangentState& there, const MotionState* behind) {
  Eigen::VectorXd before, after;
  Eigen::MatrixXd coarse = there.coarse;
  const bool crossed = rate_at(there.state, before) &&
                       (behind == nullptr || rate_at(*behind, after)) &&
                       cross_columns(met, there, behind, before, after, there.columns) &&
                       (!measure_ || cross_columns(met, there, behind, before, after, coarse));
  if (!crossed)
    return {false, 0, met.time, 0,
            fmt::format("no tangent through the event {} at t = {:.10g}: it is grazed, or what it "
                        "does has no derivative",
                        met.name, met.time)};
  if (measure_) there.coarse = coarse;
  if (behind != nullptr) there.state = *behind;
  return {};
}

// Does a shorter step to t pass an event that changes the state?
bool TangentMotion::misses_event(double t) {
  for (const auto& [name, impact] : run_.driver().impacts()) {
    const auto value = [&, &event = name](const MotionState& state) {
      return motion_.plan().events->value(event, snapshot_at(motion_, state));
    };
    if (t != node_.state.time && value(node_.state) * value(shown_.state) < 0) return true;
  }
  return false;
}

}  // namespace hamel
