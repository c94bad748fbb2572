// Cayley on SE(3): the formulas are in groups/cayley.hpp.
#pragma once

#include <hamel/groups/cayley_so3.hpp>
#include <hamel/groups/se3.hpp>

namespace hamel {

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
  /// omega = k w, v = k u + c k^2 (w.u) w of y = (w, u): xi^^2 moves what is normal to omega alone.
  static Vec<6> recover_step(const SE3Element<double>& delta, double s) {
    const Vec<6> y = tau_inverse(delta);
    const Vec<3> w = y.head<3>(), u = y.tail<3>();
    const double k = step_scale(w.dot(w), s);
    Vec<6> xi;
    xi << k * w, k * u + (0.25 * s * (1 - s) * k * k * w.dot(u)) * w;
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

}  // namespace hamel
