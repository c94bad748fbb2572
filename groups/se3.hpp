// SE(3): motions of space.
//
// Element: rotation R (3 x 3, body to space) and translation p in space coordinates.
// Algebra: (omega, v), angular first, in body coordinates, 6 numbers. Dual: (moment m, force f).
//   (R, p)(R', p')     = (R R', p + R p')
//   (R, p)^-1          = (R^T, -R^T p)
//   Ad_(R,p)           = [[R, 0], [p^ R, R]]
//   ad_(omega,v)       = [[omega^, 0], [v^, omega^]]
//   Ad_(R,p)^T (m, f)  = (R^T (m - p x f), R^T f)
//   K(m, f)            = [[m^, f^], [f^, 0]]             K(mu) eta = (ad_eta)^T mu
// Matrix: homogeneous, 4 x 4.
// Source: Murray, Li, Sastry, A Mathematical Introduction to Robotic Manipulation, ch. 2.
#pragma once

#include <algorithm>

#include <Eigen/LU>
#include <hamel/framework/lie/coordinates.hpp>
#include <hamel/framework/lie/group_info.hpp>
#include <hamel/framework/lie/types.hpp>
#include <hamel/groups/retractions.hpp>
#include <hamel/groups/so3.hpp>
#include <span>
#include <string>
#include <vector>

namespace hamel {

template <class T>
struct SE3Element {
  MatT<T, 3, 3> rotation = MatT<T, 3, 3>::Identity();
  VecT<T, 3> translation = VecT<T, 3>::Zero();

  bool operator==(const SE3Element&) const = default;
};

struct SE3 {
  static constexpr int dim = 6;
  template <class T>
  using Element = SE3Element<T>;
  using Retractions = TypeList<Exp<SE3>, Cayley<SE3>, SecondKind<SE3>, SecondKindSymmetric<SE3>>;

  static std::string name() { return "se3"; }
  static std::string formula() { return "(R, x): a point p goes to R p + x"; }
  static std::string source() {
    return "Murray, Li, Sastry, A Mathematical Introduction to Robotic Manipulation (1994), ch. 2";
  }

  template <class T = double>
  static Element<T> identity() {
    return {};
  }
  template <class T>
  static Element<T> compose(const SE3Element<T>& g, const SE3Element<T>& h) {
    return {g.rotation.lazyProduct(h.rotation),
            g.translation + g.rotation.lazyProduct(h.translation)};
  }
  /// (R, p) with its derivative along (omega, v), (R hat(omega), R v), as dual numbers.
  template <class Dual>
  static Element<Dual> along(const SE3Element<double>& g, const Vec<6>& xi) {
    Element<Dual> out{SO3::along<Dual>(g.rotation, xi.head<3>()), {}};
    const Vec<3> rate = g.rotation.lazyProduct(xi.tail<3>());
    for (int i = 0; i < 3; ++i) {
      out.translation[i].a = g.translation[i];
      out.translation[i].v[0] = rate[i];
    }
    return out;
  }
  /// (R^T, -R^T p).
  template <class T>
  static Element<T> inverse(const SE3Element<T>& g) {
    return {g.rotation.transpose(), -(g.rotation.transpose().lazyProduct(g.translation))};
  }
  /// g over another scalar, its derivatives zero.
  template <class T>
  static Element<T> constant(const SE3Element<double>& g) {
    return {g.rotation.template cast<T>(), g.translation.template cast<T>()};
  }
  template <class T>
  static MatT<T, 6, 6> Ad(const SE3Element<T>& g) {
    return block(g.rotation, MatT<T, 3, 3>(cross_matrix(g.translation).lazyProduct(g.rotation)));
  }
  template <class T>
  static MatT<T, 6, 6> ad(const VecT<T, 6>& xi) {
    return block(cross_matrix(VecT<T, 3>(xi.template head<3>())),
                 cross_matrix(VecT<T, 3>(xi.template tail<3>())));
  }
  template <class T>
  static VecT<T, 6> Ad_transpose(const SE3Element<T>& g, const VecT<T, 6>& mu) {
    const VecT<T, 3> force = mu.template tail<3>();
    const VecT<T, 3> moment = mu.template head<3>() - g.translation.cross(force);
    VecT<T, 6> r;
    r.template head<3>() = g.rotation.transpose().lazyProduct(moment);
    r.template tail<3>() = g.rotation.transpose().lazyProduct(force);
    return r;
  }
  template <class T>
  static MatT<T, 6, 6> coad(const VecT<T, 6>& mu) {
    const MatT<T, 3, 3> force = cross_matrix(VecT<T, 3>(mu.template tail<3>()));
    MatT<T, 6, 6> m;
    m.template topLeftCorner<3, 3>() = cross_matrix(VecT<T, 3>(mu.template head<3>()));
    m.template topRightCorner<3, 3>() = force;
    m.template bottomLeftCorner<3, 3>() = force;
    m.template bottomRightCorner<3, 3>().setZero();
    return m;
  }
  /// (ad_xi)^T mu.
  template <class T>
  static VecT<T, 6> ad_transpose(const VecT<T, 6>& xi, const VecT<T, 6>& mu) {
    const VecT<T, 3> omega = xi.template head<3>(), v = xi.template tail<3>(),
                     m = mu.template head<3>(), f = mu.template tail<3>();
    VecT<T, 6> out;
    out << m.cross(omega) + f.cross(v), f.cross(omega);
    return out;
  }
  template <class T>
  static Element<T> normalise(const SE3Element<T>& g) {
    return {SO3::normalise(g.rotation), g.translation};
  }
  template <class T>
  static T defect(const SE3Element<T>& g) {
    return SO3::defect(g.rotation);
  }
  static double rotation_angle(const SE3Element<double>& g) {
    return SO3::rotation_angle(g.rotation);
  }

