// The laws of a retraction map, measured: `hamel::check_retraction<Cayley<SO3>>(seed)`, also for a
// user's own.
//
// Points: |xi| from 1e-12 to 0.999 of the way to the edge of the domain (or 3 if there is none).
// Bounds: algebraic laws 1e-12, relative to the size of the maps involved (a few 1e-16 are seen);
// comparisons with central differences of order 6, step 4e-3, 1e-9 relative and 1e-10 to 1e-12
// seen, taken no nearer to the edge than 0.7 of the way, where the seventh derivatives are still
// moderate.
#pragma once

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include <hamel/framework/check/group_laws.hpp>
#include <hamel/framework/lie/concepts.hpp>
#include <hamel/framework/lie/types.hpp>

namespace hamel {

namespace check {

/// How far along `direction` the domain reaches, at most `limit`.
template <class R>
double edge(const Vec<R::Group::dim>& direction, double limit = 3) {
  if (R::in_domain(Vec<R::Group::dim>(limit * direction))) return limit;
  double inside = 0, outside = limit;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (inside + outside);
    (R::in_domain(Vec<R::Group::dim>(middle * direction)) ? inside : outside) = middle;
  }
  return inside;
}

/// d/dd of tau(xi + d) taken back to e on the right or left, in the algebra: dR or dL.
template <class R>
class NumericalDerivative {
  using G = typename R::Group;
  static constexpr int n = G::dim;

 public:
  NumericalDerivative() {
    chart_ = slopes([](const Vec<n>& d) { return R::tau(d); });
  }
  Mat<n, n> right(const Vec<n>& xi) const {
    const auto back = G::inverse(R::tau(xi));
    return solve(slopes([&](const Vec<n>& d) { return G::compose(R::tau(Vec<n>(xi + d)), back); }));
  }
  Mat<n, n> left(const Vec<n>& xi) const {
    const auto back = G::inverse(R::tau(xi));
    return solve(slopes([&](const Vec<n>& d) { return G::compose(back, R::tau(Vec<n>(xi + d))); }));
  }

 private:
  /// Column j: derivative of the coordinates along e_j.
  template <class Curve>
  static Eigen::MatrixXd slopes(Curve&& curve) {
    Eigen::MatrixXd m(coordinate_vector<G>(G::template identity<double>()).size(), n);
    for (int j = 0; j < n; ++j) {
      m.col(j) = derivative([&](double t) -> Eigen::VectorXd {
        return coordinate_vector<G>(curve(Vec<n>(t * Vec<n>::Unit(j))));
      });
    }
    return m;
  }
  /// chart^+ m: tau'(0) = id makes the chart's slope at e the coordinates of the algebra.
  Mat<n, n> solve(const Eigen::MatrixXd& m) const {
    const Mat<n, n> normal = chart_.transpose() * chart_;
    return normal.inverse() * (chart_.transpose() * m);
  }
  Eigen::MatrixXd chart_;
};

}  // namespace check

