// segway: a body on two wheels with a common axle, upright, the motors off where no input drives
// them.
//
//   SE(2) x T^3, xi = (omega, v1, v2, right', left', pitch'), axle centre as origin, mass centre of
//   the body b above it, b (sin pitch, 0, cos pitch).
// With M_0 = m + 2 m_w, principal moments I1, I2, I3 of the body, moments J_w, J_d of a wheel about
// the axle and about a diameter, c half the track:
//   l = 1/2 M_0 (v1^2 + v2^2) + m b (cos pitch v1 pitch' + sin pitch v2 omega)
//     + 1/2 ((I1 + m b^2) sin^2 + I3 cos^2 + 2 m_w c^2 + 2 J_d) omega^2
//     + 1/2 (I2 + m b^2) pitch'^2 + 1/2 J_w (right'^2 + left'^2) - m g b cos pitch,
//   v2 = 0,  v1 + c omega = R right',  v1 - c omega = R left'  (wheel angles against the vertical).
// A motor turns a wheel by its torque and the body back: inputs u = (right, left), force (0, 0, 0,
// u1, u2, -u1 - u2). The metric depends on the pitch. Upright rolling straight on, at any speed, is
// unstable at the rate
//   lambda^2 = m g b M / (M (I2 + m b^2) - m^2 b^2),   M = M_0 + 2 J_w / R^2,
// from M v1' + m b pitch'' = 0, m b v1' + (I2 + m b^2) pitch'' = m g b pitch.
// Source: Grasser, d'Arrigo, Colombi and Rufer, JOE: a mobile inverted pendulum (2002).
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/framework/mechanics/wheel_shape.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/so2.hpp>
#include <hamel/systems/energy.hpp>

namespace hamel {

struct Segway {
  using Group = Product<SE2, SO2, SO2, SO2>;
  using Element = Group::Element<double>;
  double mass = 60;              // kg
  double height = 0.9;           // m, b
  Vec<3> moments = {8, 7, 2};    // kg m^2, about the forward, the axle and the upward axis
  double wheel_mass = 5;         // kg
  double wheel_radius = 0.25;    // m, R
  double half_track = 0.3;       // m, c
  double wheel_inertia = 0.15;   // kg m^2, J_w
  double wheel_diameter = 0.08;  // kg m^2, J_d
  double gravity = 9.81;         // m/s^2

  static std::string name() { return "segway"; }
  static std::string summary() { return "body that stands on two wheels and falls over"; }
  static std::string formula() {
    return "SE(2)*T3, l = 1/2 M |v|^2 + m b (cos p v1 p' + sin p v2 w) + 1/2 I_p p'^2 + 1/2 I_w(p) "
           "w^2 + 1/2 J_w (right'^2 + left'^2) - m g b cos p, v2 = 0, v1 +- c w = R wheel'";
  }
  static std::string known() {
    return "upright rolling is unstable at a known rate; invariants: energy";
  }
  static std::string source() { return "Grasser, d'Arrigo, Colombi and Rufer 2002"; }
  static std::vector<std::string> shape() { return {"right", "left", "pitch"}; }

