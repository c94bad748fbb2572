// exp on SO(3): the formulas are in groups/exp.hpp.
#pragma once

#include <cmath>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/groups/dexp.hpp>
#include <hamel/groups/retractions.hpp>
#include <hamel/groups/rotation.hpp>
#include <hamel/groups/so3.hpp>
#include <numbers>
#include <string>

namespace hamel {

/// Common base of the exponential maps.
template <class G>
struct ExpDefaults : RetractionDefaults<Exp<G>, G> {
  static constexpr bool symmetric = true;
  static constexpr bool one_parameter = true;
  static std::string name() { return "exp"; }
  static std::string domain() { return "|omega| < pi"; }
  static std::string formula() { return "tau(xi) = exp(xi) = I + xi^ + xi^2/2 + ..."; }
  static std::string source() {
    return "Iserles, Munthe-Kaas, Norsett, Zanna, Lie-group methods (2000), appendix B";
  }

 protected:
  static constexpr double pi_squared = std::numbers::pi * std::numbers::pi;
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
    const T x = xi.dot(xi);
    return inverse_transpose(xi, x, cotc(x), p);
  }
  /// even = p + cotc omega x (omega x p), odd = omega x p/2.
  template <class T>
  static void end_momenta(const VecT<T, 3>& xi, const VecT<T, 3>& p, VecT<T, 3>& even,
                          VecT<T, 3>& odd) {
    const T x = xi.dot(xi), c = cotc(x), a = c * xi.dot(p), b = 1.0 - c * x;
    const VecT<T, 3> h = 0.5 * xi;
    even = b * p + a * xi;
    odd = h.cross(p);
  }
  /// eta + omega x eta/2 + cotc omega x (omega x eta): dL is the transpose of dR.
  template <class T>
  static VecT<T, 3> dtau_left_inverse(const VecT<T, 3>& xi, const VecT<T, 3>& eta) {
    return dtau_right_inverse_transpose(xi, eta);
  }
  using ExpDefaults<SO3>::dtau_left_inverse;
  /// tau(xi), and dL_xi^-1 eta in `rate`.
  template <class T>
  static MatT<T, 3, 3> tau_with_rate(const VecT<T, 3>& xi, const VecT<T, 3>& eta,
                                     VecT<T, 3>& rate) {
    const T x = xi.dot(xi);
    const auto c = ExpCoefficients<T>::at(x);
    rate = inverse_transpose(xi, x, c.cotc, eta);
    return rotation_polynomial(xi, c.sinc, c.cosc);
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

 private:
  template <class T>
  static VecT<T, 3> inverse_transpose(const VecT<T, 3>& xi, const T& x, const T& c,
                                      const VecT<T, 3>& p) {
    const T a = c * xi.dot(p), b = 1.0 - c * x;
    const VecT<T, 3> h = 0.5 * xi;
    return {b * p[0] + h[1] * p[2] - h[2] * p[1] + a * xi[0],
            b * p[1] + h[2] * p[0] - h[0] * p[2] + a * xi[1],
            b * p[2] + h[0] * p[1] - h[1] * p[0] + a * xi[2]};
  }
};

}  // namespace hamel
