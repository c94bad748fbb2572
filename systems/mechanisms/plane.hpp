// The algebra of screw.hpp restricted to turns about the third axis and moves across
// it.
//
//   twist (w, v1, v2), wrench (m3, f1, f2): the entries 3 to 5 of those in space
//   ad_V W = (0, v2 w' - w v2', w v1' - v1 w'),   W = (w', v1', v2')
//   ad_V^T P = (f1 v2 - f2 v1, f2 w, -f1 w)
#pragma once

#include <hamel/systems/mechanisms/screw.hpp>

namespace hamel::mechanisms {

/// The entries in the plane of a twist or wrench in space.
template <class V>
auto in_plane(V&& v) {
  return v.template segment<3>(2);
}

/// x -> Rot x + (x, y), Rot = [c -s; s c].
struct PlaneMotion {
  double c = 1, s = 0, x = 0, y = 0;

  Rigid in_space() const { return {Mat<3, 3>{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, Vec3(x, y, 0)}; }
  Vec3 turn(const Vec3& v) const { return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]}; }
  /// Moves a twist in the plane, Ad.
  Vec3 move_in_plane(const Vec3& v) const {
    return {v[0], c * v[1] - s * v[2] + y * v[0], s * v[1] + c * v[2] - x * v[0]};
  }
  /// Moves a twist in space, Ad.
  Twist move(const Twist& v) const {
    const Vec3 omega = turn(upper(v));
    return stack(omega, turn(lower(v)) + arm(omega));
  }
  /// Moves a wrench in space by the inverse of Ad^T.
  Wrench move_wrench(const Wrench& f) const {
    const Vec3 force = turn(lower(f));
    return stack(turn(upper(f)) + arm(force), force);
  }

 private:
  Vec3 arm(const Vec3& v) const { return {y * v[2], -x * v[2], x * v[1] - y * v[0]}; }
};
inline PlaneMotion operator*(const PlaneMotion& a, const PlaneMotion& b) {
  return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s, a.x + a.c * b.x - a.s * b.y,
          a.y + a.s * b.x + a.c * b.y};
}

/// Moves an inertia in the plane: its mass, first moment and moment about the third axis alone.
inline void move_in_plane(const PlaneMotion& x, const Inertia& from, Inertia& to) {
  const Vec3 first = x.turn(from.first);
  to.mass = from.mass;
  to.first = first + from.mass * Vec3(x.x, x.y, 0);
  to.second(2, 2) =
      from.second(2, 2) + x.x * (first[0] + to.first[0]) + x.y * (first[1] + to.first[1]);
}
inline void add_in_plane(Inertia& to, const Inertia& more) {
  to.mass += more.mass;
  to.first += more.first;
  to.second(2, 2) += more.second(2, 2);
}
inline Vec3 momentum_in_plane(const Inertia& i, const Vec3& v) {
  return {i.second(2, 2) * v[0] + i.first[0] * v[2] - i.first[1] * v[1],
          i.mass * v[1] - v[0] * i.first[1], i.mass * v[2] + v[0] * i.first[0]};
}
inline Vec3 ad_in_plane(const Vec3& v, const Vec3& w) {
  return {0, v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]};
}
inline Vec3 ad_transpose_in_plane(const Vec3& v, const Vec3& p) {
  return {p[1] * v[2] - p[2] * v[1], p[2] * v[0], -p[1] * v[0]};
}

}  // namespace hamel::mechanisms
