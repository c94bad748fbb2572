// Contacts with a ground z = h(x, y).
//
// With n = (-h_x, -h_y, 1)/|...| the normal at (x, y), P = (x, y, h), and q(n) the point that a
// contact (contact.hpp) would have on a plane across n, the foot (x, y) of the contact is where
//   (q(n) - P) . (1, 0, h_x) = 0,   (q(n) - P) . (0, 1, h_y) = 0,   phi = (q(n) - P) . n.
// phi is the distance: n, the places of P on the ground and of q on the body may change, but all
// these changes are across n, so that dphi is n . (v + omega x q), and the rows are those of a
// plane across n. The body touches at one point where the two equations fall as (x, y) grows: where
// the ground is less curved than the body. The foot is found by Newton's method with differences;
// for programs it is an input, whose rate follows from the equations.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include <hamel/systems/mechanisms/contact.hpp>

namespace hamel::mechanisms {

struct GroundPoint {
  Vec3 point, normal;
  Vec3 along_x, along_y;  // not of length 1
};
inline GroundPoint ground_at(const Expression& height, const Vec<2>& at) {
  std::array<double, 2> slope{};
  const double h = height.differentiate({at.data(), 2}, 1, slope);
  return {{at[0], at[1], h},
          Vec3(-slope[0], -slope[1], 1).normalized(),
          {1, 0, slope[0]},
          {0, 1, slope[1]}};
}

/// Sets the vertical of a view across the ground at (x, y).
inline void stand_on(const Vec3& normal, ContactView<double>& view) {
  view.sloping = true;
  view.vertical = normal[0] * view.world_axis(0) + normal[1] * view.world_axis(1) +
                  normal[2] * view.world_axis(2);
}

/// The foot of a contact, touch(view) -> q; NaN where there is none.
template <class Touch>
Vec<2> find_foot(const Expression& height, ContactView<double> view, const Touch& touch) {
  const auto apart = [&](const Vec<2>& at) -> Vec<2> {
    const GroundPoint ground = ground_at(height, at);
    stand_on(ground.normal, view);
    const Vec3 gap = view.point_in_world(touch(view)) - ground.point;
    return {gap.dot(ground.along_x), gap.dot(ground.along_y)};
  };
  constexpr int most = 50;
  constexpr double apart_by = 1e-5;  // of differences: their error, 1e-10, is that of a step
  Vec<2> at = view.point_in_world(view.at).template head<2>();
  Mat<2, 2> slopes;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most; ++i) {
    const double width = apart_by * (1 + at.norm());
    for (int k = 0; k < 2; ++k) {
      const Vec<2> aside = width * Vec<2>::Unit(k);
      slopes.col(k) = (apart(at + aside) - apart(at - aside)) / (2 * width);
    }
    const Vec<2> change = -slopes.inverse() * apart(at);
    const double size = change.norm();
    if (!std::isfinite(size)) break;
    at += change;
    const bool small = size <= 1e-15 * (1 + at.norm());
    if (small || (size <= 1e-12 * (1 + at.norm()) && size >= before)) {
      const bool touches = slopes.determinant() > 0 && slopes.trace() < 0;
      if (touches) return at;
      break;
    }
    before = size;
  }
  return Vec<2>::Constant(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace hamel::mechanisms
