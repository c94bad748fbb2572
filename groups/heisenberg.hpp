// The Heisenberg group: R^3 with a bracket.
//
//   (x, y, z)(a, b, c) = (x + a, y + b, z + c + (x b - y a)/2)
//   [e1, e2] = e3, all other brackets zero
// In these coordinates exp(xi) = xi. The Cayley map of the strictly upper triangular 3 x 3 matrices
// is the same map: (I - X/2)^-1 (I + X/2) = I + X + X^2/2 where X^3 = 0.
//   dR_xi = I + ad_xi/2,   dR_xi^-1 = I - ad_xi/2
// Source: Bloch, Nonholonomic Mechanics and Control (2003), section 1.8.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <hamel/framework/lie/group_defaults.hpp>
#include <hamel/groups/retractions.hpp>

namespace hamel {

struct Heisenberg : GroupDefaults<Heisenberg, 3> {
  template <class T>
  using Element = VecT<T, 3>;
  using Retractions = TypeList<Exp<Heisenberg>, Cayley<Heisenberg>>;

  static std::string name() { return "heisenberg"; }
  static std::string source() {
    return "Bloch, Nonholonomic Mechanics and Control (2003), section 1.8";
  }
  static std::string summary() { return "R3 with a bracket [e1, e2] = e3"; }
  template <class T = double>
  static Element<T> identity() {
    return Element<T>::Zero();
  }
  template <class T>
  static Element<T> compose(const VecT<T, 3>& g, const VecT<T, 3>& h) {
    Element<T> out = g + h;
    out[2] += 0.5 * (g[0] * h[1] - g[1] * h[0]);
    return out;
  }
  template <class T>
  static Element<T> inverse(const VecT<T, 3>& g) {
    return -g;
  }
  template <class T>
  static MatT<T, 3, 3> Ad(const VecT<T, 3>& g) {
    MatT<T, 3, 3> m = MatT<T, 3, 3>::Identity();
    m(2, 0) = -g[1];
    m(2, 1) = g[0];
    return m;
  }
  template <class T>
  static MatT<T, 3, 3> ad(const VecT<T, 3>& xi) {
    MatT<T, 3, 3> m = MatT<T, 3, 3>::Zero();
    m(2, 0) = -xi[1];
    m(2, 1) = xi[0];
    return m;
  }

  static std::vector<std::string> units() { return {"m", "m", "m"}; }
  static std::vector<Component> components() {
    return {{"x1'", "m/s", "x'"}, {"x2'", "m/s", "y'"}, {"xi3", "m/s", "z'"}};
  }
  /// z' = xi3 + (x xi2 - y xi1)/2.
  static void coordinate_rates(std::span<const double> x, std::span<const double> xi,
                               std::span<double> out) {
    out[0] = xi[0];
    out[1] = xi[1];
    out[2] = xi[2] + 0.5 * (x[0] * xi[1] - x[1] * xi[0]);
  }
  static void add_pulled_back(std::span<const double> x, std::span<const double> slope,
                              std::span<double> out) {
    out[0] += slope[0] - 0.5 * x[1] * slope[2];
    out[1] += slope[1] + 0.5 * x[0] * slope[2];
    out[2] += slope[2];
  }
};

namespace detail {

// The common base of exp and Cayley.
template <class Derived>
struct HeisenbergMap : RetractionDefaults<Derived, Heisenberg> {
  static constexpr bool symmetric = true;
  static constexpr bool one_parameter = true;
  template <class T>
  static VecT<T, 3> tau(const VecT<T, 3>& xi) {
    return xi;
  }
  template <class T>
  static VecT<T, 3> tau_inverse(const VecT<T, 3>& g) {
    return g;
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right(const VecT<T, 3>& xi) {
    return MatT<T, 3, 3>::Identity() + T(0.5) * Heisenberg::ad(xi);
  }
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse(const VecT<T, 3>& xi) {
    return MatT<T, 3, 3>::Identity() - T(0.5) * Heisenberg::ad(xi);
  }
  /// dR^-T p = p - ad_xi^T p/2.
  template <class T>
  static MatT<T, 3, 3> dtau_right_inverse_transpose_derivative(const VecT<T, 3>&,
                                                               const VecT<T, 3>& p) {
    return T(-0.5) * Heisenberg::coad(p);
  }
  static std::string formula() { return "tau(xi) = xi"; }
};

}  // namespace detail

template <>
struct Exp<Heisenberg> : detail::HeisenbergMap<Exp<Heisenberg>> {
  static std::string name() { return "exp"; }
};
template <>
struct Cayley<Heisenberg> : detail::HeisenbergMap<Cayley<Heisenberg>> {
  static std::string name() { return "cayley"; }
};

}  // namespace hamel
