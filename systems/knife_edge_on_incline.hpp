// knife_edge_on_incline: a blade that slides down an inclined plane without slipping sideways.
//
//   SE(2), x down the slope, xi = (omega, v1, v2) at the blade,
//   l = 1/2 J omega^2 + 1/2 m |v|^2 + m g sin(alpha) x,   v2 = 0.
// omega is constant, v1' = g sin(alpha) cos(theta).
// With a = g sin(alpha), d = omega t, theta = theta_0 + d and
//   P + iQ = int_0^t exp(i theta) = t (sin(d/2)/(d/2)) exp(i (theta_0 + d/2)):
//   v1 = v1(0) + a P,   x = x0 + v1(0) P + a P^2/2,   y = y0 + v1(0) Q + a int_0^t P Q',
//   int_0^t P Q' = (P Q + int_0^t (P Q' - Q P'))/2 = (P Q + t^2 (d - sin d)/d^2)/2.
// No division by omega occurs: the formulas hold for every omega, 0 included.
// From rest there is no mean motion downhill: x is periodic, y drifts.
// Source: Neimark and Fufaev 1972; Bloch, Nonholonomic Mechanics and Control (2003), section 1.6.
#pragma once

#include <cmath>
#include <string>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/dexp.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/systems/energy.hpp>

namespace hamel {

struct KnifeEdgeOnIncline {
  using Group = SE2;
  using Element = SE2::Element<double>;
  double mass = 1.0;      // kg
  double moment = 0.1;    // kg m^2
  double slope = 0.3;     // rad, alpha
  double gravity = 9.81;  // m/s^2

  static std::string name() { return "knife_edge_on_incline"; }
  static std::string summary() { return "blade on an inclined plane"; }
  static std::string formula() {
    return "SE(2), l = 1/2 J w^2 + 1/2 m |v|^2 + m g sin(alpha) x, v2 = 0";
  }
  static std::string known() {
    return "everything in closed form: no mean motion downhill while it turns; invariants: omega, "
           "energy";
  }
  static std::string source() { return "Neimark and Fufaev 1972; Bloch 2003, section 1.6"; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("inertia", moment, "kg m^2", "moment about the blade", positive);
    f("slope", slope, "rad", "angle of the plane");
    f("gravity", gravity, "m/s^2", "acceleration of gravity", non_negative);
  }
  Mat<3, 3> inertia() const { return Vec<3>(moment, mass, mass).asDiagonal(); }
  Mat<1, 3> constraints() const { return Mat<1, 3>{0, 0, 1}; }
  auto potential(const auto& g) const {
    return -(mass * gravity * std::sin(slope)) * g.translation[0];
  }
  Start start() const { return {.configuration = {}, .velocity = {1, 0, 0}, .momentum = {}}; }

  auto exact(const Element& g0, const Vec<3>& xi0) const {
    const double a = gravity * std::sin(slope), w = xi0[0], v0 = xi0[1], theta0 = g0.angle();
    return [=](double t) {
      const double d = w * t, chord = t * sinc(0.25 * d * d), middle = theta0 + 0.5 * d;
      const double p = chord * std::cos(middle), q = chord * std::sin(middle);
      const Vec<2> change(v0 * p + 0.5 * a * p * p,
                          v0 * q + 0.5 * a * (p * q + t * t * (d * sinc3(d * d))));
      return std::pair{Element{SO2::from_angle(theta0 + d), g0.translation + change},
                       Vec<3>(w, v0 + a * p, 0)};
    };
  }
  void invariants(auto& add) const {
    add("turning rate omega", [](const auto& /*g*/, const Vec<3>& xi) { return xi[0]; });
    add("energy", energy_of(*this));
  }
  void draw(auto& scene) const {
    scene.from_above();
    scene
        .body("blade", [](const auto& g) { return planar(g); },
              {shapes::box({0.5, 0.04, 0.2}, {.at = {0, 0, 0.1}}),
               shapes::arrow({0.5, 0, 0}, {.at = {0, 0, 0.1}, .color = "accent"})})
        .trail();
  }
};

}  // namespace hamel
