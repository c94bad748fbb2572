#include <hamel/framework/run/run/run_loop.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace hamel {

namespace {

// A run keeps what it has after so many rows or so many steps; not by the clock, so that it is the same each time.
constexpr long kRows = 4096, kSteps = 65536;

}  // namespace

RunLoop::RunLoop(Simulation::Plan& plan, Result& result, std::vector<std::unique_ptr<Sink>>& sinks)
    : config_(plan.config),
      plan_(plan),
      result_(result),
      sinks_(sinks),
      kernel_(plan.kernel, plan.setup),
      acting_(plan.keeps_rows ? plan.mechanics
                              : std::make_shared<UnconstrainedMechanics>(plan.mechanics)),
      meter_(result.system, result.config.start, plan.geometry, plan.mechanics, acting_,
             plan.setup.inputs),
      dense_(std::make_unique<DenseOutput>(kernel_, plan.kernel, plan.setup)),
      times_(config_.rows()),
      every_node_(meter_.wants_nodes() || !times_.empty() || plan.events->any()),
      steps_(config_.chooses_steps() ? std::numeric_limits<long>::max() : config_.steps()) {
  result_.inputs = plan.setup.inputs;
  if (config_.chooses_steps()) kernel_.limit(config_.until);
  for (const auto& sink : sinks_) resumable_ = resumable_ || sink->resumable();
}

bool RunLoop::over() const {
  return config_.chooses_steps() ? node_.time == config_.until : steps_ <= 0;
}

void RunLoop::run() {
  try {
    go();
  } catch (...) {  // the rows that are there reach their files
    if (!begun_) throw;
    for (const auto& sink : sinks_) {
      try {
        if (!meter_.rows().empty()) sink->rows(meter_.rows());
        sink->flush();
      } catch (const std::exception&) {
      }
    }
    throw;
  }
}

void RunLoop::go() {
  begin_ = Clock::now();
  auto next_progress = begin_ + std::chrono::milliseconds(200);
  kernel_.state(node_);
  bool go_on = true;
  if (node_.step == 0) {
    kernel_.measure(result_.last);
    meter_.begin(result_.last);
    if (meter_.wants_nodes()) meter_.node(node_);
    go_on = times_.empty() ? record(node_) : output(config_.from);
  }
  while (go_on && !over()) {
    const long before = node_.step;
    const long count =
        every_node_ ? 1 : std::min({config_.every - before % config_.every, steps_, kRows});
    result_.status = kernel_.advance(count);
    kernel_.state(node_);
    steps_ -= count;
    if (every_node_ && node_.step > before) go_on = look_at_step();
    else if (times_.empty() && (node_.step % config_.every == 0 || over() || !result_.status.ok))
      go_on = record(node_);
    if (!result_.status.ok) break;
    if (progress && Clock::now() >= next_progress) {
      progress((node_.time - config_.from) / (config_.until - config_.from));
      next_progress = Clock::now() + std::chrono::milliseconds(200);
    }
    if (go_on && !over() && (rows_ >= kRows || node_.step - kept_at_ >= kSteps)) keep();
  }
  if (go_on && result_.status.ok && next_ < times_.size()) output(config_.until);
  result_.seconds = elapsed();
  if (progress && result_.status.ok) progress(1);
  if (!result_.stopped_by_event) kernel_.measure(result_.last);
  result_.steps = node_.step;
  result_.stats = kernel_.stats();
  meter_.finish(result_.last);
  deliver();
  static_cast<Measurements&>(result_) = meter_.all();
  result_.notes.insert(result_.notes.end(), meter_.notes().begin(), meter_.notes().end());
}

void RunLoop::begin_sinks(const std::vector<ColumnGroup>& columns, const std::string& record) {
  const RunHead head{columns, plan_.request, plan_.files, record};
  for (const auto& sink : sinks_) sink->begin(head);
  begun_ = true;
}

void RunLoop::deliver() {
  for (const auto& sink : sinks_) sink->rows(meter_.rows());
  meter_.drop_rows();
}

void RunLoop::keep() {
  deliver();
  rows_ = 0;
  kept_at_ = node_.step;
  if (resumable_) {
    kernel_.begin_anew();
    begin_from_here();
    result_.seconds = elapsed();
    CheckpointWriter state, news;
    carry(state);
    std::vector<EventMet> met(result_.events.begin() + told_, result_.events.end());
    told_ = static_cast<long>(result_.events.size());
    news(met);
    for (const auto& sink : sinks_) sink->checkpoint(state.bytes(), news.bytes());
  }
  for (const auto& sink : sinks_) sink->flush();
}

void RunLoop::begin_from_here() {
  dense_ = std::make_unique<DenseOutput>(kernel_, plan_.kernel, plan_.setup);
  kernel_.state(node_);
}

