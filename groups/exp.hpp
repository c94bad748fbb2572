// exp, the exponential map, on R^n, SO(2), SO(3), SE(2) and SE(3). (M32) of
// framework/schemes/README.md.
//
// Coefficients sinc, cosc, sinc3, cotc of groups/dexp.hpp at x = |omega|^2; W = omega^; t the Gibbs
// vector.
//   SO(3)    exp omega  = I + sinc W + cosc W^2
//            log R      = 2 atan|t| t/|t|
//            dR         = I + cosc W + sinc3 W^2
//            dR^-1      = I - W/2 + cotc W^2
//            N(omega, p) = d/domega [(dR^-1)^T p]
//                        = -p^/2 + cotc (omega.p I + omega p^T - 2 p omega^T) + 2 cotc' (W^2 p)
//                        omega^T
//   SE(2)    exp xi     = (exp omega, (sinc I + omega cosc J) v)
//            dR^-1      = I - ad/2 + cotc ad^2
//   SE(3)    exp xi     = (exp omega, dR_omega v)       dR_omega that of SO(3)
//            dR^-1      = [[P, 0], [dP, P]]             P(omega) that of SO(3), dP its derivative
//            along v
// The SE(3) blocks are the SO(3) formulas over the dual numbers omega + eps v, eps^2 = 0.
// exp is symmetric, exp(-xi) = exp(xi)^-1, and one-parameter, exp(s xi) exp(t xi) = exp((s + t)
// xi). Source: Iserles, Munthe-Kaas, Nørsett, Zanna, Lie-group methods (2000), appendix B.
#pragma once

#include <cmath>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/groups/dexp.hpp>
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

/// Common base of the exponential maps.
template <class G>
struct ExpDefaults : RetractionDefaults<Exp<G>, G> {
  static constexpr bool symmetric = true;
  static constexpr bool one_parameter = true;
  static std::string name() { return "exp"; }
  static std::string domain() { return "|omega| < pi"; }
  static std::string formula() { return "tau(xi) = exp(xi) = I + xi^ + xi^2/2 + ..."; }

 protected:
  static constexpr double pi_squared = std::numbers::pi * std::numbers::pi;
};

/// The identity map with derivative the identity: any retraction of R^n.
template <class Derived, class G>
struct IdentityRetraction : RetractionDefaults<Derived, G> {
  static constexpr int N = G::dim;
  static constexpr bool symmetric = true;
  static constexpr bool one_parameter = true;
  static std::string formula() { return "tau(x) = x"; }
  template <class T>
  static VecT<T, N> tau(const VecT<T, N>& xi) {
    return xi;
  }
  template <class T>
  static VecT<T, N> tau_inverse(const VecT<T, N>& g) {
    return g;
  }
  template <class T>
  static MatT<T, N, N> dtau_right(const VecT<T, N>&) {
    return MatT<T, N, N>::Identity();
  }
  template <class T>
  static MatT<T, N, N> dtau_right_inverse(const VecT<T, N>&) {
    return MatT<T, N, N>::Identity();
  }
  template <class T>
  static MatT<T, N, N> dtau_right_inverse_transpose_derivative(const VecT<T, N>&,
                                                               const VecT<T, N>&) {
    return MatT<T, N, N>::Zero();
  }
};

template <int N>
struct Exp<Rn<N>> : IdentityRetraction<Exp<Rn<N>>, Rn<N>> {
  static std::string name() { return "exp"; }
};

/// theta, the unwrapped angle: angles add, so that any retraction of SO(2) is this one
/// (groups/README.md).
template <class Derived>
struct AddedAngle : RetractionDefaults<Derived, SO2> {
  static constexpr bool symmetric = true;
  static constexpr bool one_parameter = true;
  static std::string formula() { return "tau(omega) = the rotation by omega, turns counted"; }

  template <class T>
  static SO2Element<T> tau(const VecT<T, 1>& xi) {
    const T x = xi[0] * xi[0];
    if (x < detail::short_series) [[likely]] {
      return {1.0 - x * cosc(x), xi[0] * sinc(x), 0};
    }
    return SO2::from_angle(xi[0]);
  }
  /// The angle with its turns.
  template <class T>
  static VecT<T, 1> tau_inverse(const SO2Element<T>& g) {
    return VecT<T, 1>(g.angle());
  }
  template <class T>
  static MatT<T, 1, 1> dtau_right(const VecT<T, 1>&) {
    return MatT<T, 1, 1>::Ones();
  }
  template <class T>
  static MatT<T, 1, 1> dtau_right_inverse(const VecT<T, 1>&) {
    return MatT<T, 1, 1>::Ones();
  }
  template <class T>
  static MatT<T, 1, 1> dtau_right_inverse_transpose_derivative(const VecT<T, 1>&,
                                                               const VecT<T, 1>&) {
    return MatT<T, 1, 1>::Zero();
  }
};

