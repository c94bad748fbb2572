// exp, the exponential map, on SO(3), SE(2) and SE(3); on R^n and SO(2) addition. (M32) of
// framework/schemes/README.md.
//
// Coefficients sinc, cosc, sinc3, cotc of groups/dexp.hpp at x = |omega|^2; W = omega^; t the Gibbs
// vector.
//   SO(3)    exp omega  = I + sinc W + cosc W^2
//            log R      = 2 atan|t| t/|t|
//            dR         = I + cosc W + sinc3 W^2
//            dR^-1      = I - W/2 + cotc W^2
//            N(omega, p) = d/domega [(dR^-1)^T p]
//                        = -p^/2 + cotc (omega.p I + omega p^T - 2 p omega^T)
//                          + 2 cotc' (W^2 p) omega^T
//   SE(2)    exp xi     = (exp omega, (sinc I + omega cosc J) v)
//            dR^-1      = I - ad/2 + cotc ad^2
//   SE(3)    exp xi     = (exp omega, dR_omega v)       dR_omega that of SO(3)
//            dR^-1      = [[P, 0], [dP, P]]
//                         P(omega) that of SO(3), dP its derivative along v
// The SE(3) blocks are the SO(3) formulas over the dual numbers omega + eps v, eps^2 = 0.
// exp is symmetric, exp(-xi) = exp(xi)^-1, and one-parameter, exp(s xi) exp(t xi) = exp((s + t)
// xi). Source: Iserles, Munthe-Kaas, Nørsett, Zanna, Lie-group methods (2000), appendix B.
#pragma once

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/groups/commutative.hpp>
#include <hamel/groups/dexp.hpp>
#include <hamel/groups/exp_se3.hpp>
#include <hamel/groups/exp_so3.hpp>
#include <hamel/groups/retractions.hpp>
#include <hamel/groups/rn.hpp>
#include <hamel/groups/rotation.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/se3.hpp>
#include <hamel/groups/so2.hpp>
#include <hamel/groups/so3.hpp>
#include <numbers>
#include <string>
#include <string_view>

