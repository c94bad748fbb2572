#include <hamel/framework/run/result.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <sstream>

#include <sys/utsname.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/version.hpp>

namespace hamel {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
template <class Value>
Json json_of(const Value& value) {
  return value;
}
Json json_of(const std::vector<double>& values) {
  Json out = Json::array();
  for (double x : values) out.push_back(json_of(x));
  return out;
}

Json matrix(const PlainMatrix& m) {
  Json rows = Json::array();
  for (long i = 0; i < m.rows; ++i) {
    Json row = Json::array();
    for (long j = 0; j < m.columns; ++j) row.push_back(json_of(m(i, j)));
    rows.push_back(row);
  }
  return rows;
}

Json element(const Result& result) {
  const auto matrices = result.system.group.matrices(result.last.coordinates);
  if (matrices.size() == 1) return matrix(matrices.front());
  Json out = Json::array();
  for (const auto& m : matrices) out.push_back(matrix(m));
  return out;
}

Json fallbacks(const SolverStats& stats) {
  Json out = Json::array();
  for (const Fallback& f : stats.first_fallbacks) {
    out.push_back({{"step", f.step}, {"time", json_of(f.time)}, {"action", f.action}});
  }
  return out;
}

Json record_of(const Result& r) {
  Json parameters = Json::object();
  for (const Field& field : r.system.fields) {
    parameters[field.name] =
        field.value.size() == 1 ? json_of(field.value[0]) : json_of(field.value);
  }
  Json invariants = Json::object();
  for (const InvariantDrift& i : r.invariants) {
    invariants[i.name] = {{"start", json_of(i.start)}, {"drift_max", json_of(i.drift_max)}};
  }
  const double steps = static_cast<double>(std::max(r.steps, 1L));
  Json diagnostics;
  Measurements::fields([&](const Quantity& quantity, const char* suffix, auto member) {
    diagnostics[std::string(quantity.name) + suffix] = json_of(r.*member);
  });
  diagnostics["invariants"] = invariants;
  Json out = {{"system", r.system.name}, {"group", r.system.group.name}};
  Config::fields(
      [&](const Option& option, auto member) { out[option.name] = json_of(r.config.*member); });
  out.update(Json{
      {"parameters", parameters},
      {"start",
       {{"configuration", json_of(r.config.start.configuration)},
        {"velocity", json_of(r.config.start.velocity)}}},
      {"notes", r.notes},
      {"status", r.status.ok ? "ok" : "failed"},
      {"reason", r.status.reason},
      {"steps", r.steps},
      {"time", r.last.time},
      {"failure", r.status.ok ? Json(nullptr)
                              : Json{{"step", r.status.step},
                                     {"time", r.status.time},
                                     {"residual", json_of(r.status.residual)}}},
      {"final",
       {{"element", element(r)},
        {"velocity", json_of(r.last.velocity)},
        {"momentum", json_of(r.last.momentum)},
        {"energy", json_of(r.last.energy)}}},
      {"diagnostics", diagnostics},
      {"solver_stats",
       {{"iterations_mean", static_cast<double>(r.stats.iterations) / steps},
        {"iterations_max", r.stats.iterations_max},
        {"evaluations_mean", static_cast<double>(r.stats.evaluations) / steps},
        {"residual_max", json_of(r.stats.residual_max)}}},
      {"fallbacks", {{"count", r.stats.fallbacks}, {"first", fallbacks(r.stats)}}},
      {"timing", {{"seconds", r.seconds}, {"nanoseconds_per_step", r.seconds * 1e9 / steps}}},
      {"version", version()},
      {"git", git_hash()},
      {"host", host_name()},
  });
  return out;
}

}  // namespace

size_t Trajectory::index(const std::string& column) const {
  const auto it = std::find(columns_.begin(), columns_.end(), column);
  if (it == columns_.end()) throw ConfigError({unknown_name("column", column, columns_)});
  return static_cast<size_t>(it - columns_.begin());
}

bool Trajectory::has(const std::string& column) const {
  return std::find(columns_.begin(), columns_.end(), column) != columns_.end();
}

std::vector<double> Trajectory::column(const std::string& name) const {
  const size_t j = index(name);
  std::vector<double> out(rows());
  for (size_t i = 0; i < out.size(); ++i) out[i] = at(i, j);
  return out;
}

std::string Result::record(int indent) const { return record_of(*this).dump(indent); }

