// Shared by the heavy bodies that roll on the plane z = 0 without slipping.
//
//   SE(3), body frame at the mass centre, z up; xi = (omega, v),
//   l = 1/2 omega^T I omega + 1/2 m |v|^2 - m g z.
// The contact at r from the mass centre rests, v + omega x r = 0; along a direction u, all in body
// axes:
//   u . (v + omega x r) = u . v + (r x u) . omega.
// Along gamma = R^T e_z this is the differential of the contact's height: r may move in the body,
// but only in the tangent plane.
#pragma once

#include <cmath>
#include <type_traits>
#include <utility>

#include <hamel/framework/mechanics/drawing.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/groups/se3.hpp>

namespace hamel::body_on_plane {

using Group = SE3;
using Element = SE3::Element<double>;

/// Row of the velocity of the contact at r along u.
template <class T>
MatT<T, 1, 6> contact_velocity(const VecT<T, 3>& r, const VecT<T, 3>& u) {
  MatT<T, 1, 6> row;
  row.template head<3>() = r.cross(u);
  row.template tail<3>() = u;
  return row;
}
/// v = r x omega as B of v = B omega: the contact at r rests.
template <class T>
MatT<T, 3, 3> frame(const VecT<T, 3>& r) {
  MatT<T, 3, 3> b;
  b(0, 0) = b(1, 1) = b(2, 2) = T(0.0);
  b(0, 1) = -r[2], b(0, 2) = r[1];
  b(1, 0) = r[2], b(1, 2) = -r[0];
  b(2, 0) = -r[1], b(2, 1) = r[0];
  return b;
}
/// The scalar of an element, a double or a dual number.
template <class Element>
using ScalarOf = typename std::decay_t<decltype(std::declval<Element>().rotation)>::Scalar;

/// <dz, xi> = gamma . v.
inline Vec<6> height_differential(const Element& g) {
  Vec<6> d;
  d.head<3>().setZero();
  d.tail<3>() = g.rotation.row(2);
  return d;
}

/// At (0, 0, z), turned by an angle about x.
inline Element leaning(double angle, double z = 0) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {Mat<3, 3>{{1, 0, 0}, {0, c, -s}, {0, s, c}}, Vec<3>(0, 0, z)};
}

/// There, rolling on the contact at r with the body rates omega: v = -omega x r.
inline Start rolling(const Element& g, const Vec<3>& omega, const Vec<3>& r) {
  const Vec<3> v = -omega.cross(r);
  return {.configuration = SE3::coordinates(g),
          .velocity = {omega[0], omega[1], omega[2], v[0], v[1], v[2]},
          .momentum = {}};
}

}  // namespace hamel::body_on_plane