/// The angle in (-pi, pi), turns ignored. Throws DomainError at pi.
template <class T>
T principal_angle(const SO2Element<T>& g, const std::string_view map) {
  const T t = half_angle_tangent(g.c, g.s, map);
  return 2.0 * atanc(T(t * t)) * t;
}

template <>
struct Exp<SO2> : AddedAngle<Exp<SO2>> {
  static std::string name() { return "exp"; }
};

template <>
struct Exp<SO3> : ExpDefaults<SO3> {
  /// dR^-1 = 1 - ad/2 + cotc(x) ad^2 (framework/schemes/hamel_form.hpp).
  static double quadratic_weight(double x) { return cotc(x); }
  static double angle_squared(const Vec<3>& xi) { return xi.dot(xi); }
  template <class T>
  static MatT<T, 3, 3> tau(const VecT<T, 3>& xi) {
    const T x = xi.dot(xi);
    return rotation_polynomial(xi, sinc(x), cosc(x));
  }
  /// The logarithm, |omega| < pi. Throws DomainError at pi.
  template <class T>
  static VecT<T, 3> tau_inverse(const MatT<T, 3, 3>& g) {
    const VecT<T, 3> t = gibbs_vector(g, "so3 exp^-1");
    return t * (2.0 * atanc(T(t.dot(t))));
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right(const VecT<T, 3>& xi) {
    const T x = xi.dot(xi);
    return rotation_polynomial(xi, cosc(x), sinc3(x));
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse(const VecT<T, 3>& xi) {
    return rotation_polynomial(xi, T(-0.5), cotc(T(xi.dot(xi))));
  }
  /// p + omega x p/2 + cotc omega x (omega x p).
  template <class T>
  static VecT<T, 3> dtau_right_inverse_transpose(const VecT<T, 3>& xi, const VecT<T, 3>& p) {
    const T x = xi.dot(xi), c = cotc(x), a = c * xi.dot(p), b = 1.0 - c * x;
    const VecT<T, 3> h = 0.5 * xi;
    return {b * p[0] + h[1] * p[2] - h[2] * p[1] + a * xi[0],
            b * p[1] + h[2] * p[0] - h[0] * p[2] + a * xi[1],
            b * p[2] + h[0] * p[1] - h[1] * p[0] + a * xi[2]};
  }
  /// N(xi, p) of the heading of this file.
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse_transpose_derivative(const VecT<T, 3>& xi,
                                                               const VecT<T, 3>& p) {
    const T x = xi.dot(xi), xp = xi.dot(p), c = cotc(x), d = 2.0 * cotc_derivative(x);
    // c (xi.p) I + c xi p^T + [d (W^2 p) - 2 c p] xi^T - p^/2 by columns, W^2 p = xi (xi.p) - x p.
    const VecT<T, 3> left = (d * xp) * xi - (d * x + 2.0 * c) * p;
    const VecT<T, 3> cp = c * p;
    const T diagonal = c * xp;
    MatT<T, 3, 3> m;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) m(i, j) = xi[i] * cp[j] + left[i] * xi[j];
      m(j, j) += diagonal;
    }
    const VecT<T, 3> half = 0.5 * p;
    m(0, 1) += half[2], m(1, 0) -= half[2];
    m(2, 0) += half[1], m(0, 2) -= half[1];
    m(1, 2) += half[0], m(2, 1) -= half[0];
    return m;
  }
  template <class T>
  static bool in_domain(const VecT<T, 3>& xi) {
    return xi.dot(xi) < pi_squared;
  }
};

template <>
struct Exp<SE2> : ExpDefaults<SE2> {
  /// dR^-1 = 1 - ad/2 + cotc(x) ad^2 (framework/schemes/hamel_form.hpp).
  static double quadratic_weight(double x) { return cotc(x); }
  static double angle_squared(const Vec<3>& xi) { return xi[0] * xi[0]; }
  /// (exp omega, (sinc I + omega cosc J) v).
  template <class T>
  static SE2Element<T> tau(const VecT<T, 3>& xi) {
    const T x = xi[0] * xi[0], a = sinc(x), b = xi[0] * cosc(x);
    SE2Element<T> g;
    if (x < detail::short_series) [[likely]] {
      g.rotation = {1.0 - xi[0] * b, xi[0] * a, 0};
    } else {
      g.rotation = SO2::from_angle(xi[0]);
    }
    g.translation = VecT<T, 2>(a * xi[1] - b * xi[2], b * xi[1] + a * xi[2]);
    return g;
  }
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
};

