// Writes the JSON schemas of configurations and of studies: their options are Config::fields, their
// names the registry's.
//
//   write_schemas DIR       DIR/run.json, DIR/study.json
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

// The words that an option may be, where they are a list.
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
                   {"why", {{"type", "string"}, {"description", "said in every output"}}}};
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

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: write_schemas DIR\n";
    return 2;
  }
  const std::string folder = argv[1];
  std::ofstream(folder + "/run.json") << run().dump(2) << "\n";
  std::ofstream out(folder + "/study.json");
  out << study().dump(2) << "\n";
  return out ? 0 : 1;
}