std::string Result::report() const {
  std::string out =
      fmt::format("{} on {}: {} (s = {}), {}, {}{}, h = {}\n", system.name, system.group.name,
                  config.scheme, config.s, config.retraction, config.solver,
                  config.compose == "none" ? "" : ", composed by " + config.compose, config.step);
  const double count = static_cast<double>(std::max(steps, 1L));
  const auto line = [&](const std::string& name, const std::string& value) {
    out += fmt::format("  {:<22} {}\n", name, value);
  };
  if (status.ok) {
    line("status",
         fmt::format("ok{}, {} steps to t = {:.6g}",
                     status.reason.empty() ? "" : " (" + status.reason + ")", steps, last.time));
  } else {
    line("status", fmt::format("FAILED in step {} (t = {:.6g}): {}, residual {:.2e}", status.step,
                               status.time, status.reason, status.residual));
    line("kept", fmt::format("{} good steps to t = {:.6g}", steps, last.time));
  }
  for (const std::string& note : notes) line("note", note);
  line("final velocity", join(last.velocity));
  line("solver", fmt::format("{:.2f} iterations a step (max {}), residual at most {:.1e}",
                             static_cast<double>(stats.iterations) / count, stats.iterations_max,
                             stats.residual_max));
  if (stats.fallbacks > 0) {
    const Fallback& first = stats.first_fallbacks.front();
    line("fallbacks", fmt::format("{} of {} steps; the first, step {} (t = {:.6g}): {}",
                                  stats.fallbacks, steps, first.step, first.time, first.action));
  }
  fields([&](const Quantity& quantity, const char*, auto member) {
    const double value = this->*member;
    if (*quantity.title == 0 || (member == &Result::reaction_work && !std::isfinite(value))) return;
    line(quantity.title,
         fmt::format("{:.2e}{}{}", value, member == &Result::energy_error_max ? " (relative)" : "",
                     member == &Result::constraint_max ? ", " + constraints_in_words(system) : ""));
  });
  for (const InvariantDrift& i : invariants) {
    line(i.name, fmt::format("{:.6g}, drift {:.2e}", i.start, i.drift_max));
  }
  if (std::isfinite(exact_error_max)) {
    line("against the exact",
         fmt::format("configuration {:.2e} at the end, velocity {:.2e} at most", exact_error_final,
                     exact_velocity_error_max));
  }
  line("time", fmt::format("{:.3f} s, {:.0f} ns a step", seconds, seconds * 1e9 / count));
  return out;
}

void Result::write_csv(std::ostream& out) const {
  fmt::memory_buffer text;
  const auto append = [&](std::string_view piece) { text.append(piece); };
  for (size_t j = 0; j < trajectory.columns().size(); ++j) {
    if (j > 0) append(",");
    append(trajectory.columns()[j]);
  }
  append("\n");
  for (size_t i = 0; i < trajectory.rows(); ++i) {
    const auto row = trajectory.row(i);
    for (size_t j = 0; j < row.size(); ++j) {
      fmt::format_to(std::back_inserter(text), "{}{:.17g}", j > 0 ? "," : "", row[j]);
    }
    append("\n");
  }
  std::istringstream lines(record());
  for (std::string line; std::getline(lines, line);) append("# " + line + "\n");
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
}

void Result::write(const std::string& path) const {
  const std::string extension = std::filesystem::path(path).extension();
  if (extension == ".csv") {
    std::ostringstream text;
    write_csv(text);
    write_file(path, text.str());
  } else if (extension == ".json") {
    write_file(path, record() + "\n");
  } else {
    throw ConfigError({unknown_name("output format", extension, output_formats())});
  }
}

std::string host_name() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  return fmt::format("{} {} {}", name.nodename, name.sysname, name.machine);
}

const std::vector<std::string>& output_formats() {
  static const std::vector<std::string> all = {".csv", ".json"};
  return all;
}

void write_file(const std::string& path, const std::string& text) {
  const std::string part = path + ".part";
  std::ofstream out(part, std::ios::binary);
  out << text;
  out.close();
  if (!out || std::rename(part.c_str(), path.c_str()) != 0) {
    std::remove(part.c_str());
    throw ConfigError({fmt::format("output: cannot write '{}'", path)});
  }
}

std::string unwritable(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (path.empty()) return "output: an empty path";
  if (fs::is_directory(path, error)) return fmt::format("output: '{}' is a directory", path);
  const std::string part = path + ".part";
  const bool opened = std::ofstream(part).is_open();
  fs::remove(part, error);
  return opened ? "" : fmt::format("output: cannot write '{}'", path);
}

}  // namespace hamel