template <>
struct Exp<SE3> : ExpDefaults<SE3> {
  /// (exp omega, v + cosc omega x v + sinc3 omega x (omega x v)).
  template <class T>
  static SE3Element<T> tau(const VecT<T, 6>& xi) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>();
    const T x = omega.dot(omega), b = cosc(x);
    const VecT<T, 3> wv = omega.cross(v);
    return {rotation_polynomial(omega, sinc(x), b), v + b * wv + sinc3(x) * omega.cross(wv)};
  }
  template <class T>
  static VecT<T, 6> tau_inverse(const SE3Element<T>& g) {
    const VecT<T, 3> t = gibbs_vector(g.rotation, "se3 exp^-1");
    const VecT<T, 3> omega = t * (2.0 * atanc(T(t.dot(t))));
    const VecT<T, 3> wp = omega.cross(g.translation);
    VecT<T, 6> xi;
    xi.template head<3>() = omega;
    xi.template tail<3>() = g.translation - 0.5 * wp + cotc(T(omega.dot(omega))) * omega.cross(wp);
    return xi;
  }
  template <class T>
  static MatT<T, 6, 6> dtau_right(const VecT<T, 6>& xi) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>();
    const T x = omega.dot(omega);
    return dual(omega, v, cosc(x), sinc3(x), cosc_derivative(x), sinc3_derivative(x));
  }
  template <class T>
  static MatT<T, 6, 6> dtau_right_inverse(const VecT<T, 6>& xi) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>();
    const T x = omega.dot(omega);
    return dual(omega, v, T(-0.5), cotc(x), T(0.0), cotc_derivative(x));
  }
  /// [[N(omega, m) + M, N(omega, f)], [N(omega, f), 0]] with M = d/domega [N(omega, f) v].
  template <class T>
  static MatT<T, 6, 6> dtau_right_inverse_transpose_derivative(const VecT<T, 6>& xi,
                                                               const VecT<T, 6>& p) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>();
    const VecT<T, 3> m = p.template head<3>(), f = p.template tail<3>();
    const T x = omega.dot(omega), wv = omega.dot(v), wf = omega.dot(f), vf = v.dot(f);
    const T c = cotc(x), d = 2.0 * cotc_derivative(x), e = 4.0 * cotc_second_derivative(x);
    const VecT<T, 3> q = omega * vf + v * wf - (2.0 * wv) * f;  // d(W^2 f) along v
    const VecT<T, 3> r = omega * wf - x * f;                    // W^2 f
    const MatT<T, 3, 3> by_force = Exp<SO3>::dtau_right_inverse_transpose_derivative(omega, f);
    MatT<T, 3, 3> top = Exp<SO3>::dtau_right_inverse_transpose_derivative(omega, m);
    top += (d * q + (e * wv) * r - (2.0 * d * wv) * f) * omega.transpose();
    top += (d * r - (2.0 * c) * f) * v.transpose();
    top += (c * v + (d * wv) * omega) * f.transpose();
    top.diagonal().array() += c * vf + d * wv * wf;
    MatT<T, 6, 6> result;
    result.template topLeftCorner<3, 3>() = top;
    result.template topRightCorner<3, 3>() = by_force;
    result.template bottomLeftCorner<3, 3>() = by_force;
    result.template bottomRightCorner<3, 3>().setZero();
    return result;
  }
  template <class T>
  static bool in_domain(const VecT<T, 6>& xi) {
    return xi.template head<3>().squaredNorm() < pi_squared && all_finite(xi);
  }

 private:
  /// I + a W + b W^2 at W = (omega + eps v)^, with da, db the derivatives of a and b by x.
  template <class T>
  static MatT<T, 6, 6> dual(const VecT<T, 3>& omega, const VecT<T, 3>& v, const T& a, const T& b,
                            const T& da, const T& db) {
    const T twice = 2.0 * omega.dot(v), x = omega.dot(omega);
    const VecT<T, 3> slope = b * v + (0.5 * twice * db) * omega;
    const VecT<T, 3> turn = a * v + (twice * da) * omega;
    MatT<T, 3, 3> lower = slope * omega.transpose() + omega * slope.transpose();
    lower.diagonal().array() -= twice * b + twice * db * x;
    lower += cross_matrix(turn);
    return SE3::block(rotation_polynomial(omega, a, b), lower);
  }
};

}  // namespace hamel
