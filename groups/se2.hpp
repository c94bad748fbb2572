// SE(2): motions of the plane.
//
// Element: rotation R (with an unwrapped angle, groups/so2.hpp) and translation p in space
// coordinates. Algebra: (omega, v1, v2), angular first, in body coordinates. With J = [[0, -1], [1,
// 0]]:
//   (R, p)(R', p')              = (R R', p + R p')
//   (R, p)^-1                   = (R^T, -R^T p)
//   Ad_(R,p) (omega, v)         = (omega, R v - omega J p)
//   [(omega, v), (omega', v')]  = (0, omega J v' - omega' J v)
// Matrix: homogeneous, 3 x 3.
// Source: Murray, Li, Sastry, A Mathematical Introduction to Robotic Manipulation, ch. 2.
#pragma once

#include <cmath>
#include <hamel/framework/lie/coordinates.hpp>
#include <hamel/framework/lie/types.hpp>
#include <hamel/groups/retractions.hpp>
#include <hamel/groups/so2.hpp>
#include <span>
#include <string>
#include <vector>

namespace hamel {

template <class T>
struct SE2Element {
  // Aligned as a number is, so that no byte of an element is unused: elements are compared, and
  // written to files, as bytes (Packing).
  using Translation = Eigen::Matrix<T, 2, 1, Eigen::DontAlign>;

  SO2Element<T> rotation;
  Translation translation = Translation::Zero();

  bool operator==(const SE2Element&) const = default;

  /// The unwrapped angle [rad].
  T angle() const { return rotation.angle(); }
};

struct SE2 {
  static constexpr int dim = 3;
  template <class T>
  using Element = SE2Element<T>;
  using Retractions = TypeList<Exp<SE2>, Cayley<SE2>, SecondKind<SE2>, SecondKindSymmetric<SE2>>;

  static std::string name() { return "se2"; }
  static std::string formula() {
    return "(theta, x, y): a point p of the plane goes to R(theta) p + (x, y)";
  }
  static std::string source() {
    return "Murray, Li, Sastry, A Mathematical Introduction to Robotic Manipulation (1994), ch. 2";
  }

  template <class T = double>
  static Element<T> identity() {
    return {};
  }
  template <class T>
  static Element<T> compose(const SE2Element<T>& g, const SE2Element<T>& h) {
    return {SO2::compose(g.rotation, h.rotation), g.translation + g.rotation.rotate(h.translation)};
  }
  /// (R, p) with its derivative along (omega, v), as dual numbers.
  template <class Dual>
  static Element<Dual> along(const SE2Element<double>& g, const Vec<3>& xi) {
    Element<Dual> out{SO2::along<Dual>(g.rotation, xi.head<1>()), {}};
    const Vec<2> rate = g.rotation.rotate(xi.tail<2>());
    for (int i = 0; i < 2; ++i) {
      out.translation[i].a = g.translation[i];
      out.translation[i].v[0] = rate[i];
    }
    return out;
  }
  /// (R^T, -R^T p).
  template <class T>
  static Element<T> inverse(const SE2Element<T>& g) {
    return {SO2::inverse(g.rotation), -g.rotation.rotate_back(g.translation)};
  }
  /// g over another scalar, its derivatives zero.
  template <class T>
  static Element<T> constant(const SE2Element<double>& g) {
    return {SO2::constant<T>(g.rotation), g.translation.template cast<T>()};
  }
  template <class T>
  static MatT<T, 3, 3> Ad(const SE2Element<T>& g) {
    const T zero(0.0), &c = g.rotation.c, &s = g.rotation.s;
    MatT<T, 3, 3> m;
    m << T(1.0), zero, zero, g.translation[1], c, -s, -g.translation[0], s, c;
    return m;
  }
  template <class T>
  static MatT<T, 3, 3> ad(const VecT<T, 3>& xi) {
    const T zero(0.0);
    MatT<T, 3, 3> m;
    m << zero, zero, zero, xi[2], zero, -xi[0], -xi[1], xi[0], zero;
    return m;
  }
  template <class T>
  static VecT<T, 3> Ad_transpose(const SE2Element<T>& g, const VecT<T, 3>& mu) {
    const T &c = g.rotation.c, &s = g.rotation.s;
    return {mu[0] + g.translation[1] * mu[1] - g.translation[0] * mu[2], c * mu[1] + s * mu[2],
            c * mu[2] - s * mu[1]};
  }
  template <class T>
  static MatT<T, 3, 3> coad(const VecT<T, 3>& mu) {
    const T zero(0.0);
    MatT<T, 3, 3> m;
    m << zero, -mu[2], mu[1], mu[2], zero, zero, -mu[1], zero, zero;
    return m;
  }
  template <class T>
  static Element<T> normalise(const SE2Element<T>& g) {
    return {SO2::normalise(g.rotation), g.translation};
  }
  template <class T>
  static T defect(const SE2Element<T>& g) {
    return SO2::defect(g.rotation);
  }
  static double rotation_angle(const SE2Element<double>& g) {
    return SO2::rotation_angle(g.rotation);
  }

  /// [[R, p], [0, 1]].
  template <class T>
  static MatT<T, 3, 3> matrix(const SE2Element<T>& g) {
    MatT<T, 3, 3> m = MatT<T, 3, 3>::Identity();
    m.template topLeftCorner<2, 2>() = g.rotation.matrix();
    m.template topRightCorner<2, 1>() = g.translation;
    return m;
  }
  /// (omega, v) -> [[omega J, v], [0, 0]].
  template <class T>
  static MatT<T, 3, 3> hat(const VecT<T, 3>& xi) {
    const T zero(0.0);
    MatT<T, 3, 3> m;
    m << zero, -xi[0], xi[1], xi[0], zero, xi[2], zero, zero, zero;
    return m;
  }
  template <class T>
  static VecT<T, 3> vee(const MatT<T, 3, 3>& m) {
    return {0.5 * (m(1, 0) - m(0, 1)), m(0, 2), m(1, 2)};
  }

  static std::vector<std::string> columns() { return {"theta", "x", "y"}; }
  static std::vector<std::string> units() { return {"rad", "m", "m"}; }
  static std::vector<Component> components() {
    return {{"omega", "rad/s"}, {"v1", "m/s"}, {"v2", "m/s"}};
  }
  /// theta' = omega, (x, y)' = R v.
  static void coordinate_rates(std::span<const double> x, std::span<const double> xi,
                               std::span<double> out) {
    const double c = std::cos(x[0]), s = std::sin(x[0]);
    out[0] = xi[0];
    out[1] = c * xi[1] - s * xi[2];
    out[2] = s * xi[1] + c * xi[2];
  }
  static void add_pulled_back(std::span<const double> x, std::span<const double> slope,
                              std::span<double> out) {
    const double c = std::cos(x[0]), s = std::sin(x[0]);
    out[0] += slope[0];
    out[1] += c * slope[1] + s * slope[2];
    out[2] += c * slope[2] - s * slope[1];
  }
  template <class T>
  static Coordinates<T, 3> coordinates(const SE2Element<T>& g) {
    return {g.angle(), g.translation[0], g.translation[1]};
  }
  /// theta [rad], x, y. Throws std::invalid_argument.
  static Element<double> from_coordinates(std::span<const double> values) {
    check_coordinates<SE2>(values);
    return {SO2::from_coordinates(values.first(1)), {values[1], values[2]}};
  }
  static Element<double> nearest(std::span<const double> values) {
    return {SO2::nearest(values), {values[1], values[2]}};
  }
};

}  // namespace hamel
