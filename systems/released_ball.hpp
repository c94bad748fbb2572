// A homogeneous ball above a plane: rolling_ball where its contact may slide and open.
//
//   SO(3) x R^3, xi = (omega in the body, x', y', z'), l = 1/2 I |omega|^2 + 1/2 m |x'|^2 - m g z;
//   the contact at the lowest point moves at (x' - rho w_y, y' + rho w_x), w = R omega, its gap is
//   phi = z - rho.
// Sliding on the plane the slip keeps its direction, shrinks at (1 + 1/k) mu g, k = I/(m rho^2),
// and ends after k/(1 + k) |s0|/(mu g) with the velocity v0 - k/(1 + k) s0 of the centre, whatever
// mu is. Source: Coriolis, Theorie mathematique des effets du jeu de billard (1835).
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/mechanics/drawing.hpp>
#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/rn.hpp>
#include <hamel/groups/so3.hpp>
#include <hamel/systems/friction.hpp>

namespace hamel {

struct ReleasedBall {
  using Group = Product<SO3, Rn<3>>;
  using Element = Group::Element<double>;
  double mass, radius, moment, gravity;
  ContactParameters ground;

  static std::string name() { return "rolling_ball"; }
  static std::vector<std::string> shape() { return {"x", "y", "z"}; }
  Mat<6, 6> inertia() const {
    Vec<6> d;
    d << moment, moment, moment, mass, mass, mass;
    return d.asDiagonal();
  }
  auto constraints(const auto& g) const {
    const auto& r = g.template part<0>();
    using T = std::decay_t<decltype(r(0, 0))>;
    MatT<T, 2, 6> a = MatT<T, 2, 6>::Zero();
    for (int i = 0; i < 3; ++i) {
      a(0, i) = -radius * r(1, i);
      a(1, i) = radius * r(0, i);
    }
    a(0, 3) = a(1, 4) = T(1.0);
    return a;
  }
  auto holonomic(const auto& g) const {
    const auto& x = g.template part<1>();
    using T = std::decay_t<decltype(x[0])>;
    return VecT<T, 1>(x[2] - radius);
  }
  auto potential(const auto& g) const { return mass * gravity * g.template part<1>()[2]; }
  void contacts(auto& add) const { ground.add_to(add, {.tangential = {0, 1}, .normal = 2}); }

  /// On the plane, with the velocity of rolling_ball.
  Start start() const {
    return {.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, radius},
            .velocity = {0.4, 1.5, 0.8, 1.5 * radius, -0.4 * radius, 0},
            .momentum = {}};
  }
  void draw(auto& scene) const {
    scene.floor();
    scene
        .body("ball",
              [](const auto& g) {
                const auto& x = g.template part<1>();
                return Placement{Vec<3>(x[0], x[1], x[2]), g.template part<0>()};
              },
              {shapes::sphere(radius)})
        .trail();
  }
};

}  // namespace hamel
