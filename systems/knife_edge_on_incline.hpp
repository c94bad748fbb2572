// knife_edge_on_incline: a blade that slides down an inclined plane without slipping sideways.
//
//   SE(2), x down the slope, xi = (omega, v1, v2) at the blade, l = 1/2 J w^2 + 1/2 m |v|^2 + m g sin(alpha) x,
//   v2 = 0.   omega is constant, v1' = g sin(alpha) cos(theta).
// Turning (omega != 0), with a = g sin(alpha), theta = theta_0 + omega t, c = v1(0) - a sin(theta_0)/omega:
//   v1 = c + a sin(theta)/omega,
//   x = x0 + [c sin(theta) + a sin^2(theta)/(2 omega)]/omega |,
//   y = y0 + [-c cos(theta) + a (theta/2 - sin(2 theta)/4)/omega]/omega |   (differences from theta_0).
// From rest it does not slide down on the mean: x is periodic, y drifts.
// Source: Neimark and Fufaev 1972; Bloch, Nonholonomic Mechanics and Control (2003), section 1.6.
#pragma once

#include <cmath>
#include <string>

#include <hamel/framework/general_system.hpp>
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
    f("mass", mass, "kg", "total mass");
    f("inertia", moment, "kg m^2", "moment about the blade");
    f("slope", slope, "rad", "angle of the plane");
    f("gravity", gravity, "m/s^2", "acceleration of gravity");
  }
  Mat<3, 3> inertia() const { return Vec<3>(moment, mass, mass).asDiagonal(); }
  Mat<1, 3> constraints() const { return Mat<1, 3>{0, 0, 1}; }
  auto potential(const auto& g) const {
    return -(mass * gravity * std::sin(slope)) * g.translation[0];
  }
  Start start() const { return {.configuration = {}, .velocity = {1, 0, 0}, .momentum = {}}; }

  auto exact(const Element& g0, const Vec<3>& xi0) const {
    const double a = gravity * std::sin(slope), w = xi0[0], theta0 = g0.angle();
    return [=](double t) {
      const double theta = theta0 + w * t;
      double v = xi0[1] + a * std::cos(theta0) * t,
             along = xi0[1] * t + 0.5 * a * std::cos(theta0) * t * t;
      Vec<2> change = along * Vec<2>(std::cos(theta0), std::sin(theta0));
      if (w != 0) {
        const double c = xi0[1] - a * std::sin(theta0) / w;
        const auto integral = [&](double angle) {
          const double s = std::sin(angle);
          return Vec<2>((c * s + a * s * s / (2 * w)) / w,
                        (-c * std::cos(angle) + a * (angle / 2 - std::sin(2 * angle) / 4) / w) / w);
        };
        v = c + a * std::sin(theta) / w;
        change = integral(theta) - integral(theta0);
      }
      Element g{SO2::from_angle(theta), g0.translation + change};
      return std::pair{g, Vec<3>(w, v, 0)};
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
