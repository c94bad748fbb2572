// exp on SE(3), SO(3) over the dual numbers: the formulas are in groups/exp.hpp.
#pragma once

#include <hamel/groups/exp_so3.hpp>
#include <hamel/groups/se3.hpp>
#include <string>

namespace hamel {

template <>
struct Exp<SE3> : ExpDefaults<SE3> {
  /// (exp omega, v + cosc omega x v + sinc3 omega x (omega x v)).
  template <class T>
  static SE3Element<T> tau(const VecT<T, 6>& xi) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>();
    const T x = omega.dot(omega);
    return moved(omega, v, sinc(x), cosc(x), sinc3(x));
  }
  /// tau(xi), and dL_xi^-1 eta in `rate`.
  template <class T>
  static SE3Element<T> tau_with_rate(const VecT<T, 6>& xi, const VecT<T, 6>& eta,
                                     VecT<T, 6>& rate) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>();
    const T x = omega.dot(omega);
    const auto c = ExpCoefficients<T>::at(x);
    rate = left_inverse(omega, v, x, c.cotc, c.cotc_derivative, eta);
    return moved(omega, v, c.sinc, c.cosc, c.sinc3);
  }
  /// (P a, P b + dP a), eta = (a, b), P = I + W/2 + cotc W^2 and dP its derivative along v.
  template <class T>
  static VecT<T, 6> dtau_left_inverse(const VecT<T, 6>& xi, const VecT<T, 6>& eta) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>();
    const T x = omega.dot(omega);
    return left_inverse(omega, v, x, cotc(x), cotc_derivative(x), eta);
  }
  using ExpDefaults<SE3>::dtau_left_inverse;
  /// (P m + dP f, P f), p = (m, f).
  template <class T>
  static VecT<T, 6> dtau_right_inverse_transpose(const VecT<T, 6>& xi, const VecT<T, 6>& p) {
    VecT<T, 6> even, odd;
    end_momenta(xi, p, even, odd);
    return even + odd;
  }
  /// The parts of that, without and with W/2 and V/2.
  template <class T>
  static void end_momenta(const VecT<T, 6>& xi, const VecT<T, 6>& p, VecT<T, 6>& even,
                          VecT<T, 6>& odd) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>(),
                     m = p.template head<3>(), f = p.template tail<3>(), w = 0.5 * omega;
    const T x = omega.dot(omega);
    const auto [turn, move] = even_part(omega, v, x, cotc(x), cotc_derivative(x), f, m);
    even << move, turn;
    odd << w.cross(m) + 0.5 * v.cross(f), w.cross(f);
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
  // With sinc, cosc, sinc3.
  template <class T>
  static SE3Element<T> moved(const VecT<T, 3>& omega, const VecT<T, 3>& v, const T& a, const T& b,
                             const T& c) {
    const VecT<T, 3> wv = omega.cross(v);
    return {rotation_polynomial(omega, a, b), v + b * wv + c * omega.cross(wv)};
  }
  // With cotc and its derivative dc: (a + c W^2 a, b + c W^2 b + d(c W^2) a), W^2 a =
  // omega (omega.a) - x a, and d its derivative along v.
  template <class T>
  struct EvenPart {
    VecT<T, 3> turn, move;
  };
  template <class T>
  static EvenPart<T> even_part(const VecT<T, 3>& omega, const VecT<T, 3>& v, const T& x, const T& c,
                               const T& dc, const VecT<T, 3>& a, const VecT<T, 3>& b) {
    const T wa = omega.dot(a), wv = omega.dot(v), wb = omega.dot(b) + v.dot(a), d = 2.0 * dc * wv;
    const T near = 1.0 - c * x, far = 2.0 * c * wv + d * x;
    return {c * wa * omega + near * a,
            (c * wb + d * wa) * omega + (c * wa) * v + near * b - far * a};
  }
  template <class T>
  static VecT<T, 6> left_inverse(const VecT<T, 3>& omega, const VecT<T, 3>& v, const T& x,
                                 const T& c, const T& dc, const VecT<T, 6>& eta) {
    const VecT<T, 3> a = eta.template head<3>(), b = eta.template tail<3>(), w = 0.5 * omega;
    const auto [turn, move] = even_part(omega, v, x, c, dc, a, b);
    VecT<T, 6> out;
    out << turn + w.cross(a), move + w.cross(b) + 0.5 * v.cross(a);
    return out;
  }
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
