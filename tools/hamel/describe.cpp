// hamel describe: formula, parameters with units and defaults, what is exactly known, source.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/analysis/equations.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/run/events.hpp>
#include <hamel/framework/schemes/composition.hpp>
#include <hamel/systems/by_name.hpp>
#include <hamel/systems/mechanisms/library.hpp>
#include <hamel/systems/simulate.hpp>

#include "commands.hpp"
#include "words/description_text.hpp"
#include "words/screen.hpp"

namespace hamel::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string words_of(const Range& range) {
  return range.words() + (range.moments ? ", of a rigid body" : "");
}

// The start of a system, its defaults filled in.
Json start_of(const SystemModel& model) {
  Json out;
  out["configuration"] = model.start.configuration;
  if (model.start.configuration.empty()) out["configuration"] = model.group.identity;
  if (!model.start.velocity.empty()) out["velocity"] = model.start.velocity;
  if (!model.start.momentum.empty()) out["momentum"] = model.start.momentum;
  return out;
}

Json events(const SystemModel& model) {
  Json out = Json::array();
  for (const Event& event : events_of(model)) {
    out.push_back({{"name", event.name},
                   {"direction", event.direction > 0   ? "upwards"
                                 : event.direction < 0 ? "downwards"
                                                       : "both ways"},
                   {"meaning", event.meaning}});
  }
  return out;
}

Json parameters_of(const std::vector<Field>& fields) {
  Json parameters = Json::array();
  for (const Field& field : fields) {
    Json value = field.value.size() == 1 ? Json(field.value[0]) : Json(field.value);
    if (field.value.empty()) value = nullptr;  // may be left out
    parameters.push_back({{"name", field.name},
                          {"default", std::move(value)},
                          {"unit", field.unit},
                          {"range", words_of(field.range)},
                          {"meaning", field.meaning}});
  }
  return parameters;
}

// Adds parts, freedoms and rows of a mechanism by name. (Whether it is nonholonomic takes an
// analysis: --analyse.)
void add_parts(Json& out, const SystemModel& model) {
  const Mechanics& mechanics = *model.mechanics;
  out["parts"] = model.parts;
  out["reactions"] = model.reactions;
  for (const Sensor& sensor : model.sensors) out["sensors"].push_back(sensor.name);
  for (const OutputFormula& output : model.outputs) out["outputs"][output.name] = output.formula;
  out["dimension"] = mechanics.dim();
  out["holonomic_rows"] = mechanics.holonomic_rows();
  if (model.contact_laws.empty())  // with friction they are not the same all the time
    out["directions"] = mechanics.dim() - mechanics.constraint_count();
  out["start_parameters"] = model.start_parameters;
  if (!model.notes.empty()) out["notes"] = model.notes;
}

Json inputs_of(const std::vector<InputField>& fields) {
  Json inputs = Json::array();
  for (const InputField& input : fields) {
    inputs.push_back({{"name", input.name},
                      {"unit", input.unit},
                      {"range", words_of(input.range)},
                      {"meaning", input.meaning}});
  }
  return inputs;
}

Json describe_system(const SystemInfo& info, const Parameters& given) {
  SystemModel model = info.make(given);
  registry().complete(model);
  Json out = {{"kind", "system"},
              {"name", info.name},
              {"summary", info.summary},
              {"group", info.group.name},
              {"columns", model.group.columns},
              {"rates", model.rates},
              {"formula", info.formula},
              {"parameters", parameters_of(info.fields)},
              {"inputs", inputs_of(info.inputs)},
              {"start", start_of(model)},
              {"events", events(model)},
              {"known", info.known},
              {"source", info.source}};
  if (!model.parts.empty()) add_parts(out, model);
  return out;
}