/// Every law of the concept Retraction.
template <Retraction R>
LawReport check_retraction(unsigned long long seed = 1) {
  using G = typename R::Group;
  using check::Largest;
  constexpr int n = G::dim;
  using V = Vec<n>;
  using M = Mat<n, n>;
  std::mt19937_64 random(seed);
  const auto e = G::template identity<double>();
  const M one = M::Identity();
  const V zero = V::Zero();
  const check::NumericalDerivative<R> numerical;
  Largest origin, tangent, right, left, adjoint, inverses, newton, round_trip, domain, nan;
  double symmetry = 0, one_parameter = 0;

  origin(check::distance<G>(R::tau(zero), e));
  origin(R::tau_inverse(e).norm());
  tangent((R::dtau_right(zero) - one).norm());
  tangent((R::dtau_left(zero) - one).norm());
  domain(R::in_domain(zero) ? 0 : 1);
  for (int i = 0; i < n; ++i) {
    nan(R::in_domain(V(std::numeric_limits<double>::quiet_NaN() * V::Unit(i))) ? 1 : 0);
    V bad = zero;
    bad[i] = std::numeric_limits<double>::quiet_NaN();
    nan(R::in_domain(bad) ? 1 : 0);
  }

  for (int sample = 0; sample < 12; ++sample) {
    const V direction = check::random_vector<n>(random).normalized();
    const V p = check::random_vector<n>(random);
    const double edge = check::edge<R>(direction);
    std::vector<double> lengths = {1e-12, 1e-9, 1e-6, 1e-4, 1e-2, 0.1, 0.3, 0.45, 0.55, 0.7, 0.9};
    for (double& length : lengths) {
      if (length >= 0.1) length *= edge;
    }
    lengths.push_back(0.999 * edge);
    for (const double length : lengths) {
      const V xi = length * direction;
      const auto g = R::tau(xi);
      const M dR = R::dtau_right(xi), dL = R::dtau_left(xi);
      const M dR_inverse = R::dtau_right_inverse(xi), dL_inverse = R::dtau_left_inverse(xi);
      const double condition = std::max(1.0, dL_inverse.norm() * dL.norm());
      domain(R::in_domain(xi) ? 0 : 1);
      adjoint((dR - G::Ad(g) * dL).norm() / condition);
      inverses((dR * dR_inverse - one).norm() / condition);
      inverses((dL * dL_inverse - one).norm() / condition);
      inverses((dR_inverse.transpose() * p - R::dtau_right_inverse_transpose(xi, p)).norm() /
               (condition * p.norm()));
      inverses((dL_inverse.transpose() * p - R::dtau_left_inverse_transpose(xi, p)).norm() /
               (condition * p.norm()));
      round_trip((R::tau_inverse(g) - xi).norm() / (length * condition));
      if (length > 0.7 * edge) continue;
      right((numerical.right(xi) - dR).norm() / condition);
      left((numerical.left(xi) - dL).norm() / condition);
      const M slope = R::dtau_right_inverse_transpose_derivative(xi, p);
      M differences;
      for (int j = 0; j < n; ++j) {
        differences.col(j) = check::derivative([&](double t) -> V {
          return R::dtau_right_inverse(V(xi + t * V::Unit(j))).transpose() * p;
        });
      }
      newton((slope - differences).norm() / (1 + slope.norm()));
      if (length < 0.1 * edge) continue;
      symmetry = std::max(symmetry, check::distance<G>(G::compose(R::tau(V(-xi)), g), e));
      for (const double s : {-0.3, 0.2, 0.5}) {
        const auto one_way = G::compose(G::inverse(R::tau(V(-s * xi))), R::tau(V((1 - s) * xi)));
        one_parameter = std::max(one_parameter, check::distance<G>(one_way, g));
      }
    }
    const M ad = G::ad(direction);
    const auto slope_of = [&](auto&& f) { return check::derivative(f); };
    tangent((slope_of([&](double t) -> M { return G::Ad(R::tau(V(t * direction))); }) - ad).norm() *
            1e-3);
    if constexpr (requires { G::hat(direction); }) {
      const Eigen::MatrixXd hat = G::hat(direction);
      tangent((slope_of([&](double t) -> Eigen::MatrixXd {
                 return G::matrix(R::tau(V(t * direction)));
               }) -
               hat)
                  .norm() *
              1e-3);
    }
  }

  // A property that is claimed must hold; one that is denied must be seen to fail (on an abelian
  // group it may hold by accident).
  const auto flag = [](bool claimed, double violation) -> double {
    if (claimed) return violation;
    return violation <= 1e-9 && check::nonabelian<G>() ? 1 : 0;
  };
  using check::algebraic;
  using check::differentiated;
  return {
      {"tau(0) = e, tau^-1(e) = 0", origin.value, algebraic},
      {"tau'(0) = id (differences weighted by 1e-3)", tangent.value, algebraic},
      {"dR tau against differences of tau", right.value, differentiated},
      {"dL tau against differences of tau", left.value, differentiated},
      {"dR tau = Ad(tau) dL tau", adjoint.value, algebraic},
      {"dR dR^-1 = id = dL dL^-1", inverses.value, algebraic},
      {"Newton derivative d[dR^-T p] against differences", newton.value, differentiated},
      {"tau^-1(tau(xi)) = xi from |xi| = 1e-12 to the edge", round_trip.value, algebraic},
      {"0 and everything up to the edge is in the domain", domain.value, 0},
      {"NaN is not in the domain", nan.value, 0},
      {"flag symmetric is right: tau(-xi) = tau(xi)^-1", flag(R::symmetric, symmetry), algebraic},
      {"flag one_parameter is right: tau(-s xi)^-1 tau((1-s) xi) = tau(xi)",
       flag(R::one_parameter, one_parameter), algebraic},
  };
}

}  // namespace hamel
