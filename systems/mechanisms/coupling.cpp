#include <hamel/systems/mechanisms/coupling.hpp>

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
  switch (coupling.formula.dependence(coordinates, coordinates + coupling.velocities.size())) {
    case Expression::Dependence::linear: return "";
    case Expression::Dependence::affine: return coupling.affine ? "" : "has a term without a rate";
    default: return "is not linear in the rates";
  }
}

}  // namespace hamel::mechanisms