// Formulas that have no value where the system starts are reported before a run.
void check_start(const SystemModel& model) {
  const auto geometry = registry().geometry(model.group.name, "exp");
  if (!model.start_mistakes || geometry == nullptr) return;
  std::vector<double> g(static_cast<size_t>(geometry->size()));
  geometry->from_coordinates(start_of(model)["configuration"].get<std::vector<double>>(), g.data());
  std::vector<double> xi = model.start.velocity;
  if (xi.empty()) xi.assign(static_cast<size_t>(geometry->dim()), 0);
  const auto mistakes = model.start_mistakes(0, g.data(), xi, nullptr);
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

// A system by data, or a mechanism.
Json describe_file(const std::string& path, const Parameters& given) {
  const SystemModel model = data_system_maker(registry(), path)(given);
  check_start(model);
  const Mechanics& mechanics = *model.mechanics;
  Json out = {{"kind", "system"},
              {"name", model.name},
              {"file", path},
              {"group", model.group.name},
              {"columns", model.group.columns},
              {"rates", model.rates},
              {"constraints", constraints_in_words(model)},
              {"left_invariant", mechanics.left_invariant()},
              {"forces", mechanics.has_force()},
              {"drift", mechanics.has_drift()},
              {"parameters", parameters_of(model.fields)},
              {"inputs", inputs_of(model.inputs)},
              {"start", start_of(model)},
              {"events", events(model)}};
  if (!model.parts.empty()) {
    add_parts(out, model);
    return out;
  }
  out["formulas"] = Json::object();
  for (const auto& [entry, text] : model.formulas) out["formulas"][entry] = text;
  out["invariants"] = Json::array();
  for (const Invariant& invariant : model.invariants) out["invariants"].push_back(invariant.name);
  return out;
}

Json describe_group(const GroupInfo& info) {
  return {{"kind", "group"},           {"name", info.name},
          {"summary", info.summary},   {"formula", info.formula},
          {"dim", info.dim},           {"columns", info.columns},
          {"identity", info.identity}, {"retractions", registry().retractions_or_common(info.name)},
          {"source", info.source}};
}

Json describe_retraction(const std::string& name) {
  Json where = Json::array();
  std::string source;
  for (const std::string& group : registry().groups()) {
    if (const RetractionInfo* info = registry().retraction(group, name)) {
      where.push_back({{"group", group},
                       {"formula", info->formula},
                       {"domain", info->domain},
                       {"symmetric", info->symmetric}});
      if (source.empty()) source = info->source;
    }
  }
  return {{"kind", "retraction"}, {"name", name}, {"groups", where}, {"source", source}};
}

// Claims of a scheme for each kind of run that it distinguishes; one that makes no use of s has
// no s in it.
Json claims(const SchemeInfo& info, bool left_invariant) {
  Json out = Json::object();
  for (const double s : info.uses_s ? std::vector<double>{0.5, 0} : std::vector<double>{0}) {
    for (const bool symmetric : {true, false}) {
      const ClaimedOrder claimed = info.claim(s, symmetric, left_invariant);
      out[fmt::format("{}{} retraction",
                      !info.uses_s ? ""
                      : s == 0.5   ? "s = 1/2, "
                                   : "other s, ",
                      symmetric ? "symmetric" : "other")] = {{"order", claimed.order},
                                                             {"reversible", claimed.reversible}};
    }
  }
  return out;
}

Json describe_scheme(const SchemeInfo& info) {
  return {
      {"kind", "scheme"},
      {"name", info.name},
      {"formula", info.formula},
      {"uses_s", info.uses_s},
      {"keeps_the_constraint", info.adapted},
      {"steps_admissible", info.steps_admissible},
      {"constraint", !info.adapted ? "not kept"
                     : info.steps_admissible
                         ? "kept at the nodes, and by the velocity of each step"
                         : "kept at the nodes; the velocity of a step satisfies "
                           "it up to the error of the step only"},
      {"steps", info.estimates_error ? "of one size, or chosen by the estimated error (rtol)"
                : info.varies_steps
                    ? "of one size, or at s = 1/2 chosen by a reversible control (rtol)"
                    : "of one size"},
      {"general_systems", !info.left_invariant_only},
      {"claims", claims(info, true)},
      {"claims_on_general_systems", info.left_invariant_only ? Json(nullptr) : claims(info, false)},
      {"source", info.source}};
}

Json describe_solver(const SolverInfo& info, bool built) {
  Json out = {{"kind", "solver"},
              {"name", info.name},
              {"summary", info.summary},
              {"method", info.method},
              {"stops_at", info.stops},
              {"judged_by", "|F(x)|/scale <= tolerance, evaluated at the x returned"},
              {"package", info.package},
              {"source", info.source}};
  if (!built) out["built"] = registry().missing_solver(info.name);
  return out;
}

Json description_of(const std::string& name, const Parameters& given) {
  const Registry& all = registry();
  if (const SystemInfo* info = all.system(name)) return describe_system(*info, given);
  if (names_file(name)) return describe_file(name, given);
  if (!given.empty()) throw ConfigError({fmt::format("set: {} is no system", name)});
  if (const SchemeInfo* info = all.scheme(name)) {
    Json out = describe_scheme(*info);
    if (name != info->name) {
      out["name"] = name;
      out["alias_of"] = info->name;
    }
    return out;
  }
  if (const SolverInfo* info = all.solver(name)) return describe_solver(*info, true);
  if (const SolverInfo* info = all.absent_solver(name)) return describe_solver(*info, false);
  if (const auto info = all.group_or_product(name)) return describe_group(*info);
  if (name.find_first_of("*^") != std::string::npos) throw ConfigError({all.missing_group(name)});
  std::vector<std::string> known;
  for (const std::string& retraction : all.retractions()) {
    if (retraction == name) return describe_retraction(name);
  }
  for (const Composition& c : compositions()) {
    if (c.name == name) {
      return {{"kind", "composition"},
              {"name", name},
              {"order", c.order},
              {"coefficients", c.coefficients},
              {"source", c.source}};
    }
  }
  for (const auto& names :
       {all.systems_and_files(), all.groups(), all.retractions(), all.schemes(), all.solvers()}) {
    known.insert(known.end(), names.begin(), names.end());
  }
  throw ConfigError({unknown_name("name", name, known)});
}

// A mechanism as its file, which the program reads.
std::string toml_of(const std::string& name) {
  if (options_of_system(name).contains("hold"))
    throw ConfigError({"--toml: leave --hold out, and set held = true at the joint in the file"});
  if (names_file(name)) {
    (void)data_system_maker(registry(), name)({});
    return converted(registry(), name, read_system_file(name)).toml;
  }
  std::vector<std::string> known;
  for (const auto& [mechanism, text] : mechanisms::library()) {
    if (mechanism == name) return text;
    known.push_back(mechanism);
  }
  throw ConfigError({"--toml: " + unknown_name("mechanism", name, known)});
}

std::string equations_of(const DescribeOptions& options) {
  const SystemInfo* info = registry().system(options.name);
  if (info == nullptr && !names_file(options.name))
    throw ConfigError({unknown_name("system", options.name, registry().systems_and_files())});
  const SystemModel model = info != nullptr
                                ? info->make(options.parameters)
                                : data_system_maker(registry(), options.name)(options.parameters);
  Simulation simulation = simulate(options.name);
  for (const auto& [name, values] : options.parameters) simulation.set(name, values);
  if (!model.start_from && model.start.velocity.empty() && model.start.momentum.empty())
    simulation.start({.velocity = std::vector<double>(model.rates.size())});
  return Equations(simulation).formulas(options.equations);
}

}  // namespace

int describe(const DescribeOptions& options) {
  if (options.toml) {
    say("{}", toml_of(options.name));
    return 0;
  }
  if (!options.equations.empty()) {
    say("{}", equations_of(options));
    return 0;
  }
  if (options.analyse) return analyse(options);
  const Json json = description_of(options.name, options.parameters);
  if (options.json) say_json(json);
  else print_description(json, Notes{options.verbose});
  return 0;
}

}  // namespace hamel::tools
