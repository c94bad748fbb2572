// Writes the JSON schemas of configurations, studies, ensembles and plans: their options are
// Config::fields, their names the registry's; and completes that of mechanisms by the kinds of
// joints and contacts.
//
//   write_schemas DIR mechanism.json       DIR/run.json, DIR/study.json, DIR/ensemble.json,
//   DIR/plan.json, DIR/mechanism.json
#include <fstream>
#include <iostream>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/schemes/composition.hpp>
#include <hamel/systems/by_name.hpp>
#include <hamel/systems/mechanisms/contact.hpp>

namespace {

using Json = nlohmann::ordered_json;
using namespace hamel;  // a program, not a header

Json list_of(const Json& entry) { return {{"type", "array"}, {"items", entry}}; }
Json one_or_more(const Json& entry) { return {{"anyOf", {entry, list_of(entry)}}}; }

Json type_of(double) { return {{"type", "number"}}; }
Json type_of(const std::optional<double>&) { return {{"type", "number"}}; }
Json type_of(long) { return {{"type", "integer"}}; }
Json type_of(bool) { return {{"type", "boolean"}}; }
Json type_of(const std::string&) { return {{"type", "string"}}; }
Json type_of(const std::vector<double>&) { return one_or_more(type_of(0.0)); }
Json type_of(const std::vector<std::string>&) { return one_or_more(type_of(std::string())); }

// The values that an option may have, where they are a list.
std::vector<std::string> words_of(const std::string& option) {
  std::vector<std::string> out;
  if (option == "scheme") {
    out = registry().schemes();
    for (const auto& [alias, scheme] : registry().scheme_aliases()) out.push_back(alias);
  } else if (option == "retraction") {
    out = registry().retractions();
  } else if (option == "solver") {
    out = registry().solvers();
    for (const std::string& absent : registry().absent_solvers()) out.push_back(absent);
  } else if (option == "force_at") {
    out = {"nodes", "base"};
  } else if (option == "compose") {
    for (const Composition& c : compositions()) out.push_back(c.name);
  }
  return out;
}

template <class Value>
Json schema_of(const Option& option, const Value& value) {
  Json out = type_of(value);
  if (const auto words = words_of(option.name); !words.empty()) out = {{"enum", words}};
  return out;
}

std::string description_of(const Option& option) {
  std::string out = option.meaning;
  const std::string unit = option.unit, expected = option.expected;
  if (!unit.empty() && unit != "1") out += ", " + unit;
  if (!expected.empty()) out += "; " + expected;
  return out;
}

Json signal() {
  const Json numbers = list_of(type_of(0.0));
  return {
      {"anyOf",
       {type_of(0.0),
        {{"type", "string"}},
        {{"type", "object"},
         {"additionalProperties", false},
         {"properties", {{"t", numbers}, {"value", numbers}, {"hold", {{"type", "boolean"}}}}}}}}};
}

// [set], [inputs] and the start, of a run and of a system of a study.
Json start_and_parameters() {
  Json out;
  out["set"] = {{"type", "object"},
                {"description", "parameters (hamel describe SYSTEM)"},
                {"additionalProperties", type_of(std::vector<double>())}};
  out["inputs"] = {{"type", "object"},
                   {"description", "a number, table.csv, table.csv:hold, or {t, value, hold}"},
                   {"additionalProperties", signal()}};
  Config::start_fields([&](const Option& option, auto member) {
    out[option.name] = type_of(Start().*member);
    out[option.name]["description"] = description_of(option);
  });
  return out;
}

Json object(const std::string& title, const Json& properties,
            const std::vector<std::string>& need) {
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", title},
          {"type", "object"},
          {"required", need},
          {"additionalProperties", false},
          {"properties", properties}};
}

Json system_name() {
  return {{"type", "string"},
          {"description", "a registered system (hamel list systems), or a file my_system.toml"},
          {"examples", registry().systems_and_files()}};
}

Json run() {
  Json properties = {{"system", system_name()}};
  properties.update(start_and_parameters());
  Config::fields([&](const Option& option, auto member) {
    properties[option.name] = schema_of(option, Config().*member);
    properties[option.name]["description"] = description_of(option);
    if constexpr (!std::is_same_v<std::remove_cvref_t<decltype(Config().*member)>,
                                  std::optional<double>>) {
      if (!text_of(Config().*member).empty()) properties[option.name]["default"] = Config().*member;
    }
  });
  return object("The configuration of a run of hamel", properties, {});
}

