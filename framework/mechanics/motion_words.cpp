#include <hamel/framework/mechanics/motion_words.hpp>

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

}  // namespace hamel
