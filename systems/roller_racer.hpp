// roller_racer: two bodies with a hinge between them, each on one axle; the rider swings the
// handlebar.
//
//   SE(2) x S^1, xi = (omega, v1, v2, phi'), origin at the rear axle, the hinge at a e1, phi the
//   angle of the front body, whose axle trails the hinge by b; its mass is left out, its moment is
//   I_f:
//   l = 1/2 m (v1^2 + v2^2) + 1/2 I omega^2 + 1/2 I_f (omega + phi')^2 - 1/2 k phi^2,
//   v2 = 0,   -sin phi v1 + cos phi (v2 + a omega) - b (omega + phi') = 0,
// with the torque T cos(Omega t) on phi, and that of the input. Neither wheel is driven, and no
// symmetry points forwards: the momentum is not conserved, and swinging the handlebar propels the
// racer. Without torque the energy is conserved. Source: Krishnaprasad and Tsakiris, Oscillations,
// SE(2)-snakes and motion control: a study of the roller racer, Dynamical Systems 16 (2001).
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/so2.hpp>
#include <hamel/systems/energy.hpp>

namespace hamel {

struct RollerRacer {
  using Group = Product<SE2, SO2>;
  using Element = Group::Element<double>;
  double mass = 1.0;           // kg
  double moment = 0.05;        // kg m^2, I
  double front_moment = 0.01;  // kg m^2, I_f
  double rear_length = 0.3;    // m, a
  double front_length = 0.1;   // m, b
  double stiffness = 0.5;      // N m, k
  double torque = 0.2;         // N m, T
  double frequency = 3.0;      // rad/s, Omega

  static std::string name() { return "roller_racer"; }
  static std::string summary() { return "two hinged bodies on wheels, run by steering alone"; }
  static std::string formula() {
    return "SE(2)*S1, l = 1/2 m |v|^2 + 1/2 I w^2 + 1/2 I_f (w + phi')^2 - 1/2 k phi^2, v2 = 0, "
           "-sin phi v1 + cos phi (v2 + a w) - b (w + phi') = 0, torque T cos(Omega t) on phi";
  }
  static std::string known() {
    return "undulation propels; invariants: energy when the torque is 0";
  }
  static std::string source() { return "Krishnaprasad and Tsakiris 2001"; }
  static std::vector<std::string> shape() { return {"steer"}; }

  void fields(auto& f) {
    f("mass", mass, "kg", "mass, at the rear axle", positive);
    f("inertia", moment, "kg m^2", "moment of the rear body", non_negative);
    f("front_inertia", front_moment, "kg m^2", "moment of the front body", non_negative);
    f("rear_length", rear_length, "m", "rear axle to hinge", positive);
    f("front_length", front_length, "m", "front axle to hinge, which it trails", positive);
    f("stiffness", stiffness, "N m", "spring that centres the handlebar", non_negative);
    f("torque", torque, "N m", "amplitude of the torque on the handlebar");
    f("frequency", frequency, "rad/s", "of the torque");
  }
  void inputs(auto& u) const {
    u("handlebar_torque", "N m", "on the handlebar, beside T cos(Omega t)");
  }
  Vec<4> force(double /*t*/, const Element& /*g*/, const Vec<4>& /*xi*/,
               const InputValues& u) const {
    return {0, 0, 0, u[0]};
  }
  Mat<4, 4> inertia() const {
    Mat<4, 4> i = Vec<4>(moment + front_moment, mass, mass, front_moment).asDiagonal();
    i(0, 3) = i(3, 0) = front_moment;
    return i;
  }
  auto constraints(const auto& g) const {
    const auto& phi = g.template part<1>();
    using T = std::decay_t<decltype(phi.c)>;
    MatT<T, 2, 4> a;
    a << T(0.0), T(0.0), T(1.0), T(0.0),  //
        rear_length * phi.c - front_length, -phi.s, phi.c, T(-front_length);
    return a;
  }
  auto potential(const auto& g) const {
    const auto phi = g.template part<1>().angle();
    return (0.5 * stiffness) * (phi * phi);
  }
  Vec<4> force(double t, const Element& /*g*/, const Vec<4>& /*xi*/) const {
    return {0, 0, 0, torque * std::cos(frequency * t)};
  }
  /// Straight, turning at omega while it runs at v.
  Start turning(double omega, double v) const {
    return {.configuration = {},
            .velocity = {omega, v, 0, (rear_length - front_length) / front_length * omega},
            .momentum = {}};
  }
  Start start() const { return turning(0.5, 0.2); }
  void invariants(auto& add) const {
    if (torque == 0) add("energy", energy_of(*this));
  }
  void draw(auto& scene) const {
    scene.from_above();
    const auto rear = [](const auto& g) {
      const auto& at = g.template part<0>();
      return planar(at);
    };
    const auto front = [rear, a = rear_length](const auto& g) {
      const Placement p = rear(g);
      const auto& phi = g.template part<1>();
      return Placement{p.position + a * p.rotation.col(0),
                       p.rotation * Mat<3, 3>{{phi.c, -phi.s, 0}, {phi.s, phi.c, 0}, {0, 0, 1}}};
    };
    const double a = rear_length, b = front_length;
    scene
        .body("rear", rear,
              {shapes::box({a, 0.06, 0.05}, {.at = {a / 2, 0, 0.05}}),
               shapes::box({0.02, 0.2, 0.03}, {.at = {0, 0, 0.03}, .color = "dark"})})
        .trail();
    scene.body("handlebar", front,
               {shapes::box({b, 0.05, 0.05}, {.at = {-b / 2, 0, 0.08}, .color = "accent"}),
                shapes::box({0.02, 0.16, 0.03}, {.at = {-b, 0, 0.03}, .color = "dark"})});
  }
};

}  // namespace hamel
