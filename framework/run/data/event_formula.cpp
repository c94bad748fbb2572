#include <hamel/framework/run/data/event_formula.hpp>

#include <algorithm>
#include <cctype>
#include <map>

#include <fmt/format.h>

namespace hamel {
namespace {

// The place of the sign between the two sides: a single =, else a single < or >; npos where there
// is none.
size_t sign_of(const std::string& text) {
  const auto alone = [&](size_t i) {  // no part of ==, <=, >=, !=
    const auto sign = [](char c) { return c == '=' || c == '<' || c == '>' || c == '!'; };
    return (i == 0 || !sign(text[i - 1])) && (i + 1 == text.size() || !sign(text[i + 1]));
  };
  for (const std::string_view signs : {"=", "<>"}) {
    size_t found = std::string::npos, count = 0;
    for (size_t i = 0; i < text.size(); ++i) {
      if (signs.find(text[i]) == std::string_view::npos || !alone(i)) continue;
      found = i;
      ++count;
    }
    if (count == 1) return found;
    if (count > 1) break;
  }
  return std::string::npos;
}

// A column of a product as a formula may have it: "1_x" -> "x_1".
std::string usable(const std::string& column) {
  const size_t digits = column.find_first_not_of("0123456789");
  const bool numbered = digits > 0 && digits != std::string::npos && column[digits] == '_';
  return numbered ? column.substr(digits + 1) + "_" + column.substr(0, digits) : column;
}

// A variable hides a parameter of its name.
std::map<std::string, double> constants_of(const SystemModel& system,
                                           const std::vector<std::string>& variables) {
  std::map<std::string, double> out;
  for (const Field& field : system.fields) {
    for (size_t i = 0; i < field.value.size(); ++i) {
      const std::string name =
          field.value.size() == 1 ? field.name : fmt::format("{}{}", field.name, i + 1);
      if (std::find(variables.begin(), variables.end(), name) == variables.end())
        out.emplace(name, field.value[i]);
    }
  }
  return out;
}

}  // namespace

std::string with_usable_names(std::string text, const std::vector<std::string>& columns) {
  const auto of_name = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.'; };
  for (const std::string& column : columns) {
    const std::string name = usable(column);
    if (name == column) continue;
    for (size_t at = 0; (at = text.find(column, at)) != std::string::npos; at += name.size()) {
      const size_t behind = at + column.size();
      if ((at == 0 || !of_name(text[at - 1])) && (behind == text.size() || !of_name(text[behind])))
        text.replace(at, column.size(), name);
    }
  }
  return text;
}

std::vector<std::string> state_variables(const SystemModel& system) {
  std::vector<std::string> out = {"t"};
  for (const std::string& column : system.group.columns) out.push_back(usable(column));
  const std::vector<Component> components = components_of(system);
  for (const Component& component : components) out.push_back(component.name);
  for (size_t i = 0; i < components.size(); ++i) out.push_back(fmt::format("xi{}", i + 1));
  for (size_t i = 0; i < out.size(); ++i)
    if (std::find(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(i), out[i]) !=
        out.begin() + static_cast<std::ptrdiff_t>(i))
      out[i].clear();
  return out;
}

std::optional<Event> event_of_formula(const SystemModel& system, const std::string& text,
                                      std::vector<std::string>& mistakes) {
  const size_t at = sign_of(text);
  if (at == std::string::npos) return {};
  const std::string formula = fmt::format("({}) - ({})", text.substr(0, at), text.substr(at + 1));
  Event out{text, "both sides are equal", 0, {}};
  if (text[at] == '>') out.meaning = "the left side becomes larger", out.direction = 1;
  if (text[at] == '<') out.meaning = "the left side becomes smaller", out.direction = -1;
  const std::vector<std::string> variables = state_variables(system);
  try {
    out.value = value_of_state(Expression(with_usable_names(formula, system.group.columns),
                                          variables, constants_of(system, variables)));
    return out;
  } catch (const ExpressionError& error) {
    mistakes.push_back(fmt::format("events: '{}': {}", text, error.what()));
    return {};
  }
}

}  // namespace hamel
