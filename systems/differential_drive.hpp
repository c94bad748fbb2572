// differential_drive: a cart on two driven wheels, the motors off where no input drives them.
//
//   SE(2) x T^2, xi = (omega, v1, v2, right', left'), axle centre as origin, mass centre a ahead of
//   it, w = omega:
//   l = 1/2 J w^2 + 1/2 m (v1^2 + (v2 + a w)^2) + 1/2 J_w (right'^2 + left'^2),
//   v2 = 0,  v1 + c w = R right',  v1 - c w = R left'.
// A motor turns its wheel: inputs u = (right, left), force (0, 0, 0, u1, u2). Without them, on d it
// is the Chaplygin sleigh with m and J + m a^2 replaced by M = m + 2 J_w/R^2 and K = J + m a^2 + 2
// J_w c^2/R^2:  M v1' = m a w^2,  K w' = -m a v1 w. Source: Campion, Bastin, d'Andrea-Novel 1996;
// Bloch 2003.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/framework/mechanics/wheel_shape.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/so2.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/energy.hpp>

namespace hamel {

struct DifferentialDrive {
  using Group = Product<SE2, SO2, SO2>;
  double mass = 5.0;            // kg
  double moment = 0.2;          // kg m^2, about the mass centre
  double offset = 0.1;          // m, a
  double wheel_radius = 0.1;    // m, R
  double half_track = 0.2;      // m, c
  double wheel_inertia = 0.01;  // kg m^2, J_w, about the axle

  static std::string name() { return "differential_drive"; }
  static std::string summary() { return "cart on two wheels that roll without slipping"; }
  static std::string formula() {
    return "SE(2)*T2, l = 1/2 J w^2 + 1/2 m (v1^2 + (v2 + a w)^2) + 1/2 J_w (right'^2 + left'^2), "
           "v2 = 0, v1 +- c w = R wheel'";
  }
  static std::string known() {
    return "(omega, v1) in closed form as for the sleigh, the rest by quadrature; invariants: "
           "energy";
  }
  static std::string source() { return "Campion, Bastin and d'Andrea-Novel 1996"; }
  static std::vector<std::string> shape() { return {"right", "left"}; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("inertia", moment, "kg m^2", "moment about the mass centre", positive);
    f("offset", offset, "m", "axle to mass centre, forwards");
    f("wheel_radius", wheel_radius, "m", "radius of the wheels", positive);
    f("half_track", half_track, "m", "centre to wheel, along the axle", positive);
    f("wheel_inertia", wheel_inertia, "kg m^2", "moment of a wheel about the axle", non_negative);
  }
  void inputs(auto& u) const {
    u("right_torque", "N m", "of the motor on the right wheel");
    u("left_torque", "N m", "of the motor on the left wheel");
  }
  Vec<5> force(double /*t*/, const auto& /*g*/, const Vec<5>& /*xi*/, const InputValues& u) const {
    Vec<5> f;
    f << 0, 0, 0, u[0], u[1];
    return f;
  }
  Mat<5, 5> inertia() const {
    Mat<5, 5> i = Mat<5, 5>::Zero();
    i.diagonal() << moment + mass * offset * offset, mass, mass, wheel_inertia, wheel_inertia;
    i(0, 2) = i(2, 0) = mass * offset;
    return i;
  }
  Mat<3, 5> constraints() const {
    return Mat<3, 5>{{0, 0, 1, 0, 0},
                     {half_track, 1, 0, -wheel_radius, 0},
                     {-half_track, 1, 0, 0, -wheel_radius}};
  }
  Start start() const {
    const Vec<5> xi = rolling(0.9, -1);
    return {.configuration = {}, .velocity = {xi.begin(), xi.end()}, .momentum = {}};
  }
  /// xi of a cart that turns at omega and moves at v.
  Vec<5> rolling(double omega, double v) const {
    Vec<5> xi;
    xi << omega, v, 0, (v + half_track * omega) / wheel_radius,
        (v - half_track * omega) / wheel_radius;
    return xi;
  }

  auto exact(const Group::Element<double>& g0, const Vec<5>& xi0) const {
    const double wheels = 2 * wheel_inertia / (wheel_radius * wheel_radius);
    const double m = mass + wheels,
                 k = moment + mass * offset * offset + wheels * half_track * half_track;
    const SleighRates rates(m, k, mass * offset, xi0[0], xi0[1]);
    return rates.motion<Group>(
        g0, xi0, [cart = *this](double omega, double v) { return cart.rolling(omega, v); });
  }
  void invariants(auto& add) const { add("kinetic energy", energy_of(*this)); }
  void draw(auto& scene) const {
    scene.floor();
    const auto cart = [](const auto& g) { return g.template part<0>(); };
    scene
        .body("cart", [cart](const auto& g) { return planar(cart(g)); },
              {shapes::box({0.3, 2 * half_track - 0.06, 0.06}, {.at = {offset, 0, wheel_radius}})})
        .trail();
    const auto wheel = [&](const char* name, double side, auto angle) {
      scene.body(name,
                 [cart, side, angle, r = wheel_radius](const auto& g) {
                   const double c = std::cos(angle(g)), s = std::sin(angle(g));
                   Placement p = planar(cart(g), r);
                   p.position += p.rotation * Vec<3>(0, side, 0);
                   p.rotation = p.rotation * Mat<3, 3>{{s, c, 0}, {0, 0, 1}, {c, -s, 0}};
                   return p;
                 },
                 {shapes::wheel(wheel_radius, 0.03, {.color = "dark"})});
    };
    wheel("right wheel", -half_track, [](const auto& g) { return g.template part<1>().angle(); });
    wheel("left wheel", half_track, [](const auto& g) { return g.template part<2>().angle(); });
  }
};

}  // namespace hamel
