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
#include <hamel/groups/exp.hpp>
#include <hamel/groups/retractions.hpp>
#include <string>

namespace hamel {

/// Common base of the Cayley maps. Each has solve_even_transposed(xi, c, m) = (1 + c even)^-T m,
/// where dR_xi^-1 = 1 + odd + even in xi (M13), and end_momenta(xi, p, even, odd) of (M50).
template <class G>
struct CayleyDefaults : RetractionDefaults<Cayley<G>, G> {
  static constexpr bool symmetric = true;
  static constexpr bool commuting = true;  // rational functions of one matrix
  static std::string name() { return "cayley"; }
  static std::string formula() { return "tau(xi) = (I - xi^/2)^-1 (I + xi^/2)"; }
  static std::string source() {
    return "Kobilarov, Marsden 2011; Hairer, Lubich, Wanner, Geometric Numerical Integration, "
           "IV.8.3";
  }
};

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
struct Cayley<SO3> : CayleyDefaults<SO3> {
  /// dR^-1 is quadratic in xi, so the weight of its even part is one
  /// (framework/schemes/hamel_form.hpp).
  static double quadratic_weight(const auto& /*x*/) { return 1.0; }
  static constexpr bool quadratic_weight_is_one = true;
  static double angle_squared(const Vec<3>& xi) { return xi.dot(xi); }
  /// I + (omega^ + omega^2/2)/(1 + |omega|^2/4).
  template <class T>
  static MatT<T, 3, 3> tau(const VecT<T, 3>& xi) {
    const T square = xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2];  // one order for every T
    const T a = 1.0 / (1.0 + 0.25 * square);
    return rotation_polynomial(xi, a, T(0.5 * a));
  }
  /// tau(xi/2)^2 = I + ((1 - x) omega^ + omega^^2/2)/(1 + x)^2, x = |omega|^2/16.
  template <class T>
  static MatT<T, 3, 3> tau_of_halves(const VecT<T, 3>& xi) {
    const T x = 0.0625 * xi.dot(xi), a = 1.0 / (1.0 + x), b = a * a;
    return rotation_polynomial(xi, T((1.0 - x) * b), T(0.5 * b));
  }
  template <class T>
  static VecT<T, 3> tau_inverse(const MatT<T, 3, 3>& g) {
    return 2.0 * gibbs_vector(g, "so3 cayley^-1");
  }
  /// (I + omega^/2)/(1 + |omega|^2/4).
  template <class T>
  static MatT<T, 3, 3> dtau_right(const VecT<T, 3>& xi) {
    const T a = 1.0 / (1.0 + 0.25 * xi.dot(xi));
    const VecT<T, 3> w = (0.5 * a) * xi;
    MatT<T, 3, 3> m;
    m << a, -w[2], w[1], w[2], a, -w[0], -w[1], w[0], a;
    return m;
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse(const VecT<T, 3>& xi) {
    const VecT<T, 3> h = 0.5 * xi;
    const T xy = h[0] * h[1], xz = h[0] * h[2], yz = h[1] * h[2];
    MatT<T, 3, 3> m;
    m << 1.0 + h[0] * h[0], xy + h[2], xz - h[1],  //
        xy - h[2], 1.0 + h[1] * h[1], yz + h[0],   //
        xz + h[1], yz - h[0], 1.0 + h[2] * h[2];
    return m;
  }
  /// dL^-1 eta = eta + omega x eta/2 + omega (omega.eta)/4.
  template <class T>
  static VecT<T, 3> dtau_left_inverse(const VecT<T, 3>& xi, const VecT<T, 3>& eta) {
    return dtau_right_inverse_transpose(xi, eta);
  }
  using CayleyDefaults<SO3>::dtau_left_inverse;
  /// p + omega x p/2 + omega (omega.p)/4.
  template <class T>
  static VecT<T, 3> dtau_right_inverse_transpose(const VecT<T, 3>& xi, const VecT<T, 3>& p) {
    const VecT<T, 3> h = 0.5 * xi;
    const T d = h.dot(p);
    return {p[0] + h[1] * p[2] - h[2] * p[1] + d * h[0],
            p[1] + h[2] * p[0] - h[0] * p[2] + d * h[1],
            p[2] + h[0] * p[1] - h[1] * p[0] + d * h[2]};
  }
  /// even = p + 2 a (a.p) - |a|^2 p, odd = 2 a x p, a = omega/4.
  template <class T>
  static void end_momenta(const VecT<T, 3>& xi, const VecT<T, 3>& p, VecT<T, 3>& even,
                          VecT<T, 3>& odd) {
    const VecT<T, 3> a = 0.25 * xi, twice = 2.0 * a;
    even = a.dot(p) * twice + (1.0 - a.dot(a)) * p;
    odd = twice.cross(p);
  }
  template <class T>
  static VecT<T, 3> solve_even_transposed(const VecT<T, 3>& xi, double c, const VecT<T, 3>& m) {
    const double k = 0.25 * c;
    return m - (k * xi.dot(m) / (1 + k * xi.dot(xi))) * xi;
  }
  /// (omega.p I + omega p^T)/4 - p^/2.
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse_transpose_derivative(const VecT<T, 3>& xi,
                                                               const VecT<T, 3>& p) {
    const VecT<T, 3> q = 0.25 * p;
    const T d = xi.dot(q);
    MatT<T, 3, 3> m;
    m << xi[0] * q[0] + d, xi[0] * q[1] + 2.0 * q[2], xi[0] * q[2] - 2.0 * q[1],  //
        xi[1] * q[0] - 2.0 * q[2], xi[1] * q[1] + d, xi[1] * q[2] + 2.0 * q[0],   //
        xi[2] * q[0] + 2.0 * q[1], xi[2] * q[1] - 2.0 * q[0], xi[2] * q[2] + d;
    return m;
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

template <>
struct Cayley<SE3> : CayleyDefaults<SE3> {
  /// (cay omega, (I - omega^/2)^-1 v).
  template <class T>
  static SE3Element<T> tau(const VecT<T, 6>& xi) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>();
    const T a = 1.0 / (1.0 + 0.25 * omega.dot(omega)), half = 0.5 * a;
    const VecT<T, 3> wv = omega.cross(v);
    return {rotation_polynomial(omega, a, half), v + half * (wv + 0.5 * omega.cross(wv))};
  }
  template <class T>
  static VecT<T, 6> tau_inverse(const SE3Element<T>& g) {
    const VecT<T, 3> t = gibbs_vector(g.rotation, "se3 cayley^-1");
    VecT<T, 6> xi;
    xi.template head<3>() = 2.0 * t;
    xi.template tail<3>() = g.translation - t.cross(g.translation);
    return xi;
  }
  /// [[P, 0], [v^ P/2, Q]]: P = dR on SO(3), Q = (I - omega^/2)^-1 = I + a (omega^/2 +
  /// (omega^)^2/4).
  template <class T>
  static MatT<T, 6, 6> dtau_right(const VecT<T, 6>& xi) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>();
    const T a = 1.0 / (1.0 + 0.25 * omega.dot(omega));
    const MatT<T, 3, 3> rotational = Cayley<SO3>::dtau_right(omega);
    MatT<T, 6, 6> m;
    m.template topLeftCorner<3, 3>() = rotational;
    m.template topRightCorner<3, 3>().setZero();
    m.template bottomLeftCorner<3, 3>() = cross_matrix(VecT<T, 3>(0.5 * v)).lazyProduct(rotational);
    m.template bottomRightCorner<3, 3>() = rotation_polynomial(omega, T(0.5 * a), T(0.25 * a));
    return m;
  }
  /// [[I - W/2 + omega omega^T/4, 0], [-V/2 + W V/4, I - W/2]].
  template <class T>
  static MatT<T, 6, 6> dtau_right_inverse(const VecT<T, 6>& xi) {
    const VecT<T, 3> omega = xi.template head<3>(), w = 0.5 * omega,
                     v = 0.5 * xi.template tail<3>();
    MatT<T, 6, 6> m;
    m.template topLeftCorner<3, 3>() = Cayley<SO3>::dtau_right_inverse(omega);
    m.template topRightCorner<3, 3>().setZero();
    MatT<T, 3, 3> lower = v * w.transpose();  // W V/4 = v w^T - (w.v) I
    lower.diagonal().array() -= w.dot(v);
    lower -= cross_matrix(v);
    m.template bottomLeftCorner<3, 3>() = lower;
    MatT<T, 3, 3> last;
    const T one(1.0);
    last << one, w[2], -w[1], -w[2], one, w[0], w[1], -w[0], one;
    m.template bottomRightCorner<3, 3>() = last;
    return m;
  }
  /// dL^-1 eta, eta = (a, b), without forming the matrix; w and v are halves of omega and v:
  /// (a + w x a + w (w.a), b + w x b + v x a + v (w.a) - (w.v) a).
  template <class T>
  static VecT<T, 6> dtau_left_inverse(const VecT<T, 6>& xi, const VecT<T, 6>& eta) {
    const VecT<T, 3> w = 0.5 * xi.template head<3>(), v = 0.5 * xi.template tail<3>(),
                     a = eta.template head<3>(), b = eta.template tail<3>();
    const T wa = w.dot(a);
    VecT<T, 6> out;
    out << a + w.cross(a) + wa * w, b + w.cross(b) + v.cross(a) + wa * v - w.dot(v) * a;
    return out;
  }
  using CayleyDefaults<SE3>::dtau_left_inverse;
  /// The transpose of that, applied to p without forming it.
  template <class T>
  static VecT<T, 6> dtau_right_inverse_transpose(const VecT<T, 6>& xi, const VecT<T, 6>& p) {
    const VecT<T, 3> w = 0.5 * xi.template head<3>(), v = 0.5 * xi.template tail<3>(),
                     m = p.template head<3>(), f = p.template tail<3>();
    VecT<T, 6> out;
    out.template head<3>() = m + w.cross(m) + w * (w.dot(m) + v.dot(f)) - w.dot(v) * f + v.cross(f);
    out.template tail<3>() = f + w.cross(f);
    return out;
  }
  /// a and b are quarters of omega and v, p = (m, f), F = a x f, M = a x m + b x f:
  /// even = (m + a x M + b x F + (a.b) (a x F - f) + a (a.m + b.f), f + a x F), odd = 2 (M, F).
  template <class T>
  static void end_momenta(const VecT<T, 6>& xi, const VecT<T, 6>& p, VecT<T, 6>& even,
                          VecT<T, 6>& odd) {
    const VecT<T, 3> a = 0.25 * xi.template head<3>(), b = 0.25 * xi.template tail<3>(),
                     m = p.template head<3>(), f = p.template tail<3>();
    const VecT<T, 3> force = a.cross(f), moment = a.cross(m) + b.cross(f), again = a.cross(force);
    even.template head<3>() =
        m + a.cross(moment) + b.cross(force) + a.dot(b) * (again - f) + (a.dot(m) + b.dot(f)) * a;
    even.template tail<3>() = f + again;
    odd.template head<3>() = 2.0 * moment;
    odd.template tail<3>() = 2.0 * force;
  }
  /// The transpose of the even part is [[omega omega^T, omega v^T - (omega.v) I], [0, 0]]/4.
  template <class T>
  static VecT<T, 6> solve_even_transposed(const VecT<T, 6>& xi, double c, const VecT<T, 6>& m) {
    const double k = 0.25 * c;
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>(),
                     force = m.template tail<3>();
    const VecT<T, 3> moment =
        m.template head<3>() + k * (omega.dot(v) * force - v.dot(force) * omega);
    VecT<T, 6> out;
    out.template head<3>() = moment - (k * omega.dot(moment) / (1 + k * omega.dot(omega))) * omega;
    out.template tail<3>() = force;
    return out;
  }
  /// [[N(omega, m) + (v.f I - f v^T)/4, -(f + omega x f/2)^/2], [-f^/2, 0]], N the derivative on
  /// SO(3).
  template <class T>
  static MatT<T, 6, 6> dtau_right_inverse_transpose_derivative(const VecT<T, 6>& xi,
                                                               const VecT<T, 6>& p) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>();
    const VecT<T, 3> moment = p.template head<3>(), f = -0.5 * p.template tail<3>();
    MatT<T, 3, 3> top = Cayley<SO3>::dtau_right_inverse_transpose_derivative(omega, moment);
    top += (0.5 * f) * v.transpose();
    top.diagonal().array() -= 0.5 * v.dot(f);
    MatT<T, 6, 6> m;
    m.template topLeftCorner<3, 3>() = top;
    m.template topRightCorner<3, 3>() = cross_matrix(VecT<T, 3>(f + 0.5 * omega.cross(f)));
    m.template bottomLeftCorner<3, 3>() = cross_matrix(f);
    m.template bottomRightCorner<3, 3>().setZero();
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
