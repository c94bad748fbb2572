// Observers of the steps of a run: events, impacts, rows, files and checkpoints.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/run/run/driver.hpp>

namespace hamel {

bool Driver::observe_step(double begin) {
  const std::optional<ContactSwitch> met = take_switch();
  const Snapshot& end = met ? met->before : node_;
  if (met) plan_.contacts->look_back(true);
  if (rows_watch_ != nullptr) {
    if (const std::optional<std::string> reason = rows_watch_->node(node_)) {
      result_.status = {false, node_.step, result_.last.time, node_.residual, *reason};
      flawed_ = true;
      return false;
    }
  }
  if (plan_.events->any()) {
    const Status status = plan_.events->look(end, dense(), found_);
    if (!status.ok) {
      result_.status = status;
      return false;
    }
  }
  for (const Events::Found& event : found_) {
    bool go_on = true;
    if (observe_event(event, begin, go_on)) return go_on;
  }
  balance_step(begin, end);
  if (!times_.empty() && !output(end.time)) return false;
  if (met && !observe_switch(*met)) return false;
  if (!plan_.recording || !times_.empty()) return true;
  return node_.step % plan_.config.every == 0 ? record_node() : true;
}

// A step from `begin`, whole or up to an event within it, to what follows the energy.
void Driver::balance_step(double begin, const Snapshot& end) {
  const auto within = [this](double t, Snapshot& out) { return motion_within(t, out); };
  if (follower_ != nullptr) follower_->step(begin, end, within);
  if (recorder_ != nullptr && recorder_->wants_nodes()) recorder_->step(begin, end, within);
}

void Driver::observe_start() {
  for (const Events::Found& event : plan_.events->lost_at_start(node_)) {
    result_.events.push_back(
        {event.name, event.state.time, event.state.coordinates, event.state.velocity});
    if (event.stops) {
      kernel().measure(result_.last);
      result_.stopped_by_event = over_ = true;
      result_.status.reason = "stopped at " + event.name;
      return;
    }
    if (const std::optional<EventState> after = impact(event)) return restart_behind(*after, event);
  }
}

// True where the state behind the event is not that of the step: go_on is false where the run ends
// there. begin: of the step.
bool Driver::observe_event(const Events::Found& event, double begin, bool& go_on) {
  result_.events.push_back(
      {event.name, event.state.time, event.state.coordinates, event.state.velocity});
  const std::optional<EventState> after = event.stops ? std::nullopt : impact(event);
  if (!event.stops && !after) return false;
  balance_step(begin, event.state);
  go_on = output(event.state.time);  // by the steps before the impact
  if (!go_on) return true;
  if (after) {
    restart_behind(*after, event);
    return true;
  }
  result_.stopped_by_event = true;
  result_.status.reason = "stopped at " + event.name;
  result_.last = event.state;
  if (plan_.recording && times_.empty()) {
    row_ = event.state;
    record(Clock::now());
  }
  go_on = false;
  return true;
}

bool Driver::output(double t) {
  const double sign = plan_.config.until >= plan_.config.from ? 1 : -1;
  const double slack = 1e-12 * std::abs(plan_.config.until - plan_.config.from);
  for (; next_ < times_.size() && sign * (times_[next_] - t) <= slack; ++next_) {
    const Clock::time_point begin = Clock::now();
    const double wanted = times_[next_];
    // Behind a switch no motion is continued, not even by round-off.
    const double at = plan_.contacts != nullptr ? std::min(wanted, kernel().time()) : wanted;
    const bool known = logged_ != nullptr && kernel().log_state(wanted);
    Status status;
    if (!known) status = logged_ != nullptr ? dense().log(at, logged_->log) : dense().at(at, row_);
    if (!status.ok) {
      result_.status = status;
      return false;
    }
    row_.time = wanted;
    if (!(logged_ != nullptr ? logged() : record(begin))) return false;
  }
  return true;
}

// The node, unless it is a row already.
bool Driver::record_node() {
  if (logged_ != nullptr) {
    if (!logged_->log.has(node_.step)) kernel().log_state(kernel().time());
    return logged();
  }
  if (node_.step == recorded_) return true;
  recorded_ = node_.step;
  const Clock::time_point begin = Clock::now();
  kernel().measure(row_);
  return record(begin);
}

bool Driver::logged() {
  logged_->bound();
  if (!logged_->log.flawed) return true;
  logged_->latest(result_.last);
  kernel().measure(row_);
  if (good(row_)) {  // but not for long: its numbers overflow
    result_.status = {false, row_.step, result_.last.time, row_.residual,
                      to_string(Reason::not_finite)};
    flawed_ = true;
  }
  return false;
}

// The state in row_, measured since `begin`; row_ is another one afterwards.
bool Driver::record(Clock::time_point begin) {
  const bool good_row = good(row_);
  if (!good_row && sinks_begun_) return false;
  std::swap(result_.last, row_);
  const Snapshot& row = result_.last;
  recorder_->take(row);
  const Clock::time_point taken = Clock::now();
  recorder_->compare(row);
  const Clock::time_point compared = Clock::now();
  in_rows_ += compared - begin;
  comparing_ += compared - taken;
  ++rows_;
  if (!sinks_begun_) {
    Result at_start = head();
    at_start.status = {false, 0, row.time, 0, "unfinished"};
    at_start.last = row;
    begin_sinks(recorder_->columns(), at_start.record());
    for (const auto& sink : sinks_) sink->flush();
  }
  if (!good_row) return false;
  if (!request_.observer) return true;
  const bool go_on = request_.observer(row);
  occupancy_.require_run();
  if (go_on) return true;
  result_.status.reason = to_string(Reason::stopped);
  return false;
}

// The state behind it, where it is another one.
std::optional<EventState> Driver::impact(const Events::Found& event) const {
  const auto it = request_.impacts.find(event.name);
  if (it == request_.impacts.end()) return {};
  EventState state{event.state.time, event.state.coordinates, event.state.velocity};
  it->second(state);
  occupancy_.require_run();
  if (state.coordinates == event.state.coordinates && state.velocity == event.state.velocity)
    return {};
  return state;
}

void Driver::restart_behind(const EventState& state, const Events::Found& event) {
  ++impacts_met_;
  if (plan_.contacts != nullptr) plan_.contacts->look_back(false);
  const Config& config = plan_.config;
  const std::vector<double> velocity = admissible(*plan_.system, plan_.geometry, state, event.name);
  const double h = kernel().next_step();
  const double limit = kernel().end_time();
  kernel().restart(state.time, state.coordinates, velocity, h);
  if (config.chooses_steps()) kernel().set_end_time(limit);
  else {
    steps_left_ =
        static_cast<long>(std::floor((config.until - state.time) / h * (1 + 1e-12) + 1e-9));
    limit_grid(steps_left_);
  }
  kernel().state(node_);
  if (rows_watch_ != nullptr) rows_watch_->begin(node_);
  if (recorder_ != nullptr) recorder_->impact(event.state, node_);
  if (follower_ != nullptr) follower_->impact(event.state, node_);
  plan_.events->resume(node_, event.name);
}

// ---- files --------------------------------------------------------------------------------------

void Driver::begin_sinks(const std::vector<ColumnGroup>& columns, const std::string& record) {
  const Config& config = plan_.config;
  RunHead head{columns, plan_.outputs.request, plan_.outputs.files, record, config.events};
  head.events.insert(head.events.end(), config.stop_at.begin(), config.stop_at.end());
  for (const auto& sink : sinks_) sink->begin(head);
  sinks_begun_ = true;
}

void Driver::deliver() {
  for (const auto& sink : sinks_) sink->rows(recorder_->rows());
  recorder_->drop_rows();
}

void Driver::keep() {
  rows_ = 0;
  kept_at_ = node_.step;
  if (!plan_.recording) return;
  const Timed timed(in_rows_);
  deliver();
  if (resumable_) {
    kernel().begin_anew();
    dense_.reset();
    kernel().state(node_);
    lap();
    CheckpointWriter state, news;
    serialize(state);
    std::vector<EventMet> met(result_.events.begin() + kept_events_, result_.events.end());
    kept_events_ = static_cast<long>(result_.events.size());
    news(met);
    for (const auto& sink : sinks_) sink->checkpoint(state.bytes(), news.bytes());
  }
  for (const auto& sink : sinks_) sink->flush();
}

void Driver::resume(const RunFile& file) {
  const RunFile::Kept kept = file.kept();
  if (kept.state.empty()) return;  // from its start
  CheckpointReader state(kept.state);
  serialize(state);
  dense_.reset();
  kernel().state(node_);
  begun_ = true;
  if (rows_watch_ != nullptr) rows_watch_->begin(node_);
  kept_at_ = node_.step;
  for (const std::string& piece : kept.news) {
    std::vector<EventMet> met;
    CheckpointReader news(piece);
    news(met);
    result_.events.insert(result_.events.end(), met.begin(), met.end());
  }
  kept_events_ = static_cast<long>(result_.events.size());

  begin_sinks(file.table().groups(), file.text("start"));
  constexpr std::size_t piece = 4096;
  std::vector<double> rows;
  for (std::size_t at = 0; at < kept.rows; at += piece) {
    const std::size_t count = std::min(piece, kept.rows - at);
    file.table().read(at, count, rows);
    for (const auto& sink : sinks_) sink->rows(rows);
    for (std::size_t i = 0; i < count; ++i)
      recorder_->follow_exact(rows[i * (rows.size() / count)]);
  }
  CheckpointWriter news;
  news(result_.events);
  for (const auto& sink : sinks_) {
    sink->checkpoint(kept.state, news.bytes());
    sink->flush();
  }
}

// The rows that are there reach their files.
void Driver::rows_to_files_after_failure() {
  over_ = true;
  if (!sinks_begun_) return;
  for (const auto& sink : sinks_) {
    try {
      if (!recorder_->rows().empty()) sink->rows(recorder_->rows());
      sink->flush();
    } catch (const std::exception&) {
    }
  }
}

void Driver::lap() {
  const auto seconds = [](Clock::duration time) {
    return std::chrono::duration<double>(time).count();
  };
  const Clock::time_point now = Clock::now();
  seconds_.all += seconds(now - entered_ - comparing_);
  seconds_.recording += seconds(in_rows_ - comparing_);
  seconds_.comparing += seconds(comparing_);
  entered_ = now;
  in_rows_ = comparing_ = {};
}

}  // namespace hamel
