// End of a run: a state that is none, the last row and the measurements over all.
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/run/run/driver.hpp>

namespace hamel {

bool Driver::good(const Snapshot& state) {
  if (state.coordinates.empty() && flaw_of(state) == Reason::converged) return true;  // a bare one
  const std::string why = flaw(state);
  if (why.empty()) return true;
  if (result_.status.ok)
    result_.status = {false, state.step, result_.last.time, state.residual, why};
  flawed_ = true;
  return false;
}

// Flaw of its numbers, or the reason why they are no element of the group any more (an angle of 1e9
// rad, a matrix that left the rotations), from which nothing can be measured; "" for none.
std::string Driver::flaw(const Snapshot& state) {
  if (const Reason reason = flaw_of(state); reason != Reason::converged) return to_string(reason);
  if (plan_.geometry == nullptr || state.coordinates.empty()) return "";  // of a bare state
  element_.resize(static_cast<size_t>(plan_.geometry->size()));
  try {
    plan_.geometry->from_coordinates(state.coordinates, element_.data());
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

Result Driver::head() const {
  Result out;
  out.config = plan_.config;
  if (plan_.contacts != nullptr) out.config.slip = true;  // its states are not to be projected
  out.system = plan_.system;
  out.inputs = plan_.setup.inputs;
  out.unused = plan_.unused;
  out.notes = plan_.notes;
  return out;
}

// Without rows: start and end alone. The balance of work needs every node, and is not known.
void Driver::measure_ends_only() {
  if (flawed_) {
    result_.constraint_max = result_.group_defect_max = result_.energy_error_max =
        Measurements::kNone;
    return;
  }
  RunRecorder meter(*plan_.system, plan_.config.start, balance(), plan_.reactions, plan_.motion,
                    {});
  if (meter.wants_nodes()) {
    result_.energy_error_max = Measurements::kNone;
    result_.notes.emplace_back(
        "the energy balance is not known: this run kept no rows (keep_rows, record_to)");
    return;
  }
  Snapshot start;
  plan_.kernel(plan_.setup)->measure(start);
  meter.begin(start);
  meter.finish(result_.last);
  static_cast<Measurements&>(result_) = meter.all();
}

void Driver::measure_all() {
  const Timed timed(in_rows_);
  if (!plan_.recording) {
    const Timed compared(comparing_);
    return measure_ends_only();
  }
  if (logged_ != nullptr) {
    logged_->last = result_.last;
    return result_.unread(logged_);
  }
  {
    const Timed compared(comparing_);
    recorder_->finish(result_.last);
  }
  deliver();
  static_cast<Measurements&>(result_) = recorder_->all();
  result_.notes.insert(result_.notes.end(), recorder_->notes().begin(), recorder_->notes().end());
}

Result& Driver::end() {
  try {
    entered_ = Clock::now();
    begin();
    if (plan_.recording && !over_ && times_.empty()) record_node();
    over_ = true;
    if (!result_.stopped_by_event && !flawed_) {
      kernel().measure(row_);
      if (good(row_) || !plan_.recording) std::swap(result_.last, row_);
    }
    kernel().state(node_);
    Result shell = head();
    result_.config = std::move(shell.config);
    result_.system = std::move(shell.system);
    result_.inputs = std::move(shell.inputs);
    result_.unused = std::move(shell.unused);
    result_.notes = std::move(shell.notes);
    const std::vector<std::string>& stops = plan_.config.stop_at;
    if (!stops.empty() && result_.status.ok && !result_.stopped_by_event && reached_end())
      result_.notes.push_back(fmt::format(
          "stop_at: {}{} was {}met before the end, t = {:.10g}", stops.size() > 1 ? "none of " : "",
          fmt::join(stops, ", "), stops.size() > 1 ? "" : "not ", kernel().time()));
    if (plan_.contacts != nullptr)
      result_.notes.insert(result_.notes.end(), plan_.contacts->notes.begin(),
                           plan_.contacts->notes.end());
    result_.steps = flawed_ && plan_.recording ? result_.last.step : node_.step;
    result_.stats = kernel().stats();
    measure_all();
    const bool timed = watching_ || seconds_.all > 0;
    lap();
    result_.seconds = timed ? seconds_.all : Measurements::kNone;
    result_.recording_seconds = seconds_.recording;
    result_.comparing_seconds = seconds_.comparing;
  } catch (...) {
    rows_to_files_after_failure();
    throw;
  }
  return result_;
}

void Driver::close() {
  for (const auto& sink : sinks_) sink->finish(result_);
}

Result Driver::finish() {
  if (finished_) throw std::logic_error("Run::finish: this run is finished already");
  end();
  close();
  finished_ = true;
  Result out = std::move(result_);
  result_ = Result();
  result_.status = out.status;
  result_.last = out.last;
  result_.events = out.events;
  result_.stopped_by_event = out.stopped_by_event;
  return out;
}

}  // namespace hamel
