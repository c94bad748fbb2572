// chaplygin_sleigh: a body on a plane on two points and a blade that does not slip sideways.
//
//   SE(2), xi = (omega, v1, v2) at the blade, v2 = 0; mass centre at distance a along the blade:
//   l = 1/2 J omega^2 + 1/2 m (v1^2 + (v2 + a omega)^2),  J about the mass centre.
//   v1' = a omega^2,   (J + m a^2) omega' = -m a v1 omega.
// With U = sqrt(2E/m), W = sqrt(2E/(J + m a^2)), kappa = m a U/(J + m a^2), sinh(kappa t0) =
// -v1(0) U^-1 / (|omega(0)| W^-1):
//   v1 = U tanh(kappa t + c),  omega = sign(omega(0)) W sech(kappa t + c),  c = -kappa t0;
// the sleigh ends on a straight line at speed U, blade behind the mass centre.
// Source: Chaplygin 1911; Bloch, Nonholonomic Mechanics and Control (2003), section 1.7.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <hamel/framework/system.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/systems/reconstruction.hpp>

namespace hamel {

struct ChaplyginSleigh {
  using Group = SE2;
  double mass = 1.0;    // kg
  double moment = 0.1;  // kg m^2, J
  double offset = 0.2;  // m, a

  static std::string name() { return "chaplygin_sleigh"; }
  static std::string summary() { return "body on a plane with one blade"; }
  static std::string formula() {
    return "SE(2), l = 1/2 J w^2 + 1/2 m (v1^2 + (v2 + a w)^2), v2 = 0 at the blade";
  }
  static std::string known() {
    return "(omega, v1) in closed form (sech, tanh), the path by quadrature at round-off; "
           "invariants: energy; total turning pi sqrt(1 + J/(m a^2))";
  }
  static std::string source() { return "Chaplygin 1911; Bloch 2003, section 1.7"; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass");
    f("inertia", moment, "kg m^2", "moment about the mass centre");
    f("offset", offset, "m", "blade to mass centre, along the blade");
  }
  Mat<3, 3> inertia() const {
    const double m = mass, a = offset;
    return Mat<3, 3>{{moment + m * a * a, 0, m * a}, {0, m, 0}, {m * a, 0, m}};
  }
  Mat<1, 3> constraints() const { return Mat<1, 3>{0, 0, 1}; }
  Start start() const { return {.configuration = {}, .velocity = {0.9, -1, 0}, .momentum = {}}; }

  /// xi(t) = (omega, v1, 0).
  struct Velocity {
    double u, w, kappa, c;  // w carries the sign of omega(0)
    Vec<3> operator()(double t) const {
      const double x = kappa * t + c;
      return {w / std::cosh(x), u * std::tanh(x), 0};
    }
  };

  auto exact(const SE2::Element<double>& g0, const Vec<3>& xi0) const {
    const double about_blade = moment + mass * offset * offset, omega = xi0[0], v = xi0[1];
    const double twice_energy = about_blade * omega * omega + mass * v * v;
    const double u = std::sqrt(twice_energy / mass), w = std::sqrt(twice_energy / about_blade);
    const bool constant = offset == 0 || omega == 0;
    const Velocity velocity{u, std::copysign(w, omega), mass * offset * u / about_blade,
                            constant ? 0 : std::asinh(v / u / (std::abs(omega) / w))};
    const double rate = w + std::abs(velocity.kappa);
    Reconstruction<SE2, Velocity> path(g0, velocity, 0.02 / std::max(rate, 1e-9));
    auto steady = one_parameter_motion<SE2>(g0, xi0);
    return [path, steady, constant](double t) mutable { return constant ? steady(t) : path(t); };
  }

  void invariants(auto& add) const {
    add("kinetic energy",
        [i = inertia()](const auto& /*g*/, const Vec<3>& xi) { return 0.5 * xi.dot(i * xi); });
  }
  void draw(auto& scene) const {
    scene.from_above();
    scene
        .body("sleigh",
              [](const auto& g) { return planar(g.translation[0], g.translation[1], g.angle()); },
              {shapes::box({0.6, 0.4, 0.1}, {.at = {offset, 0, 0.15}}),
               shapes::box({0.3, 0.02, 0.1}, {.at = {0, 0, 0.05}, .color = "accent"}),
               shapes::sphere(0.05, {.at = {offset, 0, 0.22}, .color = "dark"})})
        .trail();
  }
};

}  // namespace hamel
