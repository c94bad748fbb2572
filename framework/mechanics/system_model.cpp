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
  std::vector<Component> out = components_of(model.group);
  for (size_t i = 0; i < model.rates.size(); ++i) out[i].name = model.rates[i];
  if (model.shape.empty()) return out;
  const std::vector<ShapeCoordinate> shape = shape_of(model.group, out);
  if (shape.size() != model.shape.size())
    throw ConfigError({fmt::format("shape of {}: expected {} names, got {}", model.name,
                                   shape.size(), model.shape.size())});
  for (size_t i = 0; i < shape.size(); ++i)
    out[static_cast<size_t>(shape[i].component)].name = model.shape[i] + "'";
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
