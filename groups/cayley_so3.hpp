// Cayley on SO(3), and what the Cayley maps share: the formulas are in groups/cayley.hpp.
#pragma once

#include <cmath>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/groups/retractions.hpp>
#include <hamel/groups/rotation.hpp>
#include <hamel/groups/so3.hpp>
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
  /// xi with tau_s(xi) = delta. Functions of one matrix commute, tau_s(xi) = tau(s xi) tau((1-s)
  /// xi) = tau(y) with y^ = xi^ (1 + c xi^^2)^-1, c = s (1-s)/4. Where xi^^3 = -|omega|^2 xi^ this
  /// is a quadratic equation for |omega|: xi = k y, k = 1 - c |omega|^2.
  static Vec<G::dim> recover_step(const typename G::template Element<double>& delta, double s) {
    const Vec<G::dim> y = Cayley<G>::tau_inverse(delta);
    return step_scale(Cayley<G>::angle_squared(y), s) * y;
  }
  /// k = 2/(1 + sqrt(1 + 4 c |omega of y|^2)).
  static double step_scale(double square, double s) {
    return 2 / (1 + std::sqrt(1 + s * (1 - s) * square));
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

}  // namespace hamel