Json study() {
  Json system = {{"name", system_name()},
                 {"label", {{"type", "string"}, {"description", "what tables call it"}}}};
  system.update(start_and_parameters());
  Json properties = {
      {"title", {{"type", "string"}}},
      {"mode",
       {{"enum", {"factorial", "zipped"}},
        {"description", "all combinations, or the lists run together"}}},
      {"until", {{"type", "number"}, {"description", "end time, s; each step must divide it"}}},
      {"repeats", {{"type", "integer"}, {"description", "timing rounds"}}},
      {"reference", {{"type", "boolean"}, {"description", "false: times only, no errors"}}},
      {"system", list_of({{"type", "object"},
                          {"required", {"name"}},
                          {"additionalProperties", false},
                          {"properties", system}})}};
  Json excluded = {{"system", one_or_more({{"type", "string"}})},
                   {"why", {{"type", "string"}, {"description", "repeated in every output"}}}};
  Config::fields([&](const Option& option, auto member) {
    if (!option.axis) return;
    const std::string name = option.name;
    Json value = schema_of(option, Config().*member);
    if (name == "rtol" || name == "atol") value = {{"anyOf", {value, {{"const", "fixed"}}}}};
    properties[name] = one_or_more(value);
    properties[name]["description"] = description_of(option);
    excluded[name] = one_or_more({{"type", {"number", "string"}}});
  });
  properties["exclude"] =
      list_of({{"type", "object"}, {"additionalProperties", false}, {"properties", excluded}});
  return object("A study of hamel", properties, {"system"});
}

// The keys of a run, what is varied and what is kept.
Json ensemble() {
  const Json numbers = list_of(type_of(0.0)), text = type_of(std::string()),
             law = {{"type", "object"},
                    {"minProperties", 1},
                    {"properties",
                     {{"values", numbers},
                      {"range", numbers},
                      {"uniform", {{"anyOf", {numbers, {{"const", "so3"}}}}}},
                      {"normal", numbers},
                      {"log_uniform", numbers},
                      {"tau_normal", type_of(std::vector<double>())},
                      {"energy", type_of(0.0)}}},
                    {"additionalProperties", {{"type", "object"}}}};
  const auto with = [](Json value, const char* description) {
    value["description"] = description;
    return value;
  };
  const auto table = [](const Json& properties, const std::vector<std::string>& need) -> Json {
    return {{"type", "object"},
            {"required", need},
            {"additionalProperties", false},
            {"properties", properties}};
  };
  Json properties = run()["properties"];
  properties["members"] = with(type_of(1L), "left out: as many as the lists have values");
  properties["seed"] = with(type_of(1L), "of the random numbers");
  properties["grid"] = with(type_of(true), "all combinations of the lists");
  properties["vary"] = with({{"type", "object"}, {"additionalProperties", law}},
                            "a parameter, an input, speed, start.omega: one law each");
  properties["feedback"] = with({{"type", "object"},
                                 {"required", {"period"}},
                                 {"properties", {{"period", type_of(0.0)}}},
                                 {"additionalProperties", text}},
                                "inputs by formulas of the state, held for a period, s");
  properties["keep"] = with(
      list_of({{"anyOf", {text, table({{"name", text}, {"formula", text}}, {"name", "formula"})}}}),
      "formulas of end.X, start.X, max.X, min.X, at(T).X, event.NAME.count, event.NAME.time");
  properties["class"] =
      with(table({{"formula", text}, {"names", list_of(text)}}, {"formula", "names"}),
           "members by a formula whose value, 0, 1, ..., is that of a name");
  properties["events"] = with(
      {{"anyOf", {properties["events"], {{"type", "object"}, {"additionalProperties", text}}}}},
      "events to locate, or by names, name = \"x > 1\"");
  properties["statistics_at"] = with(type_of(std::vector<double>()), "times, s");
  properties["statistics_of"] =
      with(type_of(std::vector<std::string>()), "left out: coordinates and velocities");
  properties["histograms"] = with(
      {{"type", "object"},
       {"additionalProperties",
        {{"anyOf", {type_of(1L), table({{"bins", type_of(1L)}, {"range", numbers}}, {"bins"})}}}}},
      "of kept quantities: bins, or { bins, range = [from, until] }");
  properties["quantiles"] = with(type_of(std::vector<double>()), "of kept quantities, in [0, 1]");
  properties["covariance"] = with(type_of(true), "of the kept quantities");
  properties["trajectories"] =
      with(list_of(type_of(1L)), "members, from 0, whose runs are written and shown on the page");
  return object("An ensemble of hamel", properties, {"system", "keep"});
}

