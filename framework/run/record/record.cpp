// The record of a run; record_reader.cpp is the way back.
#include <algorithm>
#include <cmath>

#include <sys/utsname.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/names/system_file.hpp>
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

Json record_of(const Result& r) {
  Json parameters = Json::object();
  for (const Field& field : r.system->fields) {
    if (field.value.empty()) continue;  // left out
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
    if (!e.velocity_after.empty()) events.back()["velocity_after"] = json_of(e.velocity_after);
  }
  const double steps = r.steps > 0 ? static_cast<double>(r.steps) : std::nan("");
  Json diagnostics;
  Measurements::fields([&](const Quantity& quantity, const char* suffix, auto member) {
    diagnostics[std::string(quantity.name) + suffix] = json_of(r.*member);
  });
  diagnostics["invariants"] = invariants;
  const std::string& system = r.config.system;
  const bool has_options = !names_file(system) && path_of_system(system) != system;
  Json out = {{"system", has_options ? system : r.system->name},
              {"system_file", names_file(system) ? Json(system) : Json(nullptr)},
              {"group", r.system->group.name}};
  Config::fields([&](const Option& option, auto member) {
    const bool used = std::find(r.unused.begin(), r.unused.end(), option.name) == r.unused.end();
    out[key_in_record(option)] = used ? json_of(r.config.*member) : Json(nullptr);
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
       {{"iterations_mean", json_of(static_cast<double>(r.stats.iterations) / steps)},
        {"iterations_max", r.stats.iterations_max},
        {"rejected", r.stats.rejected},
        {"evaluations", r.stats.evaluations},
        {"evaluations_mean", json_of(static_cast<double>(r.stats.evaluations) / steps)},
        {"residual_max", json_of(r.stats.residual_max)}}},
      {"events", events},
      {"fallbacks", {{"count", r.stats.fallbacks}, {"first", fallbacks(r.stats)}}},
      {"timing",
       {{"seconds", json_of(r.seconds)},
        {"nanoseconds_per_step", json_of(r.seconds * 1e9 / steps)},
        {"recording_seconds", json_of(r.recording_seconds)},
        {"comparing_seconds", json_of(r.comparing_seconds)}}},
      {"version", version()},
      {"git", git_hash()},
      {"host", host_name()},
  });
  return out;
}

}  // namespace

std::string Result::record(int indent) const {
  require_run("record");
  return record_of(*this).dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string host_name() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  return fmt::format("{} {} {}", name.nodename, name.sysname, name.machine);
}

}  // namespace hamel
