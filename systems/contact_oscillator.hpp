// contact_oscillator: a continuously variable transmission, the stress test of nonholonomic
// integrators.
//
//   R^3, l = 1/2 (x'^2 + y'^2 + z'^2) - 1/2 (x^2 + z^2) - 1/2 k y^2,
//   x' + f(y) z' = 0,  f = ratio + y.
// The driving oscillator y is free: its energy is conserved, and so is the total energy. Every
// integrator that is not both reversible and integrable on this system may drift (Modin and
// Verdier). Source: McLachlan and Perlmutter 2006; Modin and Verdier, What makes nonholonomic
// integrators work? (2020).
#pragma once

#include <string>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/rn.hpp>

namespace hamel {

struct ContactOscillator {
  using Group = Rn<3>;
  using Element = Rn<3>::Element<double>;
  double ratio = 0.0;   // 1
  double spring = 1.0;  // N/m, of the driving oscillator

  static std::string name() { return "contact_oscillator"; }
  static std::string summary() { return "continuously variable transmission between two springs"; }
  static std::string formula() {
    return "R3, l = 1/2 |x'|^2 - 1/2 (x^2 + z^2) - 1/2 k y^2, x' + (ratio + y) z' = 0";
  }
  static std::string known() { return "invariants: energy, energy of the driver y"; }
  static std::string source() { return "McLachlan and Perlmutter 2006; Modin and Verdier 2020"; }

  void fields(auto& f) {
    f("ratio", ratio, "1", "mean transmission ratio");
    f("spring", spring, "N/m", "stiffness of the driving oscillator", non_negative);
  }
  Mat<3, 3> inertia() const { return Mat<3, 3>::Identity(); }
  auto constraints(const auto& g) const {
    using T = std::decay_t<decltype(g[1])>;
    return MatT<T, 1, 3>(T(1.0), T(0.0), ratio + g[1]);
  }
  auto potential(const auto& g) const {
    return 0.5 * (g[0] * g[0] + g[2] * g[2]) + (0.5 * spring) * (g[1] * g[1]);
  }
  Start start() const {
    return {.configuration = {1, 0.5, 0.3}, .velocity = {-0.2, 0.6, 0.4}, .momentum = {}};
  }
  void invariants(auto& add) const {
    add("energy", [*this](const auto& g, const Vec<3>& xi) {
      return 0.5 * xi.squaredNorm() + this->potential(g);
    });
    add("energy of the driver", [k = spring](const auto& g, const Vec<3>& xi) {
      return 0.5 * (xi[1] * xi[1] + k * g[1] * g[1]);
    });
  }
  void draw(auto& scene) const {
    scene.body("state", [](const auto& g) { return Placement{g}; }, {shapes::sphere(0.06)}).trail();
  }
};

}  // namespace hamel