  /// [[R, p], [0, 1]].
  template <class T>
  static MatT<T, 4, 4> matrix(const SE3Element<T>& g) {
    MatT<T, 4, 4> m = MatT<T, 4, 4>::Identity();
    m.template topLeftCorner<3, 3>() = g.rotation;
    m.template topRightCorner<3, 1>() = g.translation;
    return m;
  }
  /// (omega, v) -> [[omega^, v], [0, 0]].
  template <class T>
  static MatT<T, 4, 4> hat(const VecT<T, 6>& xi) {
    MatT<T, 4, 4> m = MatT<T, 4, 4>::Zero();
    m.template topLeftCorner<3, 3>() = cross_matrix(VecT<T, 3>(xi.template head<3>()));
    m.template topRightCorner<3, 1>() = xi.template tail<3>();
    return m;
  }
  template <class T>
  static VecT<T, 6> vee(const MatT<T, 4, 4>& m) {
    VecT<T, 6> xi;
    xi.template head<3>() = SO3::vee(MatT<T, 3, 3>(m.template topLeftCorner<3, 3>()));
    xi.template tail<3>() = m.template topRightCorner<3, 1>();
    return xi;
  }

  static std::vector<std::string> columns();
  static std::vector<std::string> units();
  static std::vector<Component> components();
  /// R' = R hat(omega), (x, y, z)' = R v.
  static void coordinate_rates(std::span<const double> x, std::span<const double> xi,
                               std::span<double> out);
  static void add_pulled_back(std::span<const double> x, std::span<const double> slope,
                              std::span<double> out);
  template <class T>
  static Coordinates<T, 12> coordinates(const SE3Element<T>& g) {
    const auto rotation = SO3::coordinates(g.rotation);
    Coordinates<T, 12> values;
    std::copy_n(g.translation.data(), 3,
                std::copy(rotation.begin(), rotation.end(), values.begin()));
    return values;
  }
  /// R row by row, then x, y, z. Throws std::invalid_argument.
  static Element<double> from_coordinates(std::span<const double> values);
  /// The element nearest to values whose rotation is off by less than about 0.3.
  static Element<double> nearest(std::span<const double> values);

  /// m^-T u for a matrix of the shape of dR: block lower triangular.
  template <class T>
  static VecT<T, 6> solve_transposed(const MatT<T, 6, 6>& m, const VecT<T, 6>& u) {
    const MatT<T, 3, 3> a = m.template topLeftCorner<3, 3>(),
                        b = m.template bottomLeftCorner<3, 3>(),
                        c = m.template bottomRightCorner<3, 3>();
    const VecT<T, 3> lower = c.inverse().transpose() * u.template tail<3>();
    VecT<T, 6> out;
    out << a.inverse().transpose() * VecT<T, 3>(u.template head<3>() - b.transpose() * lower),
        lower;
    return out;
  }

  /// [[a, 0], [b, a]]: the shape of Ad, of ad and of every function of ad.
  template <class T>
  static MatT<T, 6, 6> block(const MatT<T, 3, 3>& a, const MatT<T, 3, 3>& b) {
    MatT<T, 6, 6> m;
    m.template topLeftCorner<3, 3>() = a;
    m.template topRightCorner<3, 3>().setZero();
    m.template bottomLeftCorner<3, 3>() = b;
    m.template bottomRightCorner<3, 3>() = a;
    return m;
  }
};

template <>
GroupInfo group_info<SE3>();

}  // namespace hamel
