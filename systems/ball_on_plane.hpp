// Shared by the balls that roll on the plane z = 0 without slipping.
//
//   SO(3) x R^2, xi = (omega in the body, x', y'): the rotation R and the position (x, y) of the
//   centre, which stays at the height rho.
// With w = R omega the contact moves at (x' - rho w_y, y' + rho w_x): 0 on a plane at rest, the
// plane's own velocity on one that moves.
#pragma once

#include <type_traits>
#include <utility>
#include <vector>

#include <hamel/framework/mechanics/drawing.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/rn.hpp>
#include <hamel/groups/so3.hpp>

namespace hamel::ball_on_plane {

using Group = Product<SO3, Rn<2>>;
using Element = Group::Element<double>;

/// diag(I1, I2, I3, m, m): the mass centre at the centre of the ball, principal axes as body axes.
inline Mat<5, 5> inertia(const Vec<3>& moments, double mass) {
  Vec<5> d;
  d << moments, mass, mass;
  return d.asDiagonal();
}

/// Rows of the velocity of the contact, (x' - rho w_y, y' + rho w_x).
auto contact_velocity(const auto& g, double radius) {
  const auto& r = g.template part<0>();
  using T = std::decay_t<decltype(r(0, 0))>;
  MatT<T, 2, 5> a;
  for (int i = 0; i < 3; ++i) {
    a(0, i) = -radius * r(1, i);
    a(1, i) = radius * r(0, i);
  }
  a(0, 3) = a(1, 4) = T(1.0);
  a(0, 4) = a(1, 3) = T(0.0);
  return a;
}

/// The ball on its floor, with marks fixed in it; the trail follows a point of the body.
/// (x', y') = B omega of the same rows.
auto frame(const auto& g, double radius) {
  const auto& r = g.template part<0>();
  using T = std::decay_t<decltype(r(0, 0))>;
  MatT<T, 2, 3> b;
  for (int i = 0; i < 3; ++i) {
    b(0, i) = radius * r(1, i);
    b(1, i) = -radius * r(0, i);
  }
  return b;
}

/// And B': a row of R has the rate row x omega.
inline Mat<2, 3> frame_rate(const Element& g, const Vec<5>& xi, double radius) {
  const Mat<3, 3>& r = g.part<0>();
  const Vec<3> omega = xi.head<3>(), x = r.row(0).transpose(), y = r.row(1).transpose();
  Mat<2, 3> b;
  b.row(0) = radius * y.cross(omega).transpose();
  b.row(1) = -radius * x.cross(omega).transpose();
  return b;
}

void draw(auto& scene, double radius, const std::vector<BodyShape>& marks = {}, Point trail = {}) {
  scene.floor();
  std::vector<BodyShape> shapes = {shapes::sphere(radius)};
  shapes.insert(shapes.end(), marks.begin(), marks.end());
  scene
      .body(
          "ball",
          [radius](const auto& g) {
            const auto& x = g.template part<1>();
            return Placement{Vec<3>(x[0], x[1], radius), g.template part<0>()};
          },
          std::move(shapes))
      .trail(trail);
}

}  // namespace hamel::ball_on_plane
