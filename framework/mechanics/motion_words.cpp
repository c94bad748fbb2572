#include <hamel/framework/mechanics/motion_words.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace hamel {

std::vector<Component> components_of(const SystemModel& model) {
  std::vector<Component> out = components_of(model.group);
  const std::vector<std::string>& rates = words_of(model).rates;
  for (size_t i = 0; i < rates.size(); ++i) out[i].name = rates[i];
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
  const MotionWords& words = words_of(model);
  if (words.reactions.empty()) return "";
  const std::string& name = words.reactions[static_cast<size_t>(row)];
  const bool force = std::any_of(words.forces.begin(), words.forces.end(), [&](const auto& f) {
    return f.name == name.substr(0, name.rfind('.'));  // rear.reaction1 is of rear
  });
  return force ? "N" : "";
}

}  // namespace hamel
