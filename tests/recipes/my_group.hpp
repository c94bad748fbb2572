// Affine maps of the line, z -> e^u z + b, with exp: (u, b)(v, c) = (u + v, b + e^u c). [e1, e2] =
// e2.
#pragma once

#include <cmath>
#include <string>

#include <hamel/framework/lie/group_defaults.hpp>
#include <hamel/groups/retractions.hpp>

namespace hamel {

struct MyGroup : GroupDefaults<MyGroup, 2> {
  template <class T>
  using Element = VecT<T, 2>;
  using Retractions = TypeList<Exp<MyGroup>>;
  static std::string name() { return "my_group"; }
  template <class T = double>
  static VecT<T, 2> identity() {
    return VecT<T, 2>::Zero();
  }
  static Vec<2> compose(const Vec<2>& g, const Vec<2>& h) {
    return {g[0] + h[0], g[1] + std::exp(g[0]) * h[1]};
  }
  static Vec<2> inverse(const Vec<2>& g) { return {-g[0], -std::exp(-g[0]) * g[1]}; }
  static Mat<2, 2> Ad(const Vec<2>& g) { return Mat<2, 2>{{1, 0}, {-g[1], std::exp(g[0])}}; }
  static Mat<2, 2> ad(const Vec<2>& xi) { return Mat<2, 2>{{0, 0}, {-xi[1], xi[0]}}; }
};

/// (x, y f(x)) with f = (e^x - 1)/x, of which dR^-1 = [[1, 0], [a, 1/f]], a = y (f - f')/f = y
/// c(x).
template <>
struct Exp<MyGroup> : RetractionDefaults<Exp<MyGroup>, MyGroup> {
  static constexpr bool symmetric = true, one_parameter = true;
  static std::string name() { return "exp"; }
  static double f(double x) { return std::abs(x) < 1e-8 ? 1 + x / 2 : std::expm1(x) / x; }
  static Vec<2> tau(const Vec<2>& xi) { return {xi[0], xi[1] * f(xi[0])}; }
  static Vec<2> tau_inverse(const Vec<2>& g) { return {g[0], g[1] / f(g[0])}; }
  /// c = 1 - f'/f = 1 + 1/x - 1/(1 - e^-x) = 1/2 - x/12 + x^3/720 - x^5/30240 + ..., and its slope.
  static double c(double x) {
    if (std::abs(x) < 0.05) return 0.5 - x / 12 + x * x * x / 720 - std::pow(x, 5) / 30240;
    return 1 + 1 / x + 1 / std::expm1(-x);
  }
  static double slope_of_c(double x) {
    if (std::abs(x) < 0.05) {
      return -1.0 / 12 + x * x / 240 - std::pow(x, 4) / 6048 + std::pow(x, 6) / 172800;
    }
    const double e = std::expm1(-x);
    return -1 / (x * x) + (1 + e) / (e * e);
  }
  static Mat<2, 2> dtau_right_inverse(const Vec<2>& xi) {
    return Mat<2, 2>{{1, 0}, {xi[1] * c(xi[0]), 1 / f(xi[0])}};
  }
  static Mat<2, 2> dtau_right_inverse_transpose_derivative(const Vec<2>& xi, const Vec<2>& p) {
    // d(1/f)/dx = -(1 - c)/f.
    return p[1] * Mat<2, 2>{{xi[1] * slope_of_c(xi[0]), c(xi[0])}, {-(1 - c(xi[0])) / f(xi[0]), 0}};
  }
};

}  // namespace hamel
