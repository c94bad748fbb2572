#include <hamel/framework/mechanics/components.hpp>

namespace hamel {

std::string unit_of_momentum(const Component& component) {
  return component.unit == "rad/s" ? "N m s" : component.unit == "m/s" ? "N s" : "";
}

std::vector<std::string> units_of_element(const GroupInfo& group) {
  std::vector<std::string> out;
  for (const GroupFactor& factor : group.factors) {
    out.insert(out.end(), factor.units.begin(), factor.units.end());
    out.resize(out.size() + static_cast<size_t>(factor.columns) - factor.units.size());
  }
  return out;
}

std::vector<ShapeCoordinate> shape_of(const GroupInfo& group) {
  const std::vector<std::string> units = units_of_element(group);
  std::vector<ShapeCoordinate> out;
  int column = 0, component = 0;
  for (const GroupFactor& factor : group.factors) {
    for (int i = 0; factor.is_shape && i < factor.dim; ++i) {
      const auto at = static_cast<size_t>(column + i);
      out.push_back({column + i, component + i, group.columns.at(at), units[at]});
    }
    column += factor.columns;
    component += factor.dim;
  }
  return out;
}

}  // namespace hamel
