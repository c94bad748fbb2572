// SO(3): rotations of space.
//
// Element: the rotation matrix R, 3 x 3, body to space.
// Algebra: the body angular velocity omega, 3 numbers, hat(omega) v = omega x v.
//   Ad_R = R,   ad_omega = hat(omega),   (ad_omega)^T mu = mu x omega
// Source: Murray, Li, Sastry, A Mathematical Introduction to Robotic Manipulation, ch. 2.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <hamel/framework/lie/coordinates.hpp>
#include <hamel/framework/lie/group_info.hpp>
#include <hamel/framework/lie/types.hpp>
#include <hamel/groups/retractions.hpp>
#include <span>
#include <string>
#include <vector>

namespace hamel {

/// hat(v) w = v x w.
template <class T>
MatT<T, 3, 3> cross_matrix(const VecT<T, 3>& v) {
  const T zero(0.0);
  MatT<T, 3, 3> m;
  m << zero, -v[2], v[1], v[2], zero, -v[0], -v[1], v[0], zero;
  return m;
}

struct SO3 {
  static constexpr int dim = 3;
  template <class T>
  using Element = MatT<T, 3, 3>;
  using Retractions =
      TypeList<Exp<SO3>, Cayley<SO3>, Polar<SO3>, SecondKind<SO3>, SecondKindSymmetric<SO3>>;

  static std::string name() { return "so3"; }
  static std::string formula() { return "R in R^(3x3), R^T R = I, det R = 1"; }
  static std::string source() {
    return "Murray, Li, Sastry, A Mathematical Introduction to Robotic Manipulation (1994), ch. 2";
  }

  template <class T = double>
  static Element<T> identity() {
    return Element<T>::Identity();
  }
  template <class T>
  static MatT<T, 3, 3> compose(const MatT<T, 3, 3>& g, const MatT<T, 3, 3>& h) {
    if constexpr (requires { T::width; }) {  // lanes: the order in which Eigen adds those of double
      const auto upper = [&](int i, int j) -> T {
        return g(i, 0) * h(0, j) + g(i, 1) * h(1, j) + g(i, 2) * h(2, j);
      };
      const auto last = [&](int j) -> T {
        return g(2, 0) * h(0, j) + (g(2, 1) * h(1, j) + g(2, 2) * h(2, j));
      };
      MatT<T, 3, 3> out;
      out << upper(0, 0), upper(0, 1), upper(0, 2),  //
          upper(1, 0), upper(1, 1), upper(1, 2),     //
          last(0), last(1), last(2);
      return out;
    } else {
      return g.lazyProduct(h);
    }
  }
  /// R with its derivative along xi, R hat(xi), as dual numbers.
  template <class Dual>
  static MatT<Dual, 3, 3> along(const Mat<3, 3>& g, const Vec<3>& xi) {
    const Mat<3, 3> rate = g.lazyProduct(cross_matrix(xi));
    MatT<Dual, 3, 3> out;
    for (int i = 0; i < 9; ++i) {
      out.data()[i].a = g.data()[i];
      out.data()[i].v[0] = rate.data()[i];
    }
    return out;
  }
  template <class T>
  static MatT<T, 3, 3> inverse(const MatT<T, 3, 3>& g) {
    return g.transpose();
  }
  template <class T>
  static MatT<T, 3, 3> Ad(const MatT<T, 3, 3>& g) {
    return g;
  }
  template <class T>
  static MatT<T, 3, 3> ad(const VecT<T, 3>& xi) {
    return cross_matrix(xi);
  }
  /// R^T mu.
  template <class T>
  static VecT<T, 3> Ad_transpose(const MatT<T, 3, 3>& g, const VecT<T, 3>& mu) {
    return g.transpose().lazyProduct(mu);
  }
  /// hat(mu): (ad_eta)^T mu = mu x eta.
  template <class T>
  static MatT<T, 3, 3> coad(const VecT<T, 3>& mu) {
    return cross_matrix(mu);
  }

