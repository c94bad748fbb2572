// A geometry as functions of Eigen's vectors, for the laws; an element is its packed numbers. Not
// installed.
#pragma once

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SVD>

#include <hamel/framework/check/laws.hpp>
#include <hamel/framework/lie/geometry.hpp>

namespace hamel::check {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// The operations of a geometry as functions of Eigen's vectors; an element is its packed numbers.
struct Algebra {
  const Geometry& geometry;
  int n = geometry.dim();

  Vector element() const { return Vector::Zero(geometry.size()); }
  Vector identity() const { return tau(Vector::Zero(n)); }
  Vector compose(const Vector& g, const Vector& h) const {
    Vector out = element();
    geometry.compose(g.data(), h.data(), out.data());
    return out;
  }
  Vector inverse(const Vector& g) const {
    Vector out = element();
    geometry.inverse(g.data(), out.data());
    return out;
  }
  Vector normalise(Vector g) const {
    geometry.normalise(g.data());
    return g;
  }
  Vector tau(const Vector& xi) const {
    Vector out = element();
    geometry.tau(xi.data(), out.data());
    return out;
  }
  /// NaN outside the range of tau.
  Vector tau_inverse(const Vector& g) const {
    Vector xi(n);
    return geometry.tau_inverse(g.data(), xi.data())
               ? xi
               : Vector(Vector::Constant(n, std::numeric_limits<double>::quiet_NaN()));
  }
  /// NaN where there is none.
  Vector recover_step(const Vector& delta, double s) const {
    Vector xi(n);
    return geometry.recover_step(delta.data(), s, xi.data())
               ? xi
               : Vector(Vector::Constant(n, std::numeric_limits<double>::quiet_NaN()));
  }
  Vector coordinates(const Vector& g) const {
    Vector q(geometry.columns());
    geometry.coordinates(g.data(), q.data());
    return q;
  }
  Vector from_coordinates(const std::vector<double>& values) const {
    Vector g = element();
    geometry.from_coordinates(values, g.data());
    return g;
  }
  bool refuses(const std::vector<double>& values) const {
    try {
      from_coordinates(values);
    } catch (const std::invalid_argument&) {
      return true;
    }
    return false;
  }
  template <class Function>
  Matrix columns(Function&& column) const {
    Matrix m(n, n);
    for (int j = 0; j < n; ++j) m.col(j) = column(Vector(Vector::Unit(n, j)));
    return m;
  }
  Matrix Ad(const Vector& g) const {
    return columns([&](const Vector& eta) -> Vector {
      Vector out(n);
      geometry.Ad(g.data(), eta.data(), out.data());
      return out;
    });
  }
  Matrix Ad_transpose(const Vector& g) const {
    return columns([&](const Vector& mu) -> Vector {
      Vector out(n);
      geometry.Ad_transpose(g.data(), mu.data(), out.data());
      return out;
    });
  }
  Matrix ad(const Vector& xi) const {
    return columns([&](const Vector& mu) -> Vector {
             Vector out(n);
             geometry.ad_transpose(xi.data(), mu.data(), out.data());
             return out;
           })
        .transpose();
  }
  Matrix dtau_right(const Vector& xi) const {
    Matrix m(n, n);
    geometry.dtau_right(xi.data(), m.data());
    return m;
  }
  Matrix dtau_left_inverse(const Vector& xi) const {
    return columns([&](const Vector& eta) -> Vector {
      Vector out(n);
      geometry.dtau_left_inverse(xi.data(), eta.data(), out.data());
      return out;
    });
  }
  bool in_domain(const Vector& xi) const { return geometry.in_domain(xi.data()); }

  /// |q(g^-1 h) - q(e)|: how far apart two elements are.
  double distance(const Vector& g, const Vector& h) const {
    return (coordinates(compose(inverse(g), h)) - coordinates(identity())).norm();
  }
  /// Growth of round-off by products with g and g^-1: |Ad(g)| |Ad(g^-1)|/n, 1 of a rotation.
  double growth(const Vector& g) const {
    return std::max(1.0, Ad(g).norm() * Ad(inverse(g)).norm() / n);
  }
  bool abelian() const {
    for (int i = 0; i < n; ++i) {
      if (ad(Vector::Unit(n, i)).norm() > 0) return false;
    }
    return true;
  }
  /// Column j: derivative along e_j of the coordinates of curve(t e_j).
  template <class Curve>
  Matrix slopes(Curve&& curve) const {
    Matrix m(geometry.columns(), n);
    for (int j = 0; j < n; ++j) {
      m.col(j) = derivative(
          [&](double t) -> Vector { return coordinates(curve(Vector(t * Vector::Unit(n, j)))); });
    }
    return m;
  }
  /// Is xi recovered from tau(xi)?
  bool reaches(const Vector& xi) const {
    try {
      return tau_inverse(tau(xi)).allFinite();
    } catch (const DomainError&) {
      return false;
    }
  }
  /// How far along the direction the predicate holds, at most 3.
  template <class Predicate>
  double reach(const Vector& direction, Predicate&& holds) const {
    constexpr double limit = 3;
    if (holds(Vector(limit * direction))) return limit;
    double inside = 0, outside = limit;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + outside);
      (holds(Vector(middle * direction)) ? inside : outside) = middle;
    }
    return inside;
  }
  /// The change of xi, in units of round-off, that the coordinates of tau(xi) do not show. An entry
  /// of 1e-12 resolves 1e-12 of round-off, one of 1 + 1e-12 resolves 1: with q(tau(xi + d)) = q + J
  /// d and each entry known to |q| (at least |xi|), it is the norm of the pseudo-inverse of J/|q|.
  double resolution(const Vector& xi) const {
    const Vector size = coordinates(tau(xi)).cwiseAbs().cwiseMax(xi.norm());
    const Matrix j = slopes([&](const Vector& d) { return tau(xi + d); });
    const Vector values =
        Eigen::JacobiSVD<Matrix>(size.cwiseInverse().asDiagonal() * j).singularValues();
    return values.cwiseInverse().norm();
  }
};

/// d/dd of tau(xi + d) taken back to e on the right or left, in the algebra: dR or dL, by
/// differences.
class NumericalDerivative {
 public:
  explicit NumericalDerivative(const Geometry& geometry) : geometry_(geometry) {
    const Algebra on{geometry_};
    chart_ = on.slopes([&](const Vector& d) { return on.tau(d); });
  }
  Matrix right(const Vector& xi) const {
    const Algebra on{geometry_};
    const Vector back = on.inverse(on.tau(xi));
    return in_algebra(on.slopes([&](const Vector& d) { return on.compose(on.tau(xi + d), back); }));
  }
  Matrix left(const Vector& xi) const {
    const Algebra on{geometry_};
    const Vector back = on.inverse(on.tau(xi));
    return in_algebra(on.slopes([&](const Vector& d) { return on.compose(back, on.tau(xi + d)); }));
  }

 private:
  Matrix in_algebra(const Matrix& slopes) const {
    const Matrix normal = chart_.transpose() * chart_;
    return normal.inverse() * (chart_.transpose() * slopes);
  }
  const Geometry& geometry_;
  Matrix chart_;  // the slope at e: tau'(0) = id makes it the coordinates of the algebra
};

}  // namespace hamel::check
