#include <hamel/framework/run/record/result.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/note_lines.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/record/sink.hpp>
#include <hamel/framework/run/record/velocity_text.hpp>

namespace hamel {

Trajectory::Trajectory(std::vector<ColumnGroup> groups) : groups_(std::move(groups)) {
  for (const ColumnGroup& group : groups_)
    columns_.insert(columns_.end(), group.columns.begin(), group.columns.end());
}

void Trajectory::append(std::span<const double> rows) {
  values_.insert(values_.end(), rows.begin(), rows.end());
}

void Trajectory::thin() {
  const size_t width = columns_.size(), count = (rows() + 1) / 2;
  for (size_t i = 1; i < count; ++i)
    std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(2 * i * width), width,
                values_.begin() + static_cast<std::ptrdiff_t>(i * width));
  values_.resize(count * width);
}

std::optional<size_t> Trajectory::find(const std::string& column) const {
  const auto it = std::find(columns_.begin(), columns_.end(), column);
  if (it != columns_.end()) return static_cast<size_t>(it - columns_.begin());
  size_t first = 0;
  for (const ColumnGroup& group : groups_) {
    for (const auto& [name, place] : group.other_names)
      if (name == column) return first + place;
    first += group.columns.size();
  }
  return {};
}

size_t Trajectory::index(const std::string& column) const {
  const std::optional<size_t> place = find(column);
  if (!place) throw ConfigError({unknown_name("column", column, columns_)});
  return *place;
}

bool Trajectory::has(const std::string& column) const { return find(column).has_value(); }

std::vector<double> Trajectory::column(const std::string& name) const {
  const size_t j = index(name);
  std::vector<double> out(rows());
  for (size_t i = 0; i < out.size(); ++i) out[i] = at(i, j);
  return out;
}

// Compiled here rather than in each program that includes it.
Result::Result() = default;
Result::Result(const Result&) = default;
Result::Result(Result&&) noexcept = default;
Result& Result::operator=(const Result&) = default;
Result& Result::operator=(Result&&) noexcept = default;
Result::~Result() = default;

Result& Result::read() {
  if (const auto rows = std::exchange(unread_, nullptr)) rows->read(*this);
  return *this;
}

void Result::require_run(const char* member) const {
  if (system != nullptr) return;
  throw std::logic_error(fmt::format(
      "Result::{}: this result is of no run: it was made by default, or moved from", member));
}

std::string Result::method() const {
  const auto used = [&](const char* option) {
    return std::find(unused.begin(), unused.end(), option) == unused.end();
  };
  return config.scheme + (used("s") ? fmt::format(" (s = {})", config.s) : "") + ", " +
         config.retraction + (used("solver") ? ", " + config.solver : "") +
         (config.compose == "none" ? "" : ", composed by " + config.compose);
}

std::string Result::steps_in_words() const {
  if (!config.chooses_steps()) return fmt::format("h = {}", config.step_or_usual());
  std::string out = config.rtol ? fmt::format("rtol = {}", *config.rtol) : "";
  if (config.atol) out += fmt::format("{}atol = {}", config.rtol ? ", " : "", *config.atol);
  return out;
}

static std::string estimated_error_in_words(const Result& result) {
  if (!result.status.ok) return "not determined: the run has failed";
  if (std::isnan(result.estimated_error))
    return fmt::format("unknown by {}", finer_runs(result.config));
  if (std::isnan(result.observed_order)) {
    return fmt::format(
        "below {:.1e} of the configuration at the end by {}, which agree to round-off: no order "
        "was observed, and what is shorter than a step may have been stepped over",
        result.estimated_error, finer_runs(result.config));
  }
  return fmt::format("{:.2e} of the configuration at the end, observed order {:.2f}{}",
                     result.estimated_error, result.observed_order,
                     result.config.chooses_steps() ? " in the tolerance" : "");
}

static std::string final_velocity(const Result& result) {
  return velocity_in_words(*result.system, result.last.velocity,
                           std::fmax(0, result.exact_velocity_error_max));
}

// No steps have no mean.
static std::string solver_in_words(const SolverStats& stats, long steps) {
  if (steps == 0) return fmt::format("{} iterations", stats.iterations);
  return fmt::format("{:.2f} iterations a step (max {}), residual at most {:.1e}",
                     static_cast<double>(stats.iterations) / static_cast<double>(steps),
                     stats.iterations_max, stats.residual_max);
}

