#include <hamel/framework/mechanics/system_model.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {

std::string constraints_in_words(const SystemModel& model) {
  const int rows = model.mechanics->constraint_count(),
            holonomic = model.mechanics->holonomic_rows();
  if (rows == 0) return "no constraint";
  return fmt::format("{} constraint row{}{}", rows, rows == 1 ? "" : "s",
                     holonomic > 0 ? fmt::format(", {} holonomic", holonomic) : "");
}

std::vector<Component> components_of(const SystemModel& model) {
  std::vector<Component> out;
  size_t i = 0;
  for (const GroupFactor& factor : model.group.factors) {
    for (size_t k = 0; k < static_cast<size_t>(factor.dim); ++k)
      out.push_back(
          {model.rates.at(i++), factor.components.empty() ? "" : factor.components[k].unit});
  }
  return out;
}

std::string unit_of_reaction(const SystemModel& model, int row) {
  if (std::find(model.contacts.begin(), model.contacts.end(), row) != model.contacts.end())
    return "N";
  if (model.reactions.empty()) return "";
  const std::string& name = model.reactions[static_cast<size_t>(row)];
  const bool force = std::any_of(model.forces.begin(), model.forces.end(), [&](const auto& f) {
    return f.name == name.substr(0, name.rfind('.'));  // rear.reaction1 is of rear
  });
  return force ? "N" : "";
}

}  // namespace hamel
