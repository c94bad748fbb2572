#include <hamel/framework/mechanics/components.hpp>

#include <algorithm>

namespace hamel {

std::vector<Component> components_of(const GroupInfo& group) {
  const std::vector<GroupFactor>& factors = group.factors;
  std::vector<Component> out;
  for (size_t f = 0; f < factors.size(); ++f) {
    const bool several =
        std::count_if(factors.begin(), factors.end(),
                      [&](const GroupFactor& other) { return other.name == factors[f].name; }) > 1;
    for (Component c : factors[f].components) {
      if (several) {
        const bool rate = c.name.ends_with('\'');
        const std::string stem = rate ? c.name.substr(0, c.name.size() - 1) : c.name;
        c.name = stem + "_" + std::to_string(f + 1) + (rate ? "'" : "");
      }
      out.push_back(c);
    }
    for (int i = static_cast<int>(factors[f].components.size()); i < factors[f].dim; ++i)
      out.push_back({"xi" + std::to_string(out.size() + 1), ""});
  }
  return out;
}

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

std::vector<ShapeCoordinate> shape_of(const GroupInfo& group,
                                      const std::vector<Component>& components) {
  const std::vector<std::string> units = units_of_element(group);
  std::vector<ShapeCoordinate> out;
  int column = 0, component = 0;
  for (const GroupFactor& factor : group.factors) {
    for (int i = 0; factor.is_shape && i < factor.dim; ++i) {
      std::string name = components.at(static_cast<size_t>(component + i)).name;
      if (name.ends_with('\'')) name.pop_back();
      out.push_back({column + i, component + i, name, units[static_cast<size_t>(column + i)]});
    }
    column += factor.columns;
    component += factor.dim;
  }
  return out;
}

}  // namespace hamel
