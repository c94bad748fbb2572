#include "description.hpp"

#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/schemes/composition.hpp>
#include <hamel/systems/by_name.hpp>
#include <hamel/systems/by_text.hpp>
#include <hamel/systems/mechanisms/library.hpp>

namespace hamel::playground {
namespace {

// Infinite ends are null.
Json range_of(const Range& range) {
  const auto end = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  return {{"least", end(range.least)},
          {"most", end(range.most)},
          {"open", range.open},
          {"words", range.words()}};
}

std::string number(const std::vector<double>& value) {
  if (value.size() == 1) return fmt::format("{}", value.front());
  return fmt::format("[{}]", fmt::join(value, ", "));
}

const std::string* file_of(const std::string& name) {
  for (const auto& [mechanism, text] : mechanisms::library())
    if (mechanism == name) return &text;
  return nullptr;
}

// The configuration of a run, each parameter with its unit and meaning.
std::string configuration_of(const SystemDescription& d) {
  std::string out = fmt::format("# {}\nsystem = \"{}\"\nuntil = 20  # s\n", d.summary, d.name);
  if (!d.parameters.empty()) out += "\n[set]\n";
  for (const Field& field : d.parameters) {
    if (field.value.empty()) continue;  // left out
    const std::string unit = field.unit == "1" ? "" : field.unit;
    const char* const between = unit.empty() || field.meaning.empty() ? "" : ", ";
    const std::string comment = fmt::format("{}{}{}", unit, between, field.meaning);
    out += fmt::format("{} = {}{}\n", field.name, number(field.value),
                       comment.empty() ? "" : "  # " + comment);
  }
  return out;
}

}  // namespace

Json list_of_systems() {
  Json out = Json::array();
  for (const std::string& name : systems()) {
    const SystemInfo* info = registry().system(name);
    out.push_back({{"name", name},
                   {"summary", info->summary},
                   {"mechanism", file_of(name) != nullptr},
                   {"inputs", !info->inputs.empty()}});
  }
  return out;
}

std::string text_of_system(const std::string& name) {
  if (const std::string* const text = file_of(name)) return *text;
  return configuration_of(describe_system(name));
}

Json list_of_options() {
  Json out = Json::array();
  const Config usual;
  Config::fields([&](const Option& option, auto) {
    out.push_back({{"name", option.name},
                   {"unit", option.unit},
                   {"meaning", option.meaning},
                   {"default", usual.text(option.name)},
                   {"expected", option.expected}});
    const std::string name = option.name;
    Json& last = out.back();
    if (name == "scheme") last["names"] = schemes();
    if (name == "retraction") last["names"] = retractions();
    if (name == "solver") last["names"] = solvers();
    if (name == "compose")
      for (const Composition& c : compositions()) last["names"].push_back(c.name);
  });
  return out;
}

Json description_of(const SystemModel& model) {
  const ModelDescription d = describe_model(model);
  Json parameters = Json::array(), inputs = Json::array();
  for (const Field& field : d.parameters) {
    parameters.push_back({{"name", field.name},
                          {"value", field.value},
                          {"unit", field.unit},
                          {"meaning", field.meaning},
                          {"range", range_of(field.range)}});
  }
  for (const InputField& field : d.inputs) {
    inputs.push_back({{"name", field.name},
                      {"unit", field.unit},
                      {"meaning", field.meaning},
                      {"range", range_of(field.range)}});
  }
  return {{"name", d.name},
          {"group", d.group},
          {"parameters", parameters},
          {"inputs", inputs},
          {"coordinates", d.coordinates},
          {"velocities", d.velocities},
          {"events", d.events},
          {"speed", static_cast<bool>(model.start_at_speed)}};
}

}  // namespace hamel::playground
