// A retraction from tau alone: every derivative by automatic differentiation (ceres::Jet).
//
// Give `name`, `symmetric` and a templated `tau`; receive the inverse, dR, dL and the Newton derivative:
//   struct MyMap : hamel::AutoRetraction<MyMap, hamel::SO3> {
//     static std::string name() { return "my_map"; }
//     static constexpr bool symmetric = true;
//     template <class T> static hamel::MatT<T, 3, 3> tau(const hamel::VecT<T, 3>& xi) { ... }
//   };
// With q the coordinates of an element near e (G::coordinates, templated) and J = d q(tau(d))/dd at d = 0,
// dR_xi = J^+ d/dd q(tau(xi + d) tau(xi)^-1); d/dxi[dR^-T p] = -dR^-T d/dxi[dR^T y], y = dR^-T p, by a
// Jet of Jets. tau^-1 is Newton on the group: xi += dL_xi^-1 J^+ (q(tau(xi)^-1 g) - q(e)).
// Cost: one to two orders of magnitude above a closed form. Alone in including <ceres/jet.h>.
#pragma once

#include <string>
#include <vector>

#include <ceres/jet.h>
#include <Eigen/LU>

#include <hamel/framework/concepts.hpp>
#include <hamel/framework/retraction_defaults.hpp>
#include <hamel/framework/types.hpp>

namespace hamel {

template <class Derived, class G>
struct AutoRetraction : RetractionDefaults<Derived, G> {
  static constexpr int dim = G::dim;
  template <class T>
  using Square = MatT<T, dim, dim>;
  template <class T>
  using Vector = VecT<T, dim>;

  static std::string formula() { return "tau(xi), derivatives by automatic differentiation"; }

  /// J^+ d/dd q(tau(xi + d) tau(xi)^-1).
  template <class T>
  static Square<T> dtau_right(const Vector<T>& xi) {
    const auto moving = Derived::tau(seed(xi));
    const auto fixed = Derived::tau(constant(xi));
    return in_algebra<T>(slopes<T>(G::coordinates(G::compose(moving, G::inverse(fixed)))));
  }
  /// J^+ d/dd q(tau(xi)^-1 tau(xi + d)).
  template <class T>
  static Square<T> dtau_left(const Vector<T>& xi) {
    const auto moving = Derived::tau(seed(xi));
    const auto fixed = Derived::tau(constant(xi));
    return in_algebra<T>(slopes<T>(G::coordinates(G::compose(G::inverse(fixed), moving))));
  }
  template <class T>
  static Square<T> dtau_right_inverse(const Vector<T>& xi) {
    const Square<T> forward = dtau_right(xi);
    return forward.inverse();
  }
  template <class T>
  static Square<T> dtau_left_inverse(const Vector<T>& xi) {
    const Square<T> forward = dtau_left(xi);
    return forward.inverse();
  }
  /// -dR^-T d/dxi[dR^T y], y = dR^-T p.
  static Mat<dim, dim> dtau_right_inverse_transpose_derivative(const Vec<dim>& xi,
                                                               const Vec<dim>& p) {
    const auto forward = dtau_right(seed(xi));  // entries: value and gradient
    Mat<dim, dim> value;
    for (int i = 0; i < dim; ++i) {
      for (int j = 0; j < dim; ++j) value(i, j) = forward(i, j).a;
    }
    const Mat<dim, dim> back = value.inverse().transpose();
    const Vec<dim> y = back * p;
    Mat<dim, dim> s = Mat<dim, dim>::Zero();  // row i: gradient of (dR^T y)_i
    for (int i = 0; i < dim; ++i) {
      for (int j = 0; j < dim; ++j) s.row(i) += y[j] * forward(j, i).v.transpose();
    }
    return -(back * s);
  }

  /// Newton from xi = 0, steps at most 1 long. Throws DomainError when 100 steps do not reach round-off.
  static Vec<dim> tau_inverse(const typename G::template Element<double>& g) {
    const std::vector<double> start = G::coordinates(G::template identity<double>());
    Vec<dim> xi = Vec<dim>::Zero();
    double last = 1e300;
    for (int i = 0; i < 100; ++i) {
      const std::vector<double> here = G::coordinates(G::compose(G::inverse(Derived::tau(xi)), g));
      Eigen::VectorXd difference(static_cast<Eigen::Index>(here.size()));
      for (std::size_t k = 0; k < here.size(); ++k) {
        difference[static_cast<Eigen::Index>(k)] = here[k] - start[k];
      }
      Vec<dim> change = dtau_left_inverse(xi) * Vec<dim>(pseudo_inverse() * difference);
      const double size = change.norm();
      if (!(size < 1e12)) break;
      if (size > 1.0) change /= size;
      xi += change;
      // Quadratic until round-off, and no smaller after: then the step no longer shrinks.
      if (size <= 1e-8 * (1.0 + xi.norm()) && size >= 0.5 * last) return xi;
      if (size == 0.0) return xi;
      last = size;
    }
    throw DomainError(
        std::string(Derived::name()) +
        "^-1: Newton on the group does not converge, expected an element of tau's range");
  }

 private:
  template <class T>
  using Jet = ceres::Jet<T, dim>;

  template <class T>
  static Vector<Jet<T>> seed(const Vector<T>& xi) {
    Vector<Jet<T>> jets = constant(xi);
    for (int i = 0; i < dim; ++i) jets[i].v[i] = T(1.0);
    return jets;
  }
  template <class T>
  static Vector<Jet<T>> constant(const Vector<T>& xi) {
    Vector<Jet<T>> jets;
    for (int i = 0; i < dim; ++i) {
      jets[i].a = xi[i];
      for (int j = 0; j < dim; ++j) jets[i].v[j] = T(0.0);
    }
    return jets;
  }
  /// Row k: the gradient of coordinate k.
  template <class T>
  static MatT<T, Eigen::Dynamic, dim> slopes(const std::vector<Jet<T>>& q) {
    MatT<T, Eigen::Dynamic, dim> m(static_cast<Eigen::Index>(q.size()), dim);
    for (std::size_t k = 0; k < q.size(); ++k) {
      for (int j = 0; j < dim; ++j) m(static_cast<Eigen::Index>(k), j) = q[k].v[j];
    }
    return m;
  }
  /// J^+ = (J^T J)^-1 J^T, computed once.
  static const Eigen::MatrixXd& pseudo_inverse() {
    static const Eigen::MatrixXd result = [] {
      const Vec<dim> zero = Vec<dim>::Zero();
      const Eigen::MatrixXd j = slopes<double>(G::coordinates(Derived::tau(seed(zero))));
      const Mat<dim, dim> normal = j.transpose() * j;
      return Eigen::MatrixXd(normal.inverse() * j.transpose());
    }();
    return result;
  }
  template <class T>
  static Square<T> in_algebra(const MatT<T, Eigen::Dynamic, dim>& slopes_of_q) {
    const Eigen::MatrixXd& j = pseudo_inverse();
    Square<T> m;
    for (int r = 0; r < dim; ++r) {
      for (int c = 0; c < dim; ++c) {
        T sum(0.0);
        for (Eigen::Index k = 0; k < j.cols(); ++k) sum = sum + slopes_of_q(k, c) * j(r, k);
        m(r, c) = sum;
      }
    }
    return m;
  }
};

}  // namespace hamel
