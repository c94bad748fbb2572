#include <hamel/framework/run/data/event_formula.hpp>

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <hamel/framework/mechanics/quantity_names.hpp>

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

std::optional<Event> event_of_formula(const SystemModel& system, const std::string& text,
                                      std::vector<std::string>& mistakes) {
  const size_t at = sign_of(text);
  if (at == std::string::npos) return {};
  const std::string formula = fmt::format("({}) - ({})", text.substr(0, at), text.substr(at + 1));
  Event out{text, "both sides are equal", 0, {}};
  if (text[at] == '>') out.meaning = "the left side becomes larger", out.direction = 1;
  if (text[at] == '<') out.meaning = "the left side becomes smaller", out.direction = -1;
  const QuantityNames names(system);
  try {
    out.value = value_of_state(Expression(names.in_formula(formula), names.variables(),
                                          constants_of(system, names.variables())));
    return out;
  } catch (const ExpressionError& error) {
    mistakes.push_back(fmt::format("events: '{}': {}", text, names.in_words(error.what())));
    return {};
  }
}

}  // namespace hamel
