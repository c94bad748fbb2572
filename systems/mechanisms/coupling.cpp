#include <hamel/systems/mechanisms/coupling.hpp>

#include <cmath>

namespace hamel::mechanisms {

std::span<const double> Coupling::variables(const Tree& tree, const double* g) const {
  work.assign(links.size() + velocities.size(), 0.0);
  for (size_t i = 0; i < links.size(); ++i)
    work[i] = tree.joint(links[i]).coordinate(g + tree.element(links[i]));
  return work;
}

double Coupling::beyond(const Tree& tree, const double* g) const {
  return of_rates() ? 0 : formula(variables(tree, g));
}

void Coupling::row(const Tree& tree, const double* g, Row& out) const {
  const std::span<const double> values = variables(tree, g);
  std::vector<double> slopes(values.size(), 0.0);
  const double phi = formula.differentiate(values, 1, slopes);
  out.phi = of_rates() ? 0 : phi;
  if (affine) out.drift = -phi;  // at xi = 0
  for (const size_t i : formula.used()) {
    if (i >= links.size()) out.coefficients.emplace_back(velocities[i - links.size()], slopes[i]);
    else if (!of_rates()) out.coefficients.emplace_back(tree.first(links[i]), slopes[i]);
  }
}

std::string not_linear(const Coupling& coupling) {
  const size_t coordinates = coupling.links.size();
  for (int seed = 1; seed <= 3; ++seed) {
    std::vector<double> at(coordinates + coupling.velocities.size());
    for (size_t i = 0; i < at.size(); ++i)
      at[i] = std::sin(12.9898 * (static_cast<double>(i) + 1) + 78.233 * seed);
    const auto along = [&](double factor) {
      std::vector<double> values = at;
      for (size_t i = coordinates; i < at.size(); ++i) values[i] *= factor;
      return coupling.formula(values);
    };
    const double none = along(0), one = along(1) - none, three = along(3) - none;
    if (!std::isfinite(none + one + three)) continue;
    if (none != 0 && !coupling.affine) return "has a term without a rate";
    std::vector<double> slopes(at.size(), 0.0);
    coupling.formula.differentiate(at, 1, slopes);
    double linear = 0, size = std::abs(one) + std::abs(none);
    for (size_t i = coordinates; i < at.size(); ++i) {
      linear += slopes[i] * at[i];
      size += std::abs(slopes[i] * at[i]);
    }
    if (std::abs(one - linear) > 1e-12 * size || std::abs(three - 3 * one) > 1e-12 * size)
      return "is not linear in the rates";
  }
  return "";
}

}  // namespace hamel::mechanisms
