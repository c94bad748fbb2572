#include <hamel/framework/mechanics/natural_units.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace hamel {

std::vector<double> own_scales(const std::vector<Component>& components, const Mechanics& mechanics,
                               const double* g) {
  const Eigen::Index n = mechanics.dim();
  Eigen::MatrixXd inertia(n, n);
  mechanics.inertia(g, inertia);
  double mass = 0, moment = 0;  // sums over the lengths, the angles
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::string& unit = components[static_cast<size_t>(i)].unit;
    if (unit == "m/s") mass += inertia(i, i);
    if (unit == "rad/s") moment += inertia(i, i);
  }
  std::vector<double> out(static_cast<size_t>(n), 0);
  for (size_t i = 0; i < out.size(); ++i) {
    if (components[i].unit == "rad/s") out[i] = 1;
    if (components[i].unit == "m/s" && mass > 0 && moment > 0) out[i] = std::sqrt(moment / mass);
  }
  return out;
}

std::vector<double> natural_units(const std::vector<Component>& components,
                                  const Mechanics& mechanics, const double* g) {
  std::vector<double> out = own_scales(components, mechanics, g);
  if (std::find(out.begin(), out.end(), 0.0) != out.end()) out.assign(out.size(), 1);
  return out;
}

}  // namespace hamel
