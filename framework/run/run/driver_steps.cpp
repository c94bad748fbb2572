// The steps of a run: how many at once, and whether they go on.
#include <algorithm>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/run/run/steps/small_steps.hpp>

namespace hamel {
namespace {

// A run keeps what it has after so many rows or so many steps; not by the clock, so that it is the
// same each time.
constexpr long kRows = 4096, kSteps = 65536;
// Steps at once where each may be taken in a thousand parts: between them a run may be stopped.
constexpr long kRescued = 8;

}  // namespace

long Driver::piece_of(long count) const {
  const Config& config = plan_.config;
  if (config.chooses_steps()) count = std::min(count, std::max(1L, steps_.until_next()));
  if (config.steps_max > 0)
    count = std::min(count, std::max(1L, config.steps_max - kernel().whole_steps()));
  return count;
}

// True where they fill the window of the watch.
bool Driver::count_tries(long steps) {
  const long rejected = kernel().stats().rejected - rejected_;
  rejected_ += rejected;
  steps_.count(steps + rejected, rejected);
  return steps_.until_next() <= 0;
}

// Why chosen steps would not end, or could not be as exact as they are to be.
std::optional<std::string> Driver::why_steps_end(long steps, double t) {
  const bool due = count_tries(steps);
  const bool creep = steps_.look(t);
  const double usual = steps_.shrunk_from();
  if (!creep && !(due && (steps_.rejects() || usual > 0))) return {};
  KernelSetup setup = plan_.setup;
  if (plan_.contacts != nullptr) setup.mechanics = plan_.contacts->in_modes();
  if (!creep) return reason_of_round_off(*plan_.system, setup, kernel(), usual);
  std::string why = reason_of_small_steps(*plan_.system, setup, kernel(), usual);
  if (plan_.contacts != nullptr)
    why += "; the scheme nonsmooth takes slow slips in steps of one size";
  return why;
}

Status Driver::steps_go_on(long steps, const Snapshot& now) {
  const Config& config = plan_.config;
  const auto ends = [&](const std::string& reason) {
    return Status{false, now.step, now.time, now.residual, reason};
  };
  if (config.chooses_steps())
    if (const auto why = why_steps_end(steps, now.time)) return ends(*why);
  if (config.steps_max > 0 && kernel().whole_steps() >= config.steps_max)
    return ends(fmt::format("steps_max = {} steps are taken", config.steps_max));
  return {};
}

// So many whole steps, or to the limit.
Status Driver::take_unseen(long count) {
  long left = count, before = -1;
  Status status;
  while (status.ok && left > 0 && std::exchange(before, left) != left) {
    const long whole = kernel().whole_steps(), piece = piece_of(left);
    status = kernel().advance(piece);
    const long taken = kernel().whole_steps() - whole;
    left -= taken;
    if (kernel().off_grid()) before = -1;
    if (!status.ok || !(plan_.config.chooses_steps() || plan_.config.steps_max > 0)) continue;
    if (left > 0 || steps_.until_next() <= taken) {
      kernel().bare_state(row_);
      status = steps_go_on(taken, row_);
    } else {
      count_tries(taken);
    }
  }
  return status;
}

bool Driver::reached_end() const {
  return plan_.config.chooses_steps() ? node_.time == plan_.config.until : steps_left_ <= 0;
}

long Driver::steps_at_once(long count, bool to_end) const {
  const long most = to_end ? steps_left_ : count;
  if (every_node_) return 1;
  const long every = plan_.recording && logged_ == nullptr ? plan_.config.every : kRows;
  const long piece = plan_.setup.on_failure == OnFailure::stop ? kRows : kRescued;
  return piece_of(std::min({every - node_.step % every, most, piece}));
}

// Observes the steps since step `before`, of which the last one began at `begin`; false: the run
// ends here.
bool Driver::observe_steps(long before, double begin, bool at_end) {
  if (!result_.status.ok && rows_watch_ != nullptr)
    result_.status.reason += rows_watch_->remark(node_);
  bool go_on = logged_ != nullptr && times_.empty() ? logged() : good(node_);
  if (go_on && every_node_ && node_.step > before) go_on = observe_step(begin);
  else if (go_on && logged_ == nullptr && plan_.recording && times_.empty() &&
           node_.step % plan_.config.every == 0)
    go_on = record_node();
  if (!go_on || !result_.status.ok || at_end) return go_on;
  result_.status = steps_go_on(node_.step - before, node_);
  return result_.status.ok;
}

void Driver::take_steps(long count, bool to_end) {
  const double from = plan_.config.from, until = plan_.config.until;
  auto next_progress = Clock::now() + std::chrono::milliseconds(200);
  while (!over_ && (to_end ? !reached_end() : count > 0)) {
    const long before = node_.step, whole = kernel().whole_steps();
    const double begin = node_.time;
    result_.status = kernel().advance(steps_at_once(count, to_end));
    if (plan_.events->any()) kernel().state(node_);
    else kernel().bare_state(node_);
    steps_left_ -= kernel().whole_steps() - whole;
    count -= kernel().whole_steps() - whole;
    if (!observe_steps(before, begin, to_end && reached_end())) over_ = true;
    if (to_end && result_.status.ok && !over_ && node_.step == before && !reached_end())
      result_.status = {false, node_.step + 1, node_.time, node_.residual,
                        fmt::format("no step leads on from t = {:.12g}", node_.time)};
    if (!result_.status.ok || node_.step == before) break;  // failed, or at the limit
    if (to_end && request_.progress && Clock::now() >= next_progress) {
      report_progress((node_.time - from) / (until - from));
      next_progress = Clock::now() + std::chrono::milliseconds(200);
    }
    if (!over_ && logged_ == nullptr && !(to_end && reached_end()) && !kernel().off_grid() &&
        (rows_ >= kRows || node_.step - kept_at_ >= kSteps))
      keep();
  }
  if (to_end && !over_ && result_.status.ok) over_ = !output(until);
}

}  // namespace hamel
