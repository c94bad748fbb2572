// Rigid motions, twists, wrenches and inertias of bodies: the algebra of the recursions over a tree
// of bodies.
//
//   twist  V = (omega, v), 6 numbers, v the velocity of the point of the body that is at the origin
//          of the frame
//   wrench F = (moment about the origin, force); power F . V
//   Ad_X (omega, v) = (R omega, R v + p x R omega),   X = (R, p)
//   ad_V (a, b) = (omega x a, v x a + omega x b)
// Source: Murray, Li, Sastry, A Mathematical Introduction to Robotic Manipulation (1994), ch. 2.
#pragma once

#include <array>

#include <hamel/framework/lie/types.hpp>
#include <hamel/groups/so3.hpp>

namespace hamel::mechanisms {

using Vec3 = Vec<3>;
using Twist = Vec<6>;
using Wrench = Vec<6>;

inline Vec3 upper(const Vec<6>& v) { return v.head<3>(); }
inline Vec3 lower(const Vec<6>& v) { return v.tail<3>(); }
/// A point of a drawing.
inline Vec3 vec(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }
inline Vec<6> stack(const Vec3& a, const Vec3& b) {
  Vec<6> out;
  out.head<3>() = a;
  out.tail<3>() = b;
  return out;
}

/// x -> rotation x + position.
struct Rigid {
  Mat<3, 3> rotation = Mat<3, 3>::Identity();
  Vec3 position = Vec3::Zero();

  Vec3 apply(const Vec3& x) const { return rotation.lazyProduct(x) + position; }
  Rigid inverse() const {
    return {rotation.transpose(), -(rotation.transpose().lazyProduct(position))};
  }
  /// Ad_X V.
  Twist move(const Twist& v) const {
    const Vec3 omega = rotation.lazyProduct(upper(v));
    return stack(omega, Vec3(rotation.lazyProduct(lower(v))) + position.cross(omega));
  }
  /// Moves a wrench by the inverse of Ad_X^T.
  Wrench move_wrench(const Wrench& f) const {
    const Vec3 force = rotation.lazyProduct(lower(f));
    return stack(Vec3(rotation.lazyProduct(upper(f))) + position.cross(force), force);
  }
};
inline Rigid operator*(const Rigid& x, const Rigid& y) {
  return {x.rotation.lazyProduct(y.rotation), x.apply(y.position)};
}

/// The force along u at the point q: its power is u . (v + omega x q), the velocity of that point
/// along u.
inline Wrench force_at(const Vec3& q, const Vec3& u) { return stack(q.cross(u), u); }
/// The velocity of the point at q.
inline Vec3 velocity_at(const Twist& v, const Vec3& q) { return lower(v) + upper(v).cross(q); }

/// ad_V W.
inline Twist ad(const Twist& v, const Twist& w) {
  const Vec3 omega = upper(v), a = upper(w);
  return stack(omega.cross(a), lower(v).cross(a) + omega.cross(lower(w)));
}
/// ad_V^T P = (m x omega + f x v, f x omega).
inline Wrench ad_transpose(const Twist& v, const Wrench& p) {
  const Vec3 m = upper(p), f = lower(p), omega = upper(v);
  return stack(m.cross(omega) + f.cross(lower(v)), f.cross(omega));
}

/// Mass [kg], first moment [kg m] and moment of inertia about the frame's origin [kg m^2]; they
/// add.
struct Inertia {
  double mass = 0;
  Vec3 first = Vec3::Zero();
  Mat<3, 3> second = Mat<3, 3>::Zero();

  Inertia& operator+=(const Inertia& other) {
    mass += other.mass;
    first += other.first;
    second += other.second;
    return *this;
  }
  /// The momentum at a twist: (J omega + h x v, m v + omega x h).
  Wrench operator*(const Twist& v) const {
    const Vec3 omega = upper(v), velocity = lower(v);
    return stack(Vec3(second.lazyProduct(omega)) + first.cross(velocity),
                 mass * velocity + omega.cross(first));
  }
};

/// m (|x|^2 - x y^T), symmetric in x and y: what moves a moment of inertia.
inline Mat<3, 3> parallel_axis(const Vec3& x, const Vec3& y) {
  const Mat<3, 3> outer = x * y.transpose();
  return x.dot(y) * Mat<3, 3>::Identity() - 0.5 * (outer + outer.transpose());
}
/// About the mass centre at c -> about the origin.
inline Inertia inertia_at(double mass, const Vec3& c, const Mat<3, 3>& central) {
  return {mass, mass * c, central + mass * parallel_axis(c, c)};
}
/// Inertia of a body seen from another frame.
inline Inertia moved(const Rigid& x, const Inertia& i) {
  const Vec3 first = x.rotation.lazyProduct(i.first);
  const Mat<3, 3> turned = x.rotation.lazyProduct(i.second);
  return {i.mass, first + i.mass * x.position,
          turned.lazyProduct(x.rotation.transpose()) +
              parallel_axis(x.position, 2 * first + i.mass * x.position)};
}

}  // namespace hamel::mechanisms