// The method of a run, a start, an end, costs and bounds.
Json plan() {
  const Json number = type_of(0.0), text = type_of(std::string());
  const auto table = [](const Json& properties) -> Json {
    return {{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
  };
  const auto by_name = [](const Json& value) -> Json {
    return {{"type", "object"}, {"additionalProperties", value}};
  };
  const Json entry = {{"anyOf", {number, {{"const", "free"}}}}};
  const Json of_run = run()["properties"];
  Json properties = {{"system", system_name()}};
  for (const char* name : {"scheme", "s", "retraction", "solver", "tolerance", "force_at",
                           "compose", "start", "no_exact", "slip", "force", "on_failure"})
    if (of_run.contains(name)) properties[name] = of_run[name];
  properties["parameters"] = of_run["set"];
  properties["until"] = {
      {"anyOf", {number, table({{"free", type_of(true)}, {"least", number}, {"most", number}})}},
      {"description", "end time, s, or { free = true, least, most }"}};
  properties["steps"] = {{"type", "integer"}, {"minimum", 2}};
  properties["inputs"] = type_of(std::vector<std::string>());
  properties["from"] = table({{"configuration", list_of(number)}, {"velocity", list_of(number)}});
  properties["to"] = table({{"configuration", list_of(entry)}, {"velocity", list_of(entry)}});
  properties["cost"] =
      table({{"inputs", by_name(number)}, {"running", text}, {"terminal", text}, {"time", number}});
  properties["bounds"] = {{"type", "object"}, {"description", "name = [low, high]"}};
  properties["constraints"] = type_of(std::vector<std::string>());
  properties["guess"] = table({{"file", text}, {"seed", type_of(1L)}});
  return object("A plan of hamel", properties, {"system", "until", "steps", "inputs"});
}

Json described(const char* definition, const Field& field) {
  std::string text = field.meaning;
  if (!field.unit.empty()) text += (text.empty() ? "" : ", ") + field.unit;
  Json out = {{"$ref", std::string("#/definitions/") + definition}};
  if (!text.empty()) out["description"] = text;
  return out;
}
void add_fields(const std::vector<Field>& fields, Json& to) {
  for (const Field& field : fields)
    to[field.name] = described(field.value.size() == 3 ? "point" : "formula", field);
}

// From what no kind of joint or contact decides.
Json mechanism(std::istream& from) {
  using namespace mechanisms;
  Json out = Json::parse(from);
  Json& joint = out["properties"]["joint"]["items"]["properties"];
  joint["kind"] = {{"enum", names_of(joint_kinds())}};
  for (const JointKind& kind : joint_kinds()) add_fields(kind.fields, joint);
  for (const ContactKind& kind : contact_kinds()) {
    Json keys = {{"name", {{"type", "string"}, {"description", "left out: the body's"}}},
                 {"body", type_of(std::string())},
                 {"at", {{"$ref", "#/definitions/point"}, {"description", "m"}}},
                 {"unilateral", {{"type", "boolean"}, {"description", "may it open?"}}}};
    const auto number = [&](const char* name, const char* meaning) {
      keys[name] = {{"$ref", "#/definitions/formula"}, {"description", meaning}};
    };
    number("friction", "coefficient; left out: the contact is ideal");
    number("restitution", "coefficient, of impacts");
    number("static_friction", "while it rolls, at least friction; left out: friction");
    number("tangential_restitution", "coefficient, of the slip in impacts");
    number("share", "of loads that are not determined, with distribution = \"stated\"");
    number("load", "normal force, N, where its height cannot change; left out: of statics");
    if (kind.name == "ball") {
      for (const auto& [key, meaning] :
           {std::pair{"on", "the body on whose sphere or cylinder it rolls; left out: the ground"},
            std::pair{"inside", "the body in whose sphere or cylinder it rolls"}})
        keys[key] = {{"type", "string"}, {"description", meaning}};
    }
    add_fields(kind.fields, keys);
    out["properties"][kind.name] = list_of({{"type", "object"},
                                            {"required", {"body"}},
                                            {"additionalProperties", false},
                                            {"properties", keys}});
    out["properties"][kind.name]["description"] = kind.summary;
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: write_schemas DIR mechanism.json\n";
    return 2;
  }
  const std::string folder = argv[1];
  std::ofstream(folder + "/run.json") << run().dump(2) << "\n";
  std::ofstream(folder + "/study.json") << study().dump(2) << "\n";
  std::ofstream(folder + "/ensemble.json") << ensemble().dump(2) << "\n";
  std::ofstream(folder + "/plan.json") << plan().dump(2) << "\n";
  std::ifstream from(argv[2]);
  std::ofstream out(folder + "/mechanism.json");
  out << mechanism(from).dump(2) << "\n";
  return out ? 0 : 1;
}