namespace hamel {

template <int N>
struct Exp<Rn<N>> : IdentityRetraction<Exp<Rn<N>>, Rn<N>> {
  static std::string name() { return "exp"; }
};
template <>
struct Exp<SO2> : AddedAngle<Exp<SO2>> {
  static std::string name() { return "exp"; }
};

template <>
struct Exp<SE2> : ExpDefaults<SE2> {
  /// dR^-1 = 1 - ad/2 + cotc(x) ad^2 (framework/schemes/hamel_form.hpp).
  static double quadratic_weight(double x) { return cotc(x); }
  static double angle_squared(const Vec<3>& xi) { return xi[0] * xi[0]; }
  /// (exp omega, (sinc I + omega cosc J) v).
  template <class T>
  static SE2Element<T> tau(const VecT<T, 3>& xi) {
    const T x = xi[0] * xi[0];
    return moved(xi, x, sinc(x), T(xi[0] * cosc(x)));
  }
  /// tau(xi), and dL_xi^-1 eta in `rate`.
  template <class T>
  static SE2Element<T> tau_with_rate(const VecT<T, 3>& xi, const VecT<T, 3>& eta,
                                     VecT<T, 3>& rate) {
    const T x = xi[0] * xi[0];
    const auto c = ExpCoefficients<T>::at(x);
    rate = left_inverse(xi, c.cotc, eta);
    return moved(xi, x, c.sinc, T(xi[0] * c.cosc));
  }
  /// [[1, 0], [omega cotc v - J v/2, gamma I + omega J/2]] eta.
  template <class T>
  static VecT<T, 3> dtau_left_inverse(const VecT<T, 3>& xi, const VecT<T, 3>& eta) {
    return left_inverse(xi, cotc(T(xi[0] * xi[0])), eta);
  }
  using ExpDefaults<SE2>::dtau_left_inverse;
  /// omega in (-pi, pi), v = (gamma I - omega J/2) p with gamma = (omega/2) cot(omega/2).
  template <class T>
  static VecT<T, 3> tau_inverse(const SE2Element<T>& g) {
    const T t = half_angle_tangent(g.rotation.c, g.rotation.s, "se2 exp^-1");
    const T ratio = atanc(T(t * t));  // (omega/2)/tan(omega/2) is the same number
    const T half = ratio * t;
    const VecT<T, 2>& p = g.translation;
    return {2.0 * half, ratio * p[0] + half * p[1], ratio * p[1] - half * p[0]};
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right(const VecT<T, 3>& xi) {
    const T zero(0.0), x = xi[0] * xi[0], a = sinc(x), c = cosc(x), b = xi[0] * c,
                       e = xi[0] * sinc3(x);
    MatT<T, 3, 3> m;
    m << T(1.0), zero, zero, c * xi[2] + e * xi[1], a, -b, e * xi[2] - c * xi[1], b, a;
    return m;
  }
  /// [[1, 0], [J v/2 + omega cotc v, gamma I - omega J/2]].
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse(const VecT<T, 3>& xi) {
    const T zero(0.0), c = cotc(T(xi[0] * xi[0])), b = xi[0] * c, gamma = 1.0 - xi[0] * b,
                       half = 0.5 * xi[0];
    MatT<T, 3, 3> m;
    m << T(1.0), zero, zero, b * xi[1] - 0.5 * xi[2], gamma, half, 0.5 * xi[1] + b * xi[2], -half,
        gamma;
    return m;
  }
  template <class T>
  static VecT<T, 3> dtau_right_inverse_transpose(const VecT<T, 3>& xi, const VecT<T, 3>& p) {
    const T c = cotc(T(xi[0] * xi[0])), b = xi[0] * c, gamma = 1.0 - xi[0] * b, half = 0.5 * xi[0];
    return {p[0] + xi[1] * (b * p[1] + 0.5 * p[2]) + xi[2] * (b * p[2] - 0.5 * p[1]),
            gamma * p[1] - half * p[2], half * p[1] + gamma * p[2]};
  }
  /// The parts of that without and with J.
  template <class T>
  static void end_momenta(const VecT<T, 3>& xi, const VecT<T, 3>& p, VecT<T, 3>& even,
                          VecT<T, 3>& odd) {
    const T b = xi[0] * cotc(T(xi[0] * xi[0])), gamma = 1.0 - xi[0] * b, half = 0.5 * xi[0];
    even = {p[0] + b * (xi[1] * p[1] + xi[2] * p[2]), gamma * p[1], gamma * p[2]};
    odd = {0.5 * (xi[1] * p[2] - xi[2] * p[1]), -half * p[2], half * p[1]};
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse_transpose_derivative(const VecT<T, 3>& xi,
                                                               const VecT<T, 3>& p) {
    const T zero(0.0), x = xi[0] * xi[0], c = cotc(x), d = 2.0 * x * cotc_derivative(x),
                       b = xi[0] * c, e = -xi[0] * (2.0 * c + d);  // e = d gamma/d omega
    MatT<T, 3, 3> m;
    m << (c + d) * (p[1] * xi[1] + p[2] * xi[2]), b * p[1] + 0.5 * p[2], b * p[2] - 0.5 * p[1],  //
        e * p[1] - 0.5 * p[2], zero, zero,                                                       //
        e * p[2] + 0.5 * p[1], zero, zero;
    return m;
  }
  template <class T>
  static bool in_domain(const VecT<T, 3>& xi) {
    return xi[0] * xi[0] < pi_squared && all_finite(xi);
  }

 private:
  // a = sinc, b = omega cosc.
  template <class T>
  static SE2Element<T> moved(const VecT<T, 3>& xi, const T& x, const T& a, const T& b) {
    SE2Element<T> g;
    if (x < detail::minimax_end) [[likely]] {
      g.rotation = {1.0 - xi[0] * b, xi[0] * a, 0};
    } else {
      g.rotation = SO2::from_angle(xi[0]);
    }
    g.translation = VecT<T, 2>(a * xi[1] - b * xi[2], b * xi[1] + a * xi[2]);
    return g;
  }
  template <class T>
  static VecT<T, 3> left_inverse(const VecT<T, 3>& xi, const T& c, const VecT<T, 3>& eta) {
    const T b = xi[0] * c, gamma = 1.0 - xi[0] * b, half = 0.5 * xi[0];
    return {eta[0], (b * xi[1] + 0.5 * xi[2]) * eta[0] + gamma * eta[1] - half * eta[2],
            (b * xi[2] - 0.5 * xi[1]) * eta[0] + half * eta[1] + gamma * eta[2]};
  }
};

// Compiled once, geometries.cpp: for the registry, and for joints.
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<Rn<1>>>();
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SO2>>();
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SO3>>();
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SE2>>();
template <>
std::shared_ptr<const Geometry> erased_geometry<Exp<SE3>>();

}  // namespace hamel