static std::string times_in_words(const Result& result) {
  const double in_steps = result.seconds - result.recording_seconds;
  const auto steps = static_cast<double>(result.steps);
  return fmt::format("{:.3f} s in steps{}; recording {:.3f} s, comparison {:.3f} s", in_steps,
                     steps > 0 ? fmt::format(", {:.0f} ns each", in_steps * 1e9 / steps) : "",
                     result.recording_seconds, result.comparing_seconds);
}

static bool all_holonomic(const Mechanics& mechanics) {
  const int rows = mechanics.constraint_count();
  return rows > 0 && rows == mechanics.holonomic_rows();
}

std::string Result::report(Notes length) const {
  require_run("report");
  std::string out = fmt::format("{} on {}: {}, {}\n", system->name, system->group.name, method(),
                                steps_in_words());
  const auto line = [&](const std::string& name, const std::string& value) {
    out += fmt::format("  {:<22} {}\n", name, value);
  };
  if (status.ok) {
    line("status",
         fmt::format("ok{}, {} steps{} to t = {:.6g}",
                     status.reason.empty() ? "" : " (" + status.reason + ")", steps,
                     stats.rejected > 0 ? fmt::format(" ({} more rejected)", stats.rejected) : "",
                     last.time));
  } else {
    line("status", fmt::format("FAILED in step {} (t = {:.6g}): {}, residual {:.2e}", status.step,
                               status.time, status.reason, status.residual));
    line("kept", fmt::format("{} good steps to t = {:.6g}", steps, last.time));
  }
  out += note_lines(notes, 25, length);
  line("final velocity", final_velocity(*this));
  if (std::find(unused.begin(), unused.end(), "solver") == unused.end()) {
    line("solver", solver_in_words(stats, steps));
  } else {
    line("evaluations", fmt::format("{} of the equations of motion", stats.evaluations));
  }
  if (stats.fallbacks > 0) {
    const Fallback& first = stats.first_fallbacks.front();
    line("fallbacks", fmt::format("{} of {} steps; the first, step {} (t = {:.6g}): {}",
                                  stats.fallbacks, steps, first.step, first.time, first.action));
  }
  fields([&](const Quantity& quantity, const char*, auto member) {
    const double value = this->*member;
    // NaN: there is no such thing here; of an energy or a constraint, something went wrong.
    const bool always = member == &Result::energy_error_max ||
                        (member == &Result::constraint_max && !all_holonomic(*system->mechanics));
    if (*quantity.title == 0 || (!always && std::isnan(value))) return;
    const bool balance = member == &Result::energy_error_max && std::isfinite(work);
    line(
        balance ? "energy balance" : quantity.title,
        fmt::format("{:.2e}{}{}", value, member == &Result::energy_error_max ? " (relative)" : "",
                    member == &Result::constraint_max ? ", " + constraints_in_words(*system) : ""));
  });
  for (size_t i = 0; i < events.size() && i < 10; ++i)
    line("event", fmt::format("{} at t = {:.10g}", events[i].name, events[i].time));
  if (events.size() > 10) line("event", fmt::format("and {} more", events.size() - 10));
  for (const InvariantDrift& i : invariants) {
    line(i.name, fmt::format("{:.6g}, drift {:.2e}", i.start, i.drift_max));
  }
  if (std::isfinite(exact_error_max)) {
    line("against the exact",
         fmt::format("configuration {:.2e} at the end, velocity {:.2e} at most", exact_error_final,
                     exact_velocity_error_max));
  }
  if (config.check) line("estimated error", estimated_error_in_words(*this));
  if (std::isfinite(seconds)) line("time", times_in_words(*this));
  return out;
}

const char* finer_runs(const Config& config) {
  return config.chooses_steps() ? "a tenth and a hundredth of the tolerance"
                                : "half and a quarter of the step";
}

void Result::write(const std::string& path) const {
  require_run("write");
  if (trajectory.groups().empty() && !path.ends_with(".json")) {
    throw ConfigError({fmt::format(
        "write: '{}': the rows of this run are in its files and not in memory; keep_rows() keeps "
        "some of them",
        path)});
  }
  const std::unique_ptr<Sink> sink = make_sink(path);
  std::vector<std::string> watched = config.events;
  watched.insert(watched.end(), config.stop_at.begin(), config.stop_at.end());
  sink->begin({trajectory.groups(), config.to_toml(), "", record(), watched});
  sink->rows(trajectory.values());
  sink->finish(*this);
}

}  // namespace hamel