  /// R - R (R^T R - I)/2: one Newton step towards the polar factor; squares a small defect.
  template <class T>
  static MatT<T, 3, 3> normalise(const MatT<T, 3, 3>& g) {
    const auto half_dot = [&g](int i, int j) -> T {
      return 0.5 * (g(0, i) * g(0, j) + g(1, i) * g(1, j) + g(2, i) * g(2, j));
    };
    const T d0 = half_dot(0, 0) - 0.5, d1 = half_dot(1, 1) - 0.5, d2 = half_dot(2, 2) - 0.5;
    const T o01 = half_dot(0, 1), o02 = half_dot(0, 2), o12 = half_dot(1, 2);
    MatT<T, 3, 3> r;
    for (int i = 0; i < 3; ++i) {
      r(i, 0) = g(i, 0) - (g(i, 0) * d0 + g(i, 1) * o01 + g(i, 2) * o02);
      r(i, 1) = g(i, 1) - (g(i, 0) * o01 + g(i, 1) * d1 + g(i, 2) * o12);
      r(i, 2) = g(i, 2) - (g(i, 0) * o02 + g(i, 1) * o12 + g(i, 2) * d2);
    }
    return r;
  }
  /// max(|R^T R - I|_F, |det R - 1|).
  template <class T>
  static T defect(const MatT<T, 3, 3>& g) {
    using std::abs;
    using std::sqrt;
    const MatT<T, 3, 3> e = g.transpose() * g - MatT<T, 3, 3>::Identity();
    const T square = e.squaredNorm();
    const T orthogonality = square == 0.0 ? T(0.0) : T(sqrt(square));
    const T volume = abs(g.col(0).dot(g.col(1).cross(g.col(2))) - 1.0);
    return orthogonality < volume ? volume : orthogonality;
  }
  /// How far g turns, in [0, pi]: its axis times 2 sin is the vector of R - R^T, its trace 1 + 2
  /// cos.
  static double rotation_angle(const Mat<3, 3>& g) {
    const double sine = std::hypot(g(2, 1) - g(1, 2), g(0, 2) - g(2, 0), g(1, 0) - g(0, 1));
    return std::atan2(sine, g(0, 0) + (g(1, 1) + g(2, 2)) - 1);
  }

  template <class T>
  static MatT<T, 3, 3> matrix(const MatT<T, 3, 3>& g) {
    return g;
  }
  template <class T>
  static MatT<T, 3, 3> hat(const VecT<T, 3>& xi) {
    return cross_matrix(xi);
  }
  template <class T>
  static VecT<T, 3> vee(const MatT<T, 3, 3>& m) {
    return {0.5 * (m(2, 1) - m(1, 2)), 0.5 * (m(0, 2) - m(2, 0)), 0.5 * (m(1, 0) - m(0, 1))};
  }

  static std::vector<std::string> columns();
  static std::vector<std::string> units();
  static std::vector<Component> components();
  /// R' = R hat(xi).
  static void coordinate_rates(std::span<const double> x, std::span<const double> xi,
                               std::span<double> out);
  static void add_pulled_back(std::span<const double> x, std::span<const double> slope,
                              std::span<double> out);
  /// Row by row.
  template <class T>
  static Coordinates<T, 9> coordinates(const MatT<T, 3, 3>& g) {
    return {g(0, 0), g(0, 1), g(0, 2), g(1, 0), g(1, 1), g(1, 2), g(2, 0), g(2, 1), g(2, 2)};
  }
  /// A rotation to 1e-6, which is then normalised. Throws std::invalid_argument.
  static Element<double> from_coordinates(std::span<const double> values);
  /// The rotation nearest to the first 9 values, row by row, which are off by less than about 0.3.
  static Element<double> nearest(std::span<const double> values);
  /// The rotation in the first 9 values, row by row, if its defect is at most 1e-6 (then normalised
  /// to round-off), else std::invalid_argument in the name of `group`.
  static Element<double> rotation_from(const char* group, std::span<const double> values);
};

template <>
GroupInfo group_info<SO3>();

}  // namespace hamel
