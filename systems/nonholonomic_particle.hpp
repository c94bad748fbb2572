// nonholonomic_particle: the smallest nonholonomic system.
//
//   R^3, l = 1/2 m (x'^2 + y'^2 + z'^2) - 1/2 k y^2,   z' = y x'.
// x' sqrt(1 + y^2) = c is conserved for every V(y). Without the spring y = y0 + v t and
//   x = x0 + (c/v) asinh(y) |,  z = z0 + (c/v) sqrt(1 + y^2) |   (differences from y0),
// which with r = sqrt(1 + y^2), r0 = sqrt(1 + y0^2) are
//   x = x0 + (c/v) asinh(v t q),  q = (1 + r r0 - y y0)/(r + r0),   z = z0 + c t (y + y0)/(r + r0).
// Nothing cancels as v -> 0, where asinh(v t q)/v = t q.
// Source: Rosenberg 1977; Bates and Sniatycki, Rep. Math. Phys. 32 (1993).
#pragma once

#include <cmath>
#include <string>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/rn.hpp>

namespace hamel {

struct NonholonomicParticle {
  using Group = Rn<3>;
  using Element = Rn<3>::Element<double>;
  double mass = 1.0;    // kg
  double spring = 0.0;  // N/m

  static std::string name() { return "nonholonomic_particle"; }
  static std::string summary() { return "particle in space with z' = y x'"; }
  static std::string formula() { return "R3, l = 1/2 m |x'|^2 - 1/2 k y^2, z' = y x'"; }
  static std::string known() {
    return "x' sqrt(1 + y^2) is kept; without the spring everything in closed form (asinh)";
  }
  static std::string source() { return "Rosenberg 1977; Bates and Sniatycki 1993"; }

  void fields(auto& f) {
    f("mass", mass, "kg", "mass", positive);
    f("spring", spring, "N/m", "stiffness of a spring along y", non_negative);
  }
  Mat<3, 3> inertia() const { return Vec<3>::Constant(mass).asDiagonal(); }
  auto constraints(const auto& g) const {
    using T = std::decay_t<decltype(g[1])>;
    return MatT<T, 1, 3>(-g[1], T(0.0), T(1.0));
  }
  /// z' = y x'.
  auto frame(const auto& g) const {
    using T = std::decay_t<decltype(g[1])>;
    return MatT<T, 1, 2>(g[1], T(0.0));
  }
  auto potential(const auto& g) const { return (0.5 * spring) * (g[1] * g[1]); }
  Start start() const {
    return {.configuration = {0, 0.5, 0}, .velocity = {1, 0.7, 0.5}, .momentum = {}};
  }
  /// Without the spring only; empty otherwise.
  bool has_exact() const { return spring == 0; }
  auto exact(const Element& g0, const Vec<3>& xi0) const {
    const double y0 = g0[1], r0 = std::hypot(1, y0), c = xi0[0] * r0, v = xi0[1];
    return [=](double t) {
      const double y = y0 + v * t, r = std::hypot(1, y), sum = r + r0;
      // cosh of the difference of the two asinh
      const double cosh = y * y0 > 0 ? (1 + y * y + y0 * y0) / (r * r0 + y * y0) : r * r0 - y * y0;
      const double s = v * t * ((1 + cosh) / sum);  // sinh of it
      const double stretch = s == 0 ? 1 : std::asinh(s) / s;
      const Vec<3> g(g0[0] + c * t * ((1 + cosh) / sum) * stretch, y,
                     g0[2] + c * t * ((y + y0) / sum));
      return std::pair{g, Vec<3>(c / r, v, y * (c / r))};
    };
  }
  void invariants(auto& add) const {
    add("x' sqrt(1 + y^2)",
        [](const auto& g, const Vec<3>& xi) { return xi[0] * std::hypot(1, g[1]); });
    add("energy", [*this](const auto& g, const Vec<3>& xi) {
      return 0.5 * mass * xi.squaredNorm() + potential(g);
    });
  }
  void draw(auto& scene) const {
    scene.body("particle", [](const auto& g) { return Placement{g}; }, {shapes::sphere(0.08)})
        .trail();
  }
};

}  // namespace hamel
