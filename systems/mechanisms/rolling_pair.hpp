// A ball that rolls on, or inside, the sphere or cylinder of another body.
//
// With c the ball's centre, r its radius, d the centre of the surface and R its radius, w = c - d,
// of a cylinder its part across the axis e, and m = w/|w|, inside -w/|w|:
//   q = c - r m,   gap = |w| - R - r, inside R - r - |w|,
// gap' = m . (v_ball - v_surface)(q), and the ball does not slip along u1, u2 across m. On a
// cylinder u1 = e, u2 = m x e; on a sphere they are two directions b1, b2 of the surface's body
// across one m0, turned as m0 is onto m on the shortest way,
//   u_i = b_i - (b_i . m)/(1 + m0 . m) (m0 + m),
// which is not defined at m = -m0 alone. m0 is 45 degrees from m as drawn, in no plane of the
// drawing, so that a ball that loops in one does not meet that place.
// Source: Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972), ch. III.
#pragma once

#include <array>
#include <cmath>

#include <hamel/systems/mechanisms/tree.hpp>

namespace hamel::mechanisms {

struct RollingSurface {
  Vec3 centre = Vec3::Zero();  // d as drawn
  Vec3 axis = Vec3::Zero();    // e as drawn; 0: a sphere
  double radius = 0;           // R
  bool inside = false;
  double ball = 0;  // r

  bool is_cylinder() const { return !axis.isZero(0); }
  /// m as drawn, with the ball's centre at `at`.
  Vec3 towards_ball(const Vec3& at) const {
    Vec3 w = at - centre;
    w -= w.dot(axis) * axis;
    return inside ? Vec3(-w.normalized()) : Vec3(w.normalized());
  }
  /// m0, b1, b2 as drawn, in columns.
  Mat<3, 3> carried_frame(const Vec3& at) const {
    const Mat<3, 3> drawn = frame_along(towards_ball(at));  // its last column is m
    return frame_along((drawn.col(2) + 0.6 * drawn.col(0) + 0.8 * drawn.col(1)).normalized());
  }
};

/// The point of contact and the directions u1, u2, m, in the world.
template <class T>
struct PairPoint {
  VecT<T, 3> point;
  std::array<VecT<T, 3>, 3> directions;
  T gap;
};

/// at: the ball's centre as drawn. centre, moved, turned: in the world, of the ball's centre, of
/// points and of directions of the surface.
template <class T, class Moved, class Turned>
PairPoint<T> find_pair_point(const RollingSurface& surface, const Vec3& at,
                             const VecT<T, 3>& centre, const Moved& moved, const Turned& turned) {
  using std::sqrt;
  PairPoint<T> out;
  auto& [u1, u2, m] = out.directions;
  VecT<T, 3> w = centre - moved(surface.centre);
  if (surface.is_cylinder()) {
    u1 = turned(surface.axis);
    w -= w.dot(u1) * u1;
  }
  const T length = sqrt(w.squaredNorm());
  const double side = surface.inside ? -1 : 1;
  m = (T(side) / length) * w;
  out.point = centre - T(surface.ball) * m;
  out.gap = T(side) * (length - T(surface.radius)) - T(surface.ball);
  if (surface.is_cylinder()) {
    u2 = m.cross(u1);
    return out;
  }
  const Mat<3, 3> frame = surface.carried_frame(at);
  const VecT<T, 3> m0 = turned(frame.col(2));
  const T share = T(1.0) / (T(1.0) + m0.dot(m));
  for (int i = 0; i < 2; ++i) {
    const VecT<T, 3> b = turned(frame.col(i));
    out.directions[static_cast<size_t>(i)] = b - (share * b.dot(m)) * (m0 + m);
  }
  return out;
}

}  // namespace hamel::mechanisms
