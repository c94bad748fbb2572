// Rotation matrices from and to vectors along the axis, for the retractions of SO(3) and SE(3).
//
//   I + a omega^ + b (omega^)^2      the form of every function of omega^
//   t         = tan(theta/2) n       the Gibbs (Rodrigues) vector of a rotation R by theta about n
//   log R     = 2 atan|t| t/|t|
//   cay^-1 R  = 2 t
// Source: M. Shuster, A survey of attitude representations (1993);
// S. Shepperd, Quaternion from rotation matrix (1978).
#pragma once

#include <cmath>
#include <hamel/framework/lie/concepts.hpp>
#include <hamel/framework/lie/coordinates.hpp>
#include <hamel/framework/lie/types.hpp>
#include <numbers>
#include <string>

namespace hamel {

/// I + a omega^ + b (omega^)^2, 3 x 3.
template <class T>
MatT<T, 3, 3> rotation_polynomial(const VecT<T, 3>& omega, const T& a, const T& b) {
  const T &x = omega[0], &y = omega[1], &z = omega[2];
  const T bx = b * x, by = b * y, bz = b * z;
  const T xx = bx * x, yy = by * y, zz = bz * z, xy = bx * y, xz = bx * z, yz = by * z;
  const T ax = a * x, ay = a * y, az = a * z;
  MatT<T, 3, 3> r;
  r << 1.0 - (yy + zz), xy - az, xz + ay,  //
      xy + az, 1.0 - (xx + zz), yz - ax,   //
      xz - ay, yz + ax, 1.0 - (xx + yy);
  return r;
}

/// tan(theta/2) n of a rotation R by theta about n, accurate up to the pole at theta = pi.
/// Throws DomainError within 2e-12 of it, naming `map`.
template <class T>
VecT<T, 3> gibbs_vector(const MatT<T, 3, 3>& r, const std::string_view map) {
  using std::sqrt;
  const VecT<T, 3> twice_sine{r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};
  const T trace = r(0, 0) + r(1, 1) + r(2, 2);
  if (trace > 0.0) return twice_sine / (1.0 + trace);
  // The quaternion (w, q), from its largest component.
  int i = r(1, 1) > r(0, 0) ? 1 : 0;
  if (r(2, 2) > r(i, i)) i = 2;
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const T q_i = 0.5 * sqrt(1.0 + r(i, i) - r(j, j) - r(k, k));
  VecT<T, 3> q;
  q[i] = q_i;
  q[j] = (r(i, j) + r(j, i)) / (4.0 * q_i);
  q[k] = (r(i, k) + r(k, i)) / (4.0 * q_i);
  const T w = twice_sine[i] / (4.0 * q_i);
  if (!(w > 1e-12 || w < -1e-12)) {
    throw DomainError(std::string(map) + ": rotation by an angle of " + to_text(std::numbers::pi) +
                      " rad (pi, to 2e-12), where the inverse is singular");
  }
  return q / w;
}

/// tan(theta/2) = s/(1 + c) of a plane rotation. Throws DomainError within 2e-12 of theta = pi.
template <class T>
T half_angle_tangent(const T& c, const T& s, const std::string_view map) {
  if (c > 0.0) return s / (1.0 + c);
  if (!(s > 2e-12 || s < -2e-12)) {
    throw DomainError(std::string(map) + ": rotation by an angle of " + to_text(std::numbers::pi) +
                      " rad (pi, to 2e-12), where the inverse is singular");
  }
  return (1.0 - c) / s;
}

}  // namespace hamel
