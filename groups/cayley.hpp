// The Cayley map (I - xi^/2)^-1 (I + xi^/2) in the defining matrices of SO(3), SE(2), SE(3), and of
// SO(2) as cayley_literal; addition on the commutative groups SO(2) and R^n. (M33) of
// framework/schemes/README.md.
//
// The map is rational. (dR^-1 eta)^ = (I - xi^/2) eta^ (I + xi^/2) is a polynomial; with W = omega^
// and V = v^:
//   SO(2)    dR^-1 = 1 + omega^2/4
//   SO(3)    dR^-1 = I - W/2 + omega omega^T/4
//            dR    = (I + W/2)/(1 + |omega|^2/4)
//   SE(2)    dR^-1 = I - ad/2 + omega xi e_omega^T/4
//            dR    = (I + ad/2)/(1 + omega^2/4)
//   SE(3)    dR^-1 = I - ad/2 + [[omega omega^T, 0], [W V, 0]]/4
//            dR    = [[P, 0], [V P/2, Q]],   P = dR of SO(3), Q = (I - W/2)^-1
// The rotation angle is 2 atan(|omega|/2), less than pi; the inverse is singular at pi.
// Source: Kobilarov, Marsden, Discrete geometric optimal control on Lie groups (2011);
// Hairer, Lubich, Wanner, Geometric Numerical Integration, IV.8.3.
#pragma once

#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/groups/cayley_se3.hpp>
#include <hamel/groups/cayley_so3.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/retractions.hpp>
#include <string>

