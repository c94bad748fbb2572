// The record of a run, and the run that goes on where one ended.
#include <algorithm>
#include <cmath>

#include <sys/utsname.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/record/run_file.hpp>

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

// Options that a run may be without.
template <class Value>
constexpr bool MayBeNone = false;
template <class Value>
constexpr bool MayBeNone<std::optional<Value>> = true;
template <class Value>
constexpr bool MayBeNone<std::vector<Value>> = true;

// What a record calls an option: its "events" are those that were met.
std::string record_key(const Option& option) {
  return std::string(option.name) == "events" ? "watched" : option.name;
}

Json record_of(const Result& r) {
  Json parameters = Json::object();
  for (const Field& field : r.system->fields) {
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
                      {"element", element(r.system->group, e.coordinates)},
                      {"configuration", json_of(e.coordinates)},
                      {"velocity", json_of(e.velocity)}});
  }
  const double steps = static_cast<double>(std::max(r.steps, 1L));
  Json diagnostics;
  Measurements::fields([&](const Quantity& quantity, const char* suffix, auto member) {
    diagnostics[std::string(quantity.name) + suffix] = json_of(r.*member);
  });
  diagnostics["invariants"] = invariants;
  const std::string& system = r.config.system;
  Json out = {{"system", r.system->name},
              {"system_file", system.ends_with(".toml") ? Json(system) : Json(nullptr)},
              {"group", r.system->group.name}};
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
       {{"element", element(r.system->group, r.last.coordinates)},
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
      {"timing",
       {{"seconds", json_of(r.seconds)},
        {"nanoseconds_per_step", json_of(r.seconds * 1e9 / steps)}}},
      {"version", version()},
      {"git", git_hash()},
      {"host", host_name()},
  });
  return out;
}

}  // namespace

// The way back from record_of.
Config Config::continued(const std::string& record, const std::string& origin) {
  Config config;
  try {
    const Json json = Json::parse(record);
    const auto path = json.find("system_file");
    const bool of_file = path != json.end() && path->is_string();
    config.system = (of_file ? *path : json.at("system")).get<std::string>();
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
    const double span = config.until - config.from, first = config.from;
    config.from = json.at("time").get<double>();
    config.until = config.from + span;
    for (double& time : config.output_times) time = config.from + (time - first);
  } catch (const Json::exception& error) {
    throw ConfigError({fmt::format("{}: not the record of a run (hamel run … -o x.json): {}",
                                   origin, error.what())});
  }
  return config;
}

void read_record(const std::string& record, Result& out) {
  const Json json = Json::parse(record);
  const auto number = [](const Json& value) {
    return value.is_null() ? Measurements::kNone : value.get<double>();
  };
  Config::fields([&](const Option& option, auto member) {
    const bool unused = json.at(record_key(option)).is_null();
    if (unused && !MayBeNone<std::remove_cvref_t<decltype(Config().*member)>>)
      out.unused.push_back(option.name);
  });
  out.notes = json.at("notes").get<std::vector<std::string>>();
  out.status = {json.at("status") == "ok", 0, 0, 0, json.at("reason").get<std::string>()};
  if (const Json& failure = json.at("failure"); !failure.is_null()) {
    out.status.step = failure.at("step").get<long>();
    out.status.time = failure.at("time").get<double>();
    out.status.residual = number(failure.at("residual"));
  }
  out.steps = json.at("steps").get<long>();
  const Json& last = json.at("final");
  out.last.step = out.steps;
  out.last.time = json.at("time").get<double>();
  out.last.coordinates = last.at("configuration").get<std::vector<double>>();
  out.last.velocity = last.at("velocity").get<std::vector<double>>();
  out.last.momentum = last.at("momentum").get<std::vector<double>>();
  out.last.energy = number(last.at("energy"));
  const Json& diagnostics = json.at("diagnostics");
  Measurements::fields([&](const Quantity& quantity, const char* suffix, auto member) {
    out.*member = number(diagnostics.at(std::string(quantity.name) + suffix));
  });
  for (const auto& [name, drift] : diagnostics.at("invariants").items())
    out.invariants.push_back({name, number(drift.at("start")), number(drift.at("drift_max"))});
  for (const Json& event : json.at("events")) {
    out.events.push_back({event.at("name").get<std::string>(), event.at("time").get<double>(),
                          event.at("configuration").get<std::vector<double>>(),
                          event.at("velocity").get<std::vector<double>>()});
  }
  const Json& stats = json.at("solver_stats");
  out.stats.iterations = std::lround(stats.at("iterations_mean").get<double>() *
                                     static_cast<double>(std::max(out.steps, 1L)));
  out.stats.iterations_max = stats.at("iterations_max").get<int>();
  out.stats.rejected = stats.at("rejected").get<long>();
  out.stats.evaluations = stats.at("evaluations").get<long>();
  out.stats.residual_max = number(stats.at("residual_max"));
  const Json& fallbacks = json.at("fallbacks");
  out.stats.fallbacks = fallbacks.at("count").get<long>();
  for (const Json& f : fallbacks.at("first"))
    out.stats.first_fallbacks.push_back(
        {f.at("step").get<long>(), number(f.at("time")), f.at("action").get<std::string>()});
  out.seconds = number(json.at("timing").at("seconds"));
}

std::string Result::record(int indent) const { return record_of(*this).dump(indent); }

std::string host_name() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  return fmt::format("{} {} {}", name.nodename, name.sysname, name.machine);
}

}  // namespace hamel
