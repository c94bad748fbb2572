// A retraction from tau alone: every derivative by automatic differentiation (ceres::Jet).
//
// From `name`, `symmetric` and a templated `tau` follow the inverse, dR, dL and the Newton
// derivative:
//   struct MyMap : hamel::AutoRetraction<MyMap, hamel::SO3> {
//     static std::string name() { return "my_map"; }
//     static constexpr bool symmetric = true;
//     template <class T> static hamel::MatT<T, 3, 3> tau(const hamel::VecT<T, 3>& xi) { ... }
//   };
// With q the coordinates of an element near e (G::coordinates, templated) and J = d q(tau(d))/dd at
// d = 0:
//   dR_xi    = J^+ d/dd q(tau(xi + d) tau(xi)^-1)
//   tau^-1   : xi += dL_xi^-1 J^+ (q(tau(xi)^-1 g) - q(e)),  Newton's method on the group
// ceres::Jet does not nest (no double * Jet<Jet>); d/dxi[dR^-T p], which only steers Newton, is
// therefore a difference quotient of the exact dR^-1. Cost: one to two orders of magnitude above a
// closed form. This header alone includes <ceres/jet.h>.
#pragma once

#include <string>
#include <vector>

#include <ceres/jet.h>
#include <hamel/framework/lie/linear_solve.hpp>

#include <hamel/framework/lie/concepts.hpp>
#include <hamel/framework/lie/retraction_defaults.hpp>
#include <hamel/framework/lie/types.hpp>

namespace hamel {

template <class Derived, class G>
struct AutoRetraction : RetractionDefaults<Derived, G> {
  static constexpr int dim = G::dim;

  static std::string formula() { return "tau(xi), derivatives by automatic differentiation"; }

  /// J^+ d/dd q(tau(xi + d) tau(xi)^-1).
  static Mat<dim, dim> dtau_right(const Vec<dim>& xi) {
    const auto fixed = Derived::tau(constant(xi));
    return in_algebra(G::coordinates(G::compose(Derived::tau(seed(xi)), G::inverse(fixed))));
  }
  /// J^+ d/dd q(tau(xi)^-1 tau(xi + d)).
  static Mat<dim, dim> dtau_left(const Vec<dim>& xi) {
    const auto fixed = Derived::tau(constant(xi));
    return in_algebra(G::coordinates(G::compose(G::inverse(fixed), Derived::tau(seed(xi)))));
  }
  static Mat<dim, dim> dtau_right_inverse(const Vec<dim>& xi) { return inverse_of(dtau_right(xi)); }
  static Mat<dim, dim> dtau_left_inverse(const Vec<dim>& xi) { return inverse_of(dtau_left(xi)); }
  /// d/dxi[dR^-T p]: central differences of order 6 of the exact dR^-1, step 1e-3, error about
  /// 1e-12.
  static Mat<dim, dim> dtau_right_inverse_transpose_derivative(const Vec<dim>& xi,
                                                               const Vec<dim>& p) {
    constexpr double step = 1e-3;
    constexpr double weights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
    Mat<dim, dim> m = Mat<dim, dim>::Zero();
    for (int j = 0; j < dim; ++j) {
      for (int k = 1; k <= 3; ++k) {
        const Vec<dim> shift = (k * step) * Vec<dim>::Unit(j);
        const Mat<dim, dim> change =
            dtau_right_inverse(Vec<dim>(xi + shift)) - dtau_right_inverse(Vec<dim>(xi - shift));
        m.col(j) += (weights[k - 1] / step) * (change.transpose() * p);
      }
    }
    return m;
  }

  /// Newton from xi = 0, steps at most 1 long. Throws DomainError when 100 steps do not reach
  /// round-off.
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
  using Jet = ceres::Jet<double, dim>;

  static VecT<Jet, dim> constant(const Vec<dim>& xi) { return xi.template cast<Jet>(); }
  static VecT<Jet, dim> seed(const Vec<dim>& xi) {
    VecT<Jet, dim> jets;
    for (int i = 0; i < dim; ++i) jets[i] = Jet(xi[i], i);
    return jets;
  }
  /// Row k: the gradient of coordinate k.
  static Mat<Eigen::Dynamic, dim> slopes(const std::vector<Jet>& q) {
    Mat<Eigen::Dynamic, dim> m(static_cast<Eigen::Index>(q.size()), dim);
    for (std::size_t k = 0; k < q.size(); ++k) m.row(static_cast<Eigen::Index>(k)) = q[k].v;
    return m;
  }
  /// J^+ = (J^T J)^-1 J^T, computed once.
  static const Mat<dim, Eigen::Dynamic>& pseudo_inverse() {
    static const Mat<dim, Eigen::Dynamic> result = [] {
      const Mat<Eigen::Dynamic, dim> j =
          slopes(G::coordinates(Derived::tau(seed(Vec<dim>::Zero()))));
      const Mat<dim, dim> normal = j.transpose() * j;
      return Mat<dim, Eigen::Dynamic>(normal.inverse() * j.transpose());
    }();
    return result;
  }
  static Mat<dim, dim> in_algebra(const std::vector<Jet>& q) {
    return pseudo_inverse() * slopes(q);
  }
};

}  // namespace hamel
