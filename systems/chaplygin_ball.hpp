// chaplygin_ball: a ball with its mass centre at its centre and unequal moments, rolling on a
// plane.
//
//   SO(3) x R^2, xi = (omega in the body, x', y'), l = 1/2 omega^T I omega + 1/2 m (x'^2 + y'^2),
//   with w = R omega:  x' = rho w_y,  y' = -rho w_x.
// With D = m rho^2 and gamma = R^T e_z the momentum about the contact, M = (I + D) omega - D
// (omega.gamma) gamma, is fixed in space. Source: Chaplygin 1903; Borisov, Mamaev and Kilin;
// Duistermaat, Chaplygin's sphere (2004).
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/systems/ball_on_plane.hpp>
#include <hamel/systems/energy.hpp>

namespace hamel {

struct ChaplyginBall {
  using Group = ball_on_plane::Group;
  using Element = Group::Element<double>;
  double mass = 1.0;                    // kg
  double radius = 0.5;                  // m
  Vec<3> moments = {0.06, 0.10, 0.14};  // kg m^2

  static std::string name() { return "chaplygin_ball"; }
  static std::string summary() { return "ball with unequal moments that rolls on a plane"; }
  static std::string formula() {
    return "SO(3)*R2, l = 1/2 w' I w + 1/2 m |x'|^2, x' = rho w_y, y' = -rho w_x (in space)";
  }
  static std::string known() {
    return "invariants: energy, the momentum about the contact, fixed in space";
  }
  static std::string source() { return "Chaplygin 1903; Duistermaat 2004"; }
  static std::vector<std::string> shape() { return {"x", "y"}; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("radius", radius, "m", "radius of the ball", positive);
    f("inertia", moments, "kg m^2", "principal moments about the centre", moments_of_inertia);
  }
  Mat<5, 5> inertia() const { return ball_on_plane::inertia(moments, mass); }
  auto constraints(const auto& g) const { return ball_on_plane::contact_velocity(g, radius); }
  auto frame(const auto& g) const { return ball_on_plane::frame(g, radius); }
  auto frame_rate(const Element& g, const Vec<5>& xi) const {
    return ball_on_plane::frame_rate(g, xi, radius);
  }
  Start start() const {
    return {.configuration = {}, .velocity = {1.2, 2.0, 0.7, 1.0, -0.6}, .momentum = {}};
  }
  void invariants(auto& add) const {
    add("energy", energy_of(*this));
    for (int axis = 0; axis < 3; ++axis) {
      add("M_" + std::string(1, "xyz"[axis]), [*this, axis](const auto& g, const Vec<5>& xi) {
        const auto& r = g.template part<0>();
        const Vec<3> w = xi.template head<3>(), gamma = r.row(2).transpose();
        const double d = mass * radius * radius;
        const Vec<3> m = moments.cwiseProduct(w) + d * w - d * w.dot(gamma) * gamma;
        return Vec<3>(r * m)[axis];
      });
    }
  }
  void draw(auto& scene) const { ball_on_plane::draw(scene, radius); }
};

}  // namespace hamel
