// rolling_ball: a homogeneous ball that rolls without slipping on a plane.
//
//   SO(3) x R^2, xi = (omega in the body, x', y'), l = 1/2 I |omega|^2 + 1/2 m (x'^2 + y'^2),
//   with w = R omega:  x' = rho w_y,  y' = -rho w_x.
// omega is constant in the body and in space although the structure constants of d do not vanish,
// and the centre moves on a straight line. A wrong sign in a scheme is therefore visible at once.
// With friction it is the ball of released_ball.hpp, on SO(3) x R^3.
// Source: Neimark and Fufaev 1972; Bloch, Krishnaprasad, Marsden and Murray 1996.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/systems/ball_on_plane.hpp>
#include <hamel/systems/reconstruction.hpp>
#include <hamel/systems/released_ball.hpp>

namespace hamel {

struct RollingBall {
  using Group = ball_on_plane::Group;
  using Element = Group::Element<double>;
  double mass = 1.0;    // kg
  double radius = 0.5;  // m
  double moment = 0.1;  // kg m^2
  ContactParameters ground = {};
  double gravity = 9.81;  // m/s^2, where the contact is not ideal

  static std::string name() { return "rolling_ball"; }
  static std::string summary() { return "homogeneous ball that rolls on a plane"; }
  static std::string formula() {
    return "SO(3)*R2, l = 1/2 I |w|^2 + 1/2 m |x'|^2, x' = rho w_y, y' = -rho w_x (in space)";
  }
  static std::string known() { return "everything: omega is constant, the centre runs straight"; }
  static std::string source() { return "Neimark and Fufaev 1972"; }
  static std::vector<std::string> shape() { return {"x", "y"}; }

  void fields(auto& f) {
    f("mass", mass, "kg", "total mass", positive);
    f("radius", radius, "m", "radius of the ball", positive);
    f("inertia", moment, "kg m^2", "moment about the centre", positive);
    ground.fields(f);
    f("gravity", gravity, "m/s^2", "acceleration of gravity, with friction", non_negative);
  }
  /// With friction, on SO(3) x R^3.
  std::optional<ReleasedBall> released() const {
    if (ground.ideal()) return {};
    return ReleasedBall{mass, radius, moment, gravity, ground};
  }
  Mat<5, 5> inertia() const { return ball_on_plane::inertia(Vec<3>::Constant(moment), mass); }
  auto constraints(const auto& g) const { return ball_on_plane::contact_velocity(g, radius); }
  auto frame(const auto& g) const { return ball_on_plane::frame(g, radius); }
  auto frame_rate(const Element& g, const Vec<5>& xi) const {
    return ball_on_plane::frame_rate(g, xi, radius);
  }
  Start start() const {
    return {.configuration = {}, .velocity = {0.4, 1.5, 0.8, 0.75, -0.2}, .momentum = {}};
  }
  auto exact(const Element& g0, const Vec<5>& xi0) const {
    return one_parameter_motion<Group>(g0, xi0);
  }
  void invariants(auto& add) const {
    for (int i = 0; i < 3; ++i) {
      add("omega_" + std::to_string(i + 1),
          [i](const auto& /*g*/, const Vec<5>& xi) { return xi[i]; });
    }
  }
  void draw(auto& scene) const { ball_on_plane::draw(scene, radius); }
};

}  // namespace hamel
