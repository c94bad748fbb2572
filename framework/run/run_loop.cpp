#include <hamel/framework/run/run_loop.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace hamel {

RunLoop::RunLoop(Simulation::Plan& plan, Result& result)
    : config_(plan.config),
      plan_(plan),
      result_(result),
      kernel_(plan.kernel(plan.setup)),
      acting_(plan.keeps_rows ? plan.mechanics
                              : std::make_shared<UnconstrainedMechanics>(plan.mechanics)),
      meter_(result.system, result.config.start, plan.geometry, plan.mechanics, acting_,
             plan.setup.inputs),
      dense_(*kernel_, plan.kernel, plan.setup),
      times_(config_.rows()),
      every_node_(meter_.wants_nodes() || !times_.empty() || plan.events->any()),
      steps_(config_.chooses_steps() ? std::numeric_limits<long>::max() : config_.steps()) {
  if (config_.chooses_steps()) kernel_->limit(config_.until);
}

bool RunLoop::over() const {
  return config_.chooses_steps() ? node_.time == config_.until : steps_ <= 0;
}

void RunLoop::run() {
  const auto begin = Clock::now();
  auto next_progress = begin + std::chrono::milliseconds(200);
  kernel_->state(node_);
  if (meter_.wants_nodes()) meter_.node(node_);
  bool go_on = times_.empty() ? record(node_) : output(config_.from);
  while (go_on && !over()) {
    const long count = every_node_ ? 1 : std::min(config_.every, steps_), before = node_.step;
    result_.status = kernel_->advance(count);
    kernel_->state(node_);
    steps_ -= count;
    if (every_node_ && node_.step > before) go_on = look_at_step();
    else if (!every_node_ && node_.step > before) go_on = record(node_);
    if (!result_.status.ok) break;
    if (progress && Clock::now() >= next_progress) {
      progress((node_.time - config_.from) / (config_.until - config_.from));
      next_progress = Clock::now() + std::chrono::milliseconds(200);
    }
  }
  if (go_on && result_.status.ok && next_ < times_.size()) output(config_.until);
  result_.seconds = std::chrono::duration<double>(Clock::now() - begin - comparing_).count();
  if (!result_.stopped_by_event) kernel_->measure(result_.last);
  result_.steps = node_.step;
  result_.stats = kernel_->stats();
  static_cast<Measurements&>(result_) = meter_.finish(result_.trajectory);
  result_.notes.insert(result_.notes.end(), meter_.notes().begin(), meter_.notes().end());
}

bool RunLoop::look_at_step() {
  if (plan_.events->any()) {
    const Status status = plan_.events->look(node_, dense_, found_);
    if (!status.ok) {
      result_.status = status;
      return false;
    }
  }
  for (Events::Found& event : found_) {
    result_.events.push_back(
        {event.name, event.state.time, event.state.coordinates, event.state.velocity});
    if (!event.stops && !impact(event)) continue;
    if (meter_.wants_nodes()) meter_.node(event.state);
    if (!output(event.state.time)) return false;
    if (!event.stops) return true;  // goes on from the state after the impact
    result_.stopped_by_event = true;
    result_.status.reason = "stopped at " + event.name;
    result_.last = event.state;
    if (times_.empty()) record(event.state);
    return false;
  }
  if (meter_.wants_nodes()) meter_.node(node_);
  if (!times_.empty()) return output(node_.time);
  return node_.step % config_.every == 0 || over() || !result_.status.ok ? record(node_) : true;
}

bool RunLoop::output(double t) {
  const double sign = config_.until >= config_.from ? 1 : -1;
  const double slack = 1e-12 * std::abs(config_.until - config_.from);
  for (; next_ < times_.size() && sign * (times_[next_] - t) <= slack; ++next_) {
    if (const Status status = dense_.at(times_[next_], row_); !status.ok) {
      result_.status = status;
      return false;
    }
    if (!record(row_)) return false;
  }
  return true;
}

// state is the kernel's own, to be measured, or one that has been.
bool RunLoop::record(const Snapshot& state) {
  const Snapshot* row = &state;
  if (&state == &node_) {
    if (node_.step == recorded_) return true;  // nothing new
    recorded_ = node_.step;
    kernel_->measure(result_.last);
    row = &result_.last;
  }
  meter_.take(*row);
  const auto begin = Clock::now();
  meter_.compare(*row);
  comparing_ += Clock::now() - begin;
  if (result_.trajectory.columns().empty()) {
    result_.trajectory = Trajectory(meter_.columns());
    const size_t rows = !times_.empty()           ? times_.size()
                        : config_.chooses_steps() ? 0
                                                  : static_cast<size_t>(steps_ / config_.every + 2);
    result_.trajectory.reserve(rows);
  }
  result_.trajectory.append(meter_.row());
  if (!observer || observer(*row)) return true;
  result_.status.reason = to_string(Reason::stopped);
  return false;
}

// Did it change the state? The steps go on from there.
bool RunLoop::impact(const Events::Found& event) {
  const auto it = impacts->find(event.name);
  if (it == impacts->end()) return false;
  EventState state{event.state.time, event.state.coordinates, event.state.velocity};
  it->second(state);
  if (state.coordinates == event.state.coordinates && state.velocity == event.state.velocity)
    return false;
  const Eigen::VectorXd velocity = plan_.admissible(state);
  const double h = kernel_->next_step();
  kernel_->restart(state.time, state.coordinates, velocity, h);
  if (config_.chooses_steps()) kernel_->limit(config_.until);
  else
    steps_ = static_cast<long>(std::floor((config_.until - state.time) / h * (1 + 1e-12) + 1e-9));
  kernel_->state(node_);
  plan_.events->resume(node_, event.name);
  return true;
}

}  // namespace hamel
