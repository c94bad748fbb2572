#include <hamel/framework/mechanics/system.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel {

std::string constraints_in_words(const SystemModel& model) {
  const int rows = model.mechanics->rows(), holonomic = model.mechanics->holonomic_rows();
  if (rows == 0) return "no constraint";
  return fmt::format("{} constraint row{}{}", rows, rows == 1 ? "" : "s",
                     holonomic > 0 ? fmt::format(", {} holonomic", holonomic) : "");
}

namespace detail {

void check_parameters(const std::string& system, const std::vector<Field>& fields,
                      const Parameters& given) {
  std::vector<std::string> mistakes, names;
  for (const Field& field : fields) names.push_back(field.name);
  for (const auto& [name, value] : given) {
    const auto field =
        std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
    if (field == fields.end()) {
      mistakes.push_back(unknown_name("parameter of " + system, name, names));
      continue;
    }
    const bool fits = field->any_length ? !value.empty() : value.size() == field->value.size();
    if (!fits) {
      mistakes.push_back(fmt::format(
          "parameter '{}' of {}: got {} value{}, expected {}", name, system, value.size(),
          value.size() == 1 ? "" : "s",
          field->any_length ? std::string("at least 1") : std::to_string(field->value.size())));
    }
    if (!std::all_of(value.begin(), value.end(), [](double x) { return std::isfinite(x); })) {
      mistakes.push_back(
          fmt::format("parameter '{}' of {}: {} is not finite", name, system, join(value)));
    }
  }
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

}  // namespace detail
}  // namespace hamel
