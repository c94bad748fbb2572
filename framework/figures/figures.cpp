#include <hamel/framework/figures/figures.hpp>

#include <algorithm>
#include <cctype>
#include <map>

#include <fmt/format.h>

#include <hamel/framework/figures/run_figures.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/names/config.hpp>

namespace hamel::figures {
namespace {

// "Angular velocity" -> "angular-velocity".
std::string one_word(const std::string& title) {
  std::string out;
  for (const char c : title) {
    const bool kept = c < 0 || std::isalnum(c) != 0 || c == '.' || c == '_' || c == '\'';
    if (kept) out += static_cast<char>(c < 0 ? c : std::tolower(c));
    else if (!out.empty() && out.back() != '-') out += '-';
  }
  while (out.ends_with('-')) out.pop_back();
  return out;
}

}  // namespace

void name_apart(std::vector<Figure>& figures) {
  std::map<std::string, int> taken;
  for (Figure& figure : figures) {
    const std::string word = one_word(figure.name.empty() ? figure.title : figure.name);
    const int count = ++taken[word];
    figure.name = count == 1 ? word : fmt::format("{}-no{}", word, count);
  }
}

void put_in_section(const char* section, std::vector<Figure>& figures) {
  for (Figure& figure : figures)
    if (figure.section.empty()) figure.section = section;
}

std::string unit_of(const std::string& name, const SystemModel& system) {
  std::string out;
  Config::fields([&](const Option& option, auto) {
    if (option.name == name) out = option.unit;
  });
  for (const Field& field : system.fields)
    if (field.name == name) out = field.unit;
  return out;
}

std::vector<Figure> of_run(const Registry& registry, const Result& result) {
  std::vector<Figure> out = motion_of_run(registry, result);
  if (result.trajectory.rows() == 0) return out;
  std::vector<Mark> events;
  for (const EventMet& event : result.events) events.push_back({event.time, event.name});
  add_inputs(out, result, events);
  add_physics(out, registry, result, events);
  put_in_section("Velocity, shape and reactions", out);
  add_accuracy(out, result);
  put_in_section("Accuracy", out);
  name_apart(out);
  return out;
}

}  // namespace hamel::figures