void RunLoop::resume(const RunFile& file) {
  const RunFile::Kept kept = file.kept();
  if (kept.state.empty()) return;  // from its start
  CheckpointReader state(kept.state);
  carry(state);
  begin_from_here();
  before_ = result_.seconds;
  kept_at_ = node_.step;
  for (const std::string& piece : kept.news) {
    std::vector<EventMet> met;
    CheckpointReader news(piece);
    news(met);
    result_.events.insert(result_.events.end(), met.begin(), met.end());
  }
  told_ = static_cast<long>(result_.events.size());

  begin_sinks(file.table().groups(), file.text("start"));
  std::vector<double> rows;
  for (std::size_t at = 0; at < kept.rows; at += kRows) {
    const std::size_t count = std::min<std::size_t>(kRows, kept.rows - at);
    file.table().read(at, count, rows);
    for (const auto& sink : sinks_) sink->rows(rows);
    for (std::size_t i = 0; i < count; ++i) meter_.follow_exact(rows[i * (rows.size() / count)]);
  }
  CheckpointWriter news;
  news(result_.events);
  for (const auto& sink : sinks_) {
    sink->checkpoint(kept.state, news.bytes());
    sink->flush();
  }
}

double RunLoop::elapsed() const {
  return before_ + std::chrono::duration<double>(Clock::now() - begin_ - comparing_).count();
}

bool RunLoop::look_at_step() {
  if (plan_.events->any()) {
    const Status status = plan_.events->look(node_, *dense_, found_);
    if (!status.ok) {
      result_.status = status;
      return false;
    }
  }
  for (Events::Found& event : found_) {
    result_.events.push_back(
        {event.name, event.state.time, event.state.coordinates, event.state.velocity});
    const std::optional<EventState> after = event.stops ? std::nullopt : impact(event);
    if (!event.stops && !after) continue;
    if (meter_.wants_nodes()) meter_.node(event.state);
    if (!output(event.state.time)) return false;  // by the steps before the impact
    if (after) {
      go_on_from(*after, event);
      return !times_.empty() || !over() || record(node_);
    }
    result_.stopped_by_event = true;
    result_.status.reason = "stopped at " + event.name;
    result_.last = event.state;
    if (times_.empty()) record(event.state);
    return false;
  }
  if (meter_.wants_nodes()) {
    look_within_step();
    meter_.node(node_);
  }
  if (!times_.empty()) return output(node_.time);
  return node_.step % config_.every == 0 || over() || !result_.status.ok ? record(node_) : true;
}

// The explicit pairs take long steps, and know the motion within them: so the work is not known from their ends alone.
void RunLoop::look_within_step() {
  kernel_.beginning(row_);
  const double begin = row_.time;
  for (const double part : {0.25, 0.5, 0.75}) {
    if (!kernel_.interpolate(begin + part * (node_.time - begin), row_)) return;
    meter_.node(row_);
  }
}

bool RunLoop::output(double t) {
  const double sign = config_.until >= config_.from ? 1 : -1;
  const double slack = 1e-12 * std::abs(config_.until - config_.from);
  for (; next_ < times_.size() && sign * (times_[next_] - t) <= slack; ++next_) {
    if (const Status status = dense_->at(times_[next_], row_); !status.ok) {
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
    kernel_.measure(result_.last);
    row = &result_.last;
  }
  meter_.take(*row);
  const auto begin = Clock::now();
  meter_.compare(*row);
  comparing_ += Clock::now() - begin;
  ++rows_;
  if (!begun_) {
    result_.last = *row;
    const Status status = std::exchange(result_.status, {false, 0, row->time, 0, "unfinished"});
    begin_sinks(meter_.columns(), result_.record());
    for (const auto& sink : sinks_) sink->flush();
    result_.status = status;
  }
  if (!observer || observer(*row)) return true;
  result_.status.reason = to_string(Reason::stopped);
  return false;
}

// The state behind it, where it is another one.
std::optional<EventState> RunLoop::impact(const Events::Found& event) {
  const auto it = impacts->find(event.name);
  if (it == impacts->end()) return {};
  EventState state{event.state.time, event.state.coordinates, event.state.velocity};
  it->second(state);
  if (state.coordinates == event.state.coordinates && state.velocity == event.state.velocity)
    return {};
  return state;
}

void RunLoop::go_on_from(const EventState& state, const Events::Found& event) {
  ++impacts_met_;
  const std::vector<double> velocity = plan_.admissible(state, event.name);
  const double h = kernel_.next_step();
  kernel_.restart(state.time, state.coordinates, velocity, h);
  if (config_.chooses_steps()) kernel_.limit(config_.until);
  else
    steps_ = static_cast<long>(std::floor((config_.until - state.time) / h * (1 + 1e-12) + 1e-9));
  kernel_.state(node_);
  meter_.impact(event.state, node_);
  plan_.events->resume(node_, event.name);
}

}  // namespace hamel
