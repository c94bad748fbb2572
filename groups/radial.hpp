// Radial retractions of SO(3): tau(omega) = exp(f(theta) n), omega = theta n.
// (M34) of framework/schemes/README.md.
//
// With f(theta) = theta phi(x), x = theta^2, phi smooth, phi(0) = 1 and W = omega^, nothing cancels
// at 0:
//   tau    = I + phi sinc(f^2) W + phi^2 cosc(f^2) W^2
//   dL     = f' n n^T + (sin f/theta)(I - n n^T) - ((1 - cos f)/theta) n^
//   dR^-1  = alpha I - W/2 + beta omega omega^T
//   alpha  = (theta/2) cot(f/2) = (1 - f^2 cotc(f^2))/phi
//   beta   = (1/f' - alpha)/x = phi cotc(f^2) - 2 phi'/(phi f')
//   f'     = phi + 2 x phi'                                   phi' by x, f' by theta
// Members: exp, phi = 1; Cayley, phi = (2/theta) atan(theta/2); polar, phi = atan(theta)/theta.
// polar is the orthogonal polar factor of I + W and algebraic in r = sqrt(1 + x):
//   tau    = I + W/r + W^2/(r (r + 1))
//   alpha  = (r + 1)/2
//   beta   = (2 r + 1)/(2 (r + 1))
// Source: P. Tsiotras, J. Junkins, H. Schaub, Higher-order Cayley transforms (1997); the
// derivatives above.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/groups/dexp.hpp>
#include <hamel/groups/retractions.hpp>
#include <hamel/groups/rotation.hpp>
#include <hamel/groups/so3.hpp>

namespace hamel {

/// phi(x) = f(theta)/theta and its first two derivatives by x = theta^2.
template <class T>
struct RadialProfile {
  T phi, dphi, d2phi;
};

/// tau = I + a W + b W^2.
template <class T>
struct RadialRotation {
  T a, b;
};

/// dR^-1 = alpha I - W/2 + beta omega omega^T, and the derivatives by x.
template <class T>
struct RadialInverse {
  T alpha, beta, dalpha, dbeta;
};

/// CRTP base of a radial retraction. Derived gives name() and
///   template <class T> static RadialProfile<T> profile(const T& x);
///   template <class T> static T radius(const T& f);  theta of an angle f in [0, pi): the inverse
/// and may give `rotation_coefficients` and `inverse_coefficients` themselves.
template <class Derived>
struct RadialSO3 : RetractionDefaults<Derived, SO3> {
  static constexpr bool symmetric = true;
  static constexpr bool commuting = true;  // rotations about one axis

  static std::string formula() { return "tau(omega) = exp(f(|omega|) omega/|omega|)"; }
  static std::string source() {
    return "Tsiotras, Junkins, Schaub, Higher-order Cayley transforms (1997)";
  }

  template <class T>
  static RadialRotation<T> rotation_coefficients(const T& x) {
    const T phi = Derived::profile(x).phi, y = x * phi * phi;
    return {phi * sinc(y), phi * phi * cosc(y)};
  }
  template <class T>
  static RadialInverse<T> inverse_coefficients(const T& x) {
    const RadialProfile<T> p = Derived::profile(x);
    const T y = x * p.phi * p.phi, c = cotc(y), dc = cotc_derivative(y), gamma = 1.0 - y * c;
    const T slope = p.phi + 2.0 * x * p.dphi;            // f'
    const T dslope = 3.0 * p.dphi + 2.0 * x * p.d2phi;   // by x
    const T dy = p.phi * slope, dgamma = -(c + y * dc);  // by x, by y
    const T q = 1.0 / (p.phi * slope);
    RadialInverse<T> r;
    r.alpha = gamma / p.phi;
    r.beta = p.phi * c - 2.0 * p.dphi * q;
    r.dalpha = (dgamma * dy - gamma * p.dphi / p.phi) / p.phi;
    r.dbeta = p.dphi * c + p.phi * dc * dy - 2.0 * p.d2phi * q +
              2.0 * p.dphi * (p.dphi * slope + p.phi * dslope) * q * q;
    return r;
  }

  template <class T>
  static MatT<T, 3, 3> tau(const VecT<T, 3>& xi) {
    const RadialRotation<T> k = Derived::rotation_coefficients(T(xi.dot(xi)));
    return rotation_polynomial(xi, k.a, k.b);
  }
  /// Throws DomainError at a rotation by pi, and wherever Derived::radius does.
  template <class T>
  static VecT<T, 3> tau_inverse(const MatT<T, 3, 3>& g) {
    using std::sqrt;
    const VecT<T, 3> t = gibbs_vector(g, Derived::name());
    const T square = t.dot(t);
    if (square < 1e-200) return 2.0 * t;
    const T size = sqrt(square);
    return t * (Derived::radius(T(2.0 * size * atanc(square))) / size);
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse(const VecT<T, 3>& xi) {
    const RadialInverse<T> k = Derived::inverse_coefficients(T(xi.dot(xi)));
    const VecT<T, 3> half = 0.5 * xi;
    MatT<T, 3, 3> m = (k.beta * xi) * xi.transpose() - cross_matrix(half);
    m.diagonal().array() += k.alpha;
    return m;
  }
  /// d/domega of alpha p + omega x p/2 + beta (omega.p) omega.
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse_transpose_derivative(const VecT<T, 3>& xi,
                                                               const VecT<T, 3>& p) {
    const RadialInverse<T> k = Derived::inverse_coefficients(T(xi.dot(xi)));
    const T xp = xi.dot(p);
    const VecT<T, 3> half = 0.5 * p;
    MatT<T, 3, 3> m = (2.0 * k.dalpha * p + (2.0 * k.dbeta * xp) * xi) * xi.transpose();
    m += (k.beta * xi) * p.transpose() - cross_matrix(half);
    m.diagonal().array() += k.beta * xp;
    return m;
  }
};

template <>
struct Polar<SO3> : RadialSO3<Polar<SO3>> {
  static std::string name() { return "polar"; }
  static std::string formula() {
    return "tau(omega) = (I + omega^) ((I + omega^)^T (I + omega^))^(-1/2), by atan|omega|";
  }

  template <class T>
  static RadialRotation<T> rotation_coefficients(const T& x) {
    using std::sqrt;
    const T r = sqrt(T(1.0 + x));
    return {1.0 / r, 1.0 / (r * (r + 1.0))};
  }
  template <class T>
  static RadialInverse<T> inverse_coefficients(const T& x) {
    using std::sqrt;
    const T r = sqrt(T(1.0 + x)), q = 1.0 / (r + 1.0), s = 0.25 / r;  // dr/dx = 2 s
    return {0.5 * (r + 1.0), (r + 0.5) * q, s, s * q * q};
  }
  /// sin f/cos f n. Throws DomainError at rotations by pi/2 and more.
  template <class T>
  static VecT<T, 3> tau_inverse(const MatT<T, 3, 3>& g) {
    const VecT<T, 3> sine = SO3::vee(g);
    const T cosine = 0.5 * (g(0, 0) + g(1, 1) + g(2, 2) - 1.0);
    if (!(cosine > 1e-12)) {
      throw DomainError("so3 polar^-1: rotation by " + angle_text(sine, cosine) +
                        " rad, expected less than pi/2");
    }
    return sine / cosine;
  }

 private:
  template <class T>
  static std::string angle_text(const VecT<T, 3>& sine, const T& cosine) {
    if constexpr (std::is_arithmetic_v<T>) {
      return to_text(std::atan2(sine.norm(), cosine));
    } else {
      return "pi/2 or more";
    }
  }
};

}  // namespace hamel
