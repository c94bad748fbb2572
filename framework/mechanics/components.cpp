#include <hamel/framework/mechanics/components.hpp>

#include <algorithm>

namespace hamel {
namespace {

SimpleFactor factor_of(const std::string& name) {
  if (name == "so2") return {name, 1, 1, true};
  if (name == "so3") return {name, 3, 9};
  if (name == "se2") return {name, 3, 3};
  if (name == "se3") return {name, 6, 12};
  if (name == "heisenberg") return {name, 3, 3};
  if (name.size() > 1 && name[0] == 'r' &&
      name.find_first_not_of("0123456789", 1) == std::string::npos) {
    const int n = std::stoi(name.substr(1));
    return {name, n, n, true};
  }
  return {name};
}

}  // namespace

std::vector<SimpleFactor> simple_factors(const GroupInfo& group) {
  std::vector<SimpleFactor> out;
  int dim = 0;
  for (size_t at = 0; at <= group.name.size();) {
    const size_t end = std::min(group.name.find('*', at), group.name.size());
    const std::string part = group.name.substr(at, end - at);
    const size_t power = part.find('^');
    const int count = power == std::string::npos ? 1 : std::stoi(part.substr(power + 1));
    const SimpleFactor factor = factor_of(part.substr(0, power));
    if (factor.dim == 0) return {};
    for (int i = 0; i < count; ++i) out.push_back(factor);
    dim += count * factor.dim;
    at = end + 1;
  }
  return dim == group.dim ? out : std::vector<SimpleFactor>{};
}

namespace {

std::vector<Component> components_of(const SimpleFactor& factor) {
  const std::vector<Component> turns = {
      {"omega1", "rad/s"}, {"omega2", "rad/s"}, {"omega3", "rad/s"}};
  if (factor.name == "so2") return {{"angle'", "rad/s"}};
  if (factor.name == "so3") return turns;
  if (factor.name == "se2") return {{"omega", "rad/s"}, {"v1", "m/s"}, {"v2", "m/s"}};
  if (factor.name == "se3") {
    std::vector<Component> out = turns;
    for (const char* v : {"v1", "v2", "v3"}) out.push_back({v, "m/s"});
    return out;
  }
  std::vector<Component> out;
  for (int i = 0; i < factor.dim; ++i) {
    const std::string axis =
        factor.dim <= 3 ? std::string(1, static_cast<char>('x' + i)) : "x" + std::to_string(i + 1);
    out.push_back({axis + "'", "m/s"});
  }
  return out;
}

// The unit of what this is the rate of.
std::string integrated(std::string unit) {
  if (unit.ends_with("/s")) unit.resize(unit.size() - 2);
  return unit;
}

}  // namespace

std::vector<Component> components_of(const GroupInfo& group) {
  const std::vector<SimpleFactor> factors = simple_factors(group);
  std::vector<Component> out;
  for (size_t f = 0; f < factors.size(); ++f) {
    const bool several =
        std::count_if(factors.begin(), factors.end(),
                      [&](const SimpleFactor& other) { return other.name == factors[f].name; }) > 1;
    for (Component c : components_of(factors[f])) {
      const bool rate = c.name.back() == '\'';
      if (several) {
        const std::string stem = rate ? c.name.substr(0, c.name.size() - 1) : c.name;
        c.name = stem + "_" + std::to_string(f + 1) + (rate ? "'" : "");
      }
      out.push_back(c);
    }
  }
  for (int i = static_cast<int>(out.size()); i < group.dim; ++i)
    out.push_back({"xi" + std::to_string(i + 1), ""});
  return out;
}

std::vector<std::string> units_of_element(const GroupInfo& group) {
  std::vector<std::string> out;
  for (const SimpleFactor& factor : simple_factors(group)) {
    const std::vector<Component> rates = components_of(factor);
    const int matrix = factor.columns > factor.dim ? 9 : 0;  // entries, in place of three angles
    for (int i = 0; i < factor.columns; ++i)
      out.push_back(
          i < matrix
              ? ""
              : integrated(rates[static_cast<size_t>(i - matrix + (matrix > 0 ? 3 : 0))].unit));
  }
  return out;
}

std::vector<ShapeCoordinate> shape_of(const GroupInfo& group,
                                      const std::vector<Component>& components) {
  std::vector<ShapeCoordinate> out;
  int column = 0, component = 0;
  for (const SimpleFactor& factor : simple_factors(group)) {
    for (int i = 0; factor.shape && i < factor.dim; ++i) {
      Component c = components.at(static_cast<size_t>(component + i));
      if (c.name.back() == '\'') c.name.pop_back();
      out.push_back({column + i, component + i, c.name, integrated(c.unit)});
    }
    column += factor.columns;
    component += factor.dim;
  }
  return out;
}

}  // namespace hamel