  void fields(auto& f) {
    f("mass", mass, "kg", "mass of the body", positive);
    f("height", height, "m", "axle to the mass centre of the body", positive);
    f("inertia", moments, "kg m^2", "moments of the body: forward, axle and upward axis",
      moments_of_inertia);
    f("wheel_mass", wheel_mass, "kg", "mass of a wheel", non_negative);
    f("wheel_radius", wheel_radius, "m", "radius of the wheels", positive);
    f("half_track", half_track, "m", "centre to wheel, along the axle", positive);
    f("wheel_inertia", wheel_inertia, "kg m^2", "moment of a wheel about the axle", non_negative);
    f("wheel_diameter_inertia", wheel_diameter, "kg m^2", "moment of a wheel about a diameter",
      non_negative);
    f("gravity", gravity, "m/s^2", "acceleration of gravity", non_negative);
  }
  void inputs(auto& u) const {
    u("right_torque", "N m", "of the motor on the right wheel, against the body");
    u("left_torque", "N m", "of the motor on the left wheel, against the body");
  }
  Vec<6> force(double /*t*/, const auto& /*g*/, const Vec<6>& /*xi*/, const InputValues& u) const {
    return {0, 0, 0, u[0], u[1], -u[0] - u[1]};
  }
  auto inertia(const auto& g) const {
    const auto& pitch = g.template part<3>();
    using T = std::decay_t<decltype(pitch.c)>;
    const double first = mass * height, second = first * height;
    MatT<T, 6, 6> i = MatT<T, 6, 6>::Zero();
    const double total = mass + 2 * wheel_mass;
    i.diagonal() << (moments[0] + second) * (pitch.s * pitch.s) + moments[2] * (pitch.c * pitch.c) +
                        2 * (wheel_mass * half_track * half_track + wheel_diameter),
        T(total), T(total), T(wheel_inertia), T(wheel_inertia), T(moments[1] + second);
    i(0, 2) = i(2, 0) = first * pitch.s;
    i(1, 5) = i(5, 1) = first * pitch.c;
    return i;
  }
  /// The metric and the potential depend on the pitch alone.
  Vec<6> inertia_differential(const Element& g, const Vec<6>& xi) const {
    const auto& pitch = g.part<3>();
    const double first = mass * height, turning = moments[0] + first * height - moments[2];
    const double slope = turning * pitch.s * pitch.c * xi[0] * xi[0] +
                         first * (pitch.c * xi[2] * xi[0] - pitch.s * xi[1] * xi[5]);
    return {0, 0, 0, 0, 0, slope};
  }
  Mat<3, 6> constraints() const {
    return Mat<3, 6>{{0, 0, 1, 0, 0, 0},
                     {half_track, 1, 0, -wheel_radius, 0, 0},
                     {-half_track, 1, 0, 0, -wheel_radius, 0}};
  }
  auto potential(const auto& g) const { return (mass * gravity * height) * g.template part<3>().c; }
  Vec<6> potential_differential(const Element& g) const {
    return {0, 0, 0, 0, 0, -mass * gravity * height * g.part<3>().s};
  }
  /// Rolling at (omega, v) with the body at this pitch, turning at pitch_rate.
  Start rolling(double pitch, double omega, double v, double pitch_rate = 0) const {
    return {.configuration = {0, 0, 0, 0, 0, pitch},
            .velocity = {omega, v, 0, (v + half_track * omega) / wheel_radius,
                         (v - half_track * omega) / wheel_radius, pitch_rate},
            .momentum = {}};
  }
  Start start() const { return rolling(0.02, 0.6, 1); }
  /// Upright.
  Start at_speed(double v) const { return rolling(0, 0, v); }
  /// The rate lambda of the instability of straight upright rolling.
  double growth_rate() const {
    const double total = mass + 2 * wheel_mass + 2 * wheel_inertia / (wheel_radius * wheel_radius);
    const double first = mass * height;
    return std::sqrt(first * gravity * total /
                     (total * (moments[1] + first * height) - first * first));
  }

  void invariants(auto& add) const { add("energy", energy_of(*this)); }
  void draw(auto& scene) const {
    scene.floor();
    // At side of the axle, turned about it by an angle that leans forwards.
    const auto at = [r = wheel_radius](const auto& g, double side, const auto& angle) {
      const auto& cart = g.template part<0>();
      Placement p = planar(cart, r);
      p.position += p.rotation * Vec<3>(0, side, 0);
      p.rotation = p.rotation * Mat<3, 3>{{angle.c, 0, angle.s}, {0, 1, 0}, {-angle.s, 0, angle.c}};
      return p;
    };
    scene
        .body("body", [at](const auto& g) { return at(g, 0, g.template part<3>()); },
              {shapes::box({0.1, 1.6 * half_track, 2 * height}, {.at = {0, 0, height}})})
        .trail();
    const BodyShape wheel = shapes::wheel(wheel_radius, 0.05, {.axis = {0, 1, 0}, .color = "dark"});
    scene.body("right wheel",
               [at, c = half_track](const auto& g) { return at(g, -c, g.template part<1>()); },
               {wheel});
    scene.body("left wheel",
               [at, c = half_track](const auto& g) { return at(g, c, g.template part<2>()); },
               {wheel});
  }
};

}  // namespace hamel