namespace hamel {

template <int N>
struct Cayley<Rn<N>> : IdentityRetraction<Cayley<Rn<N>>, Rn<N>> {
  static std::string name() { return "cayley"; }
};

template <>
struct Cayley<SO2> : AddedAngle<Cayley<SO2>> {
  static std::string name() { return "cayley"; }
};

/// For comparison: a step of size x turns by 2 atan(x/2), short of x by x^3/12.
template <>
struct CayleyLiteral<SO2> : RetractionDefaults<CayleyLiteral<SO2>, SO2> {
  static constexpr bool symmetric = true;
  static constexpr bool commuting = true;
  static std::string name() { return "cayley_literal"; }
  static std::string formula() { return CayleyDefaults<SO2>::formula(); }
  static std::string source() { return CayleyDefaults<SO2>::source(); }
  /// The retraction of the other factors of a product.
  static std::string elsewhere() { return "cayley"; }
  /// ((1 - a^2) + 2 a i)/(1 + a^2), a = omega/2.
  template <class T>
  static SO2Element<T> tau(const VecT<T, 1>& xi) {
    const T half = 0.5 * xi[0], s = xi[0] / (1.0 + half * half);
    return {1.0 - half * s, s, 0};
  }
  template <class T>
  static VecT<T, 1> tau_inverse(const SO2Element<T>& g) {
    return VecT<T, 1>(2.0 * half_angle_tangent(g.c, g.s, "so2 cayley_literal^-1"));
  }
  static double angle_squared(const Vec<1>& xi) { return xi[0] * xi[0]; }
  /// As on the other groups (cayley_so3.hpp).
  static Vec<1> recover_step(const SO2Element<double>& delta, double s) {
    const Vec<1> y = tau_inverse(delta);
    return CayleyDefaults<SO2>::step_scale(y[0] * y[0], s) * y;
  }
  template <class T>
  static MatT<T, 1, 1> dtau_right(const VecT<T, 1>& xi) {
    return MatT<T, 1, 1>(1.0 / (1.0 + 0.25 * xi[0] * xi[0]));
  }
  template <class T>
  static MatT<T, 1, 1> dtau_right_inverse(const VecT<T, 1>& xi) {
    return MatT<T, 1, 1>(1.0 + 0.25 * xi[0] * xi[0]);
  }
  template <class T>
  static MatT<T, 1, 1> dtau_right_inverse_transpose_derivative(const VecT<T, 1>& xi,
                                                               const VecT<T, 1>& p) {
    return MatT<T, 1, 1>(0.5 * xi[0] * p[0]);
  }
  static Vec<1> solve_even_transposed(const Vec<1>& xi, double c, const Vec<1>& m) {
    return Vec<1>(m[0] / (1 + 0.25 * c * xi[0] * xi[0]));
  }
  template <class T>
  static void end_momenta(const VecT<T, 1>& xi, const VecT<T, 1>& p, VecT<T, 1>& even,
                          VecT<T, 1>& odd) {
    even[0] = (1.0 + 0.0625 * xi[0] * xi[0]) * p[0];
    odd[0] = T(0.0);
  }
};

template <>
struct Cayley<SE2> : CayleyDefaults<SE2> {
  /// dR^-1 is quadratic in xi, so the weight of its even part is one
  /// (framework/schemes/hamel_form.hpp).
  static double quadratic_weight(const auto& /*x*/) { return 1.0; }
  static constexpr bool quadratic_weight_is_one = true;
  static double angle_squared(const Vec<3>& xi) { return xi[0] * xi[0]; }
  /// (cay omega, (I - omega J/2)^-1 v).
  template <class T>
  static SE2Element<T> tau(const VecT<T, 3>& xi) {
    const T half = 0.5 * xi[0], a = 1.0 / (1.0 + half * half), b = half * a, s = xi[0] * a;
    SE2Element<T> g;
    g.rotation = {1.0 - half * s, s, 0};
    g.translation = VecT<T, 2>(a * xi[1] - b * xi[2], b * xi[1] + a * xi[2]);
    return g;
  }
  template <class T>
  static VecT<T, 3> tau_inverse(const SE2Element<T>& g) {
    const T t = half_angle_tangent(g.rotation.c, g.rotation.s, "se2 cayley^-1");
    const VecT<T, 2>& p = g.translation;
    return {2.0 * t, p[0] + t * p[1], p[1] - t * p[0]};
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right(const VecT<T, 3>& xi) {
    const T zero(0.0), half = 0.5 * xi[0], a = 1.0 / (1.0 + half * half), b = half * a;
    // The column of omega: -(lower block)^-1 (J v/2 + omega v/4) a = a J^T v/2.
    MatT<T, 3, 3> m;
    m << a, zero, zero, 0.5 * a * xi[2], a, -b, -0.5 * a * xi[1], b, a;
    return m;
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse(const VecT<T, 3>& xi) {
    const T zero(0.0), w = 0.5 * xi[0], v1 = 0.5 * xi[1], v2 = 0.5 * xi[2];
    MatT<T, 3, 3> m;
    m << 1.0 + w * w, zero, zero, w * v1 - v2, T(1.0), w, v1 + w * v2, -w, T(1.0);
    return m;
  }
  /// [[1 + w^2, 0], [w v - J v, I + w J]] eta; w and v are halves of omega and v.
  template <class T>
  static VecT<T, 3> dtau_left_inverse(const VecT<T, 3>& xi, const VecT<T, 3>& eta) {
    const T w = 0.5 * xi[0], v1 = 0.5 * xi[1], v2 = 0.5 * xi[2];
    return {eta[0] + w * w * eta[0], (w * v1 + v2) * eta[0] + eta[1] - w * eta[2],
            (w * v2 - v1) * eta[0] + w * eta[1] + eta[2]};
  }
  using CayleyDefaults<SE2>::dtau_left_inverse;
  template <class T>
  static VecT<T, 3> dtau_right_inverse_transpose(const VecT<T, 3>& xi, const VecT<T, 3>& p) {
    const T w = 0.5 * xi[0], v1 = 0.5 * xi[1], v2 = 0.5 * xi[2];
    const T q1 = p[1] - w * p[2], q2 = p[2] + w * p[1];
    return {p[0] + w * w * p[0] + v1 * q2 - v2 * q1, q1, q2};
  }
  /// w and v are quarters of omega and v.
  template <class T>
  static void end_momenta(const VecT<T, 3>& xi, const VecT<T, 3>& p, VecT<T, 3>& even,
                          VecT<T, 3>& odd) {
    const T w = 0.25 * xi[0], v1 = 0.25 * xi[1], v2 = 0.25 * xi[2], twice = 2.0 * w;
    const T less = 1.0 - w * w;
    even = {p[0] + w * w * p[0] + twice * (v1 * p[1] + v2 * p[2]), less * p[1], less * p[2]};
    odd = {2.0 * (v1 * p[2] - v2 * p[1]), -twice * p[2], twice * p[1]};
  }
  template <class T>
  static VecT<T, 3> solve_even_transposed(const VecT<T, 3>& xi, double c, const VecT<T, 3>& m) {
    const T k = 0.25 * c * xi[0];
    return {m[0] - k * xi.dot(m) / (1 + k * xi[0]), m[1], m[2]};
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse_transpose_derivative(const VecT<T, 3>& xi,
                                                               const VecT<T, 3>& p) {
    const T zero(0.0), q1 = 0.5 * p[1], q2 = 0.5 * p[2], w = 0.5 * xi[0];
    MatT<T, 3, 3> m;
    m << 0.5 * (xi[0] * p[0] + q1 * xi[1] + q2 * xi[2]), q2 + w * q1, w * q2 - q1,  //
        -q2, zero, zero, q1, zero, zero;
    return m;
  }
};

// Compiled once, geometries.cpp.
template <>
std::shared_ptr<const Geometry> erased_geometry<Cayley<SO3>>();
template <>
std::shared_ptr<const Geometry> erased_geometry<Cayley<SE2>>();
template <>
std::shared_ptr<const Geometry> erased_geometry<Cayley<SE3>>();

}  // namespace hamel
