// chaplygin_sleigh: a body on a plane on two points and a blade that does not slip sideways.
//
//   SE(2), xi = (omega, v1, v2) at the blade, v2 = 0; mass centre at distance a along the blade:
//   l = 1/2 J omega^2 + 1/2 m (v1^2 + (v2 + a omega)^2),  J about the mass centre.
//   v1' = a omega^2,   (J + m a^2) omega' = -m a v1 omega.
// With U = sqrt(2E/m), W = sqrt(2E/(J + m a^2)), kappa = m a U/(J + m a^2), sinh(kappa t0) =
// -v1(0) U^-1 / (|omega(0)| W^-1):
//   v1 = U tanh(kappa t + c),  omega = sign(omega(0)) W sech(kappa t + c),  c = -kappa t0;
// the sleigh ends on a straight line at speed U, blade behind the mass centre.
// With friction the blade slips sideways under the weight m g that it bears, constant: the plane is
// level and the points slide freely. It never slips where mu >= J E/((J + m a^2)^(3/2) m^(1/2) g)
// and its path passes equal shares of the energy E, where the force across it, m J v1 omega/(J + m
// a^2), is largest.
// Source: Chaplygin 1911; Bloch, Nonholonomic Mechanics and Control (2003), section 1.7.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <type_traits>

#include <hamel/framework/mechanics/system.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/systems/energy.hpp>
#include <hamel/systems/reconstruction.hpp>

namespace hamel {

/// (omega, v) of m v' = b omega^2, k omega' = -b v omega in closed form, and the motion it leads
/// along.
struct SleighRates {
  double u, w, kappa, c;  // w carries the sign of omega(0)
  bool constant;

  SleighRates(double m, double k, double b, double omega, double v) {
    const double twice_energy = k * omega * omega + m * v * v;
    u = std::sqrt(twice_energy / m);
    const double size = std::sqrt(twice_energy / k);
    w = std::copysign(size, omega);
    kappa = b * u / k;
    constant = b == 0 || omega == 0;
    c = constant ? 0 : std::asinh(v / u / (std::abs(omega) / size));
  }
  /// The motion of a system on G whose body velocity is body(omega, v).
  template <class G, class Body>
  auto motion(const typename G::template Element<double>& g0, const Vec<G::dim>& xi0,
              Body body) const {
    const auto velocity = [rates = *this, body](double t) {
      const double x = rates.kappa * t + rates.c;
      return body(rates.w / std::cosh(x), rates.u * std::tanh(x));
    };
    Reconstruction<G, decltype(velocity)> path(
        g0, velocity, 0.02 / std::max(std::abs(w) + std::abs(kappa), 1e-9));
    auto steady = one_parameter_motion<G>(g0, xi0);
    return
        [path, steady, still = constant](double t) mutable { return still ? steady(t) : path(t); };
  }
};

struct ChaplyginSleigh {
  using Group = SE2;
  double mass = 1.0;                    // kg
  double moment = 0.1;                  // kg m^2, J
  double offset = 0.2;                  // m, a
  std::optional<double> friction = {};  // mu, of the blade
  double gravity = 9.81;                // m/s^2

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
    f("mass", mass, "kg", "total mass", positive);
    f("inertia", moment, "kg m^2", "moment about the mass centre", positive);
    f("offset", offset, "m", "blade to mass centre, along the blade");
    f("friction", friction, "1", "coefficient of friction across the blade; not set: never slips",
      non_negative);
    f("gravity", gravity, "m/s^2", "acceleration of gravity, of the weight on the blade",
      non_negative);
  }
  Mat<3, 3> inertia() const {
    const double m = mass, a = offset;
    return Mat<3, 3>{{moment + m * a * a, 0, m * a}, {0, m, 0}, {m * a, 0, m}};
  }
  Mat<1, 3> constraints() const { return Mat<1, 3>{0, 0, 1}; }
  Start start() const { return {.configuration = {}, .velocity = {0.9, -1, 0}, .momentum = {}}; }

  void contacts(auto& add) const {
    if (!friction) return;
    add({.name = "blade", .tangential = {0}, .load = mass * gravity, .friction = *friction});
  }
  bool has_exact() const { return !friction; }
  template <class V = Vec<3>>
  auto exact(const SE2::Element<double>& g0, const std::type_identity_t<V>& xi0) const {
    const SleighRates rates(mass, moment + mass * offset * offset, mass * offset, xi0[0], xi0[1]);
    return rates.motion<SE2>(g0, xi0, [](double omega, double v) { return Vec<3>(omega, v, 0); });
  }

  void invariants(auto& add) const {
    if (!friction) add("kinetic energy", energy_of(*this));
  }
  void events(auto& add) const {
    add("cusp", "the blade stops, and its path has a cusp", 0,
        [](double, const auto&, const auto& xi) { return xi[1]; });
  }
  void draw(auto& scene) const {
    scene.from_above();
    scene
        .body("sleigh", [](const auto& g) { return planar(g); },
              {shapes::box({0.6, 0.4, 0.1}, {.at = {offset, 0, 0.15}}),
               shapes::box({0.3, 0.02, 0.1}, {.at = {0, 0, 0.05}, .color = "accent"}),
               shapes::sphere(0.05, {.at = {offset, 0, 0.22}, .color = "dark"})})
        .trail();
  }
};

}  // namespace hamel
