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

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/version.hpp>

namespace hamel {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
template <class Value>
Json json_of(const Value& value) {
  return value;
}
Json json_of(std::optional<double> x) { return x ? json_of(*x) : Json(nullptr); }
Json json_of(const std::vector<double>& values) {
  Json out = Json::array();
  for (double x : values) out.push_back(json_of(x));
  return out;
}

Json json_of(const InputSignal& signal) {
  if (const double* value = std::get_if<double>(&signal)) return *value;
  if (const InputTable* table = std::get_if<InputTable>(&signal))
    return {{"t", table->times}, {"value", table->values}, {"hold", table->hold}};
  return text_of(signal);
}
InputSignal signal_of(const Json& json) {
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return input_signal(json.get<std::string>());
  return InputTable{json.at("t").get<std::vector<double>>(),
                    json.at("value").get<std::vector<double>>(), json.at("hold").get<bool>()};
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

Json element(const GroupInfo& group, const std::vector<double>& coordinates) {
  const auto matrices = group.matrices(coordinates);
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

// What a record calls an option: its "events" are those that were met.
std::string record_key(const Option& option) {
  return std::string(option.name) == "events" ? "watched" : option.name;
}

Json record_of(const Result& r) {
  Json parameters = Json::object();
  for (const Field& field : r.system.fields) {
    parameters[field.name] =
        field.value.size() == 1 ? json_of(field.value[0]) : json_of(field.value);
  }
  Json inputs = Json::object();
  for (const auto& [name, signal] : r.config.inputs) inputs[name] = json_of(signal);
  Json invariants = Json::object();
  for (const InvariantDrift& i : r.invariants) {
    invariants[i.name] = {{"start", json_of(i.start)}, {"drift_max", json_of(i.drift_max)}};
  }
  Json events = Json::array();
  for (const EventMet& e : r.events) {
    events.push_back({{"name", e.name},
                      {"time", e.time},
                      {"element", element(r.system.group, e.coordinates)},
                      {"configuration", json_of(e.coordinates)},
                      {"velocity", json_of(e.velocity)}});
  }
  const double steps = static_cast<double>(std::max(r.steps, 1L));
  Json diagnostics;
  Measurements::fields([&](const Quantity& quantity, const char* suffix, auto member) {
    diagnostics[std::string(quantity.name) + suffix] = json_of(r.*member);
  });
  diagnostics["invariants"] = invariants;
  Json out = {{"system", r.system.name}, {"group", r.system.group.name}};
  Config::fields([&](const Option& option, auto member) {
    const bool used = std::find(r.unused.begin(), r.unused.end(), option.name) == r.unused.end();
    out[record_key(option)] = used ? json_of(r.config.*member) : Json(nullptr);
  });
  out.update(Json{
      {"parameters", parameters},
      {"inputs", inputs},
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
       {{"element", element(r.system.group, r.last.coordinates)},
        {"configuration", json_of(r.last.coordinates)},
        {"velocity", json_of(r.last.velocity)},
        {"momentum", json_of(r.last.momentum)},
        {"energy", json_of(r.last.energy)}}},
      {"diagnostics", diagnostics},
      {"solver_stats",
       {{"iterations_mean", static_cast<double>(r.stats.iterations) / steps},
        {"iterations_max", r.stats.iterations_max},
        {"rejected", r.stats.rejected},
        {"evaluations", r.stats.evaluations},
        {"evaluations_mean", static_cast<double>(r.stats.evaluations) / steps},
        {"residual_max", json_of(r.stats.residual_max)}}},
      {"events", events},
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

// The way back from record_of.
Config Config::continued(const std::string& record, const std::string& origin) {
  Config config;
  try {
    const Json json = Json::parse(record);
    config.system = json.at("system").get<std::string>();
    fields([&](const Option& option, auto member) {
      const auto it = json.find(record_key(option));
      if (it == json.end() || it->is_null() || (it->is_array() && it->empty())) return;
      std::vector<std::string> texts;
      for (const Json& entry : it->is_array() ? *it : Json::array({*it}))
        texts.push_back(entry.is_string() ? entry.get<std::string>() : entry.dump());
      read_text(option.name, text_of(texts), config.*member);
    });
    for (const auto& [name, value] : json.at("parameters").items()) {
      config.parameters[name] = value.is_array() ? value.get<std::vector<double>>()
                                                 : std::vector<double>{value.get<double>()};
    }
    if (const auto given = json.find("inputs"); given != json.end()) {
      for (const auto& [name, signal] : given->items()) config.inputs[name] = signal_of(signal);
    }
    const Json& last = json.at("final");
    config.start.configuration = last.at("configuration").get<std::vector<double>>();
    config.start.velocity = last.at("velocity").get<std::vector<double>>();
    const double span = config.until - config.from;
    config.from = json.at("time").get<double>();
    config.until = config.from + span;
  } catch (const Json::exception& error) {
    throw ConfigError({fmt::format("{}: not the record of a run (hamel run … -o x.json): {}",
                                   origin, error.what())});
  }
  return config;
}

std::string Result::record(int indent) const { return record_of(*this).dump(indent); }

std::string Result::method() const {
  const auto used = [&](const char* option) {
    return std::find(unused.begin(), unused.end(), option) == unused.end();
  };
  return config.scheme + (used("s") ? fmt::format(" (s = {})", config.s) : "") + ", " +
         config.retraction + (used("solver") ? ", " + config.solver : "") +
         (config.compose == "none" ? "" : ", composed by " + config.compose);
}

std::string Result::steps_in_words() const {
  if (!config.chooses_steps()) return fmt::format("h = {}", config.step);
  std::string out = config.rtol ? fmt::format("rtol = {}", *config.rtol) : "";
  if (config.atol) out += fmt::format("{}atol = {}", config.rtol ? ", " : "", *config.atol);
  return out;
}

std::string Result::report() const {
  std::string out =
      fmt::format("{} on {}: {}, {}\n", system.name, system.group.name, method(), steps_in_words());
  const double count = static_cast<double>(std::max(steps, 1L));
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
  for (const std::string& note : notes) line("note", note);
  line("final velocity", join(last.velocity));
  if (std::find(unused.begin(), unused.end(), "solver") == unused.end()) {
    line("solver", fmt::format("{:.2f} iterations a step (max {}), residual at most {:.1e}",
                               static_cast<double>(stats.iterations) / count, stats.iterations_max,
                               stats.residual_max));
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
    const bool always = member == &Result::energy_error_max || member == &Result::constraint_max;
    if (*quantity.title == 0 || (!always && std::isnan(value))) return;
    const bool balance = member == &Result::energy_error_max && std::isfinite(work);
    line(balance ? "energy balance" : quantity.title,
         fmt::format("{:.2e}{}{}", value, member == &Result::energy_error_max ? " (relative)" : "",
                     member == &Result::constraint_max ? ", " + constraints_in_words(system) : ""));
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
  if (config.check) {
    line("estimated error",
         std::isnan(estimated_error)
             ? "unknown: half and a quarter of the step do not agree on an order"
             : fmt::format("{:.2e} of the configuration at the end, observed order {:.2f}",
                           estimated_error, observed_order));
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
