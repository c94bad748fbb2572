// What explicit schemes on the equations of motion share: the classical Runge-Kutta method of order 4.
//
// In coordinates q of the element of its own choice, a scheme integrates
//   q' = rate(q, xi),   x' = a(t, g, x)   (mechanics/equations_of_motion.hpp),   g = element(q),
// with the stages at 0, 1/2, 1/2, 1 and the weights 1/6, 1/3, 1/3, 1/6. Then g goes to the group and xi onto
// A xi = b, orthogonally in the metric I: that is all that is kept.
// Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.
#pragma once

#include <algorithm>
#include <cmath>

#include <hamel/framework/lie/types.hpp>
#include <hamel/framework/mechanics/equations_of_motion.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

/// Derived gives start(g, q), element(q, g) -> bool (false outside the domain of the coordinates) and
/// rate(q, g, xi, out). Q: the type of the coordinates.
template <class Derived, class P, class Q>
class RungeKutta4 {
 public:
  using Problem = P;
  using Unknown = Eigen::Matrix<double, 0, 1>;  // no equation
  using Jacobian = Eigen::Matrix<double, 0, 0>;
  using Node = hamel::Node<P>;
  using Element = typename P::Element;
  using Vector = typename P::Vector;

  static constexpr int size() { return 0; }
  void guess(Unknown& /*x*/) const {}
  static double scale_squared() { return 1; }
  void residual(const Unknown& /*x*/, Unknown& /*f*/) const {}

  HAMEL_FLATTEN void begin(const Node& node, double h) {
    from_ = &node;
    h_ = h;
    self().start(node.g, q0_);
  }

  HAMEL_FLATTEN bool finish(const Unknown& /*x*/, Node& next) const {
    constexpr double at[] = {0, 0.5, 0.5, 1}, weight[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    q_sum_.setZero();
    x_sum_.setZero();
    for (int i = 0; i < 4; ++i) {
      q_ = q0_;
      x_ = from_->x;
      if (i > 0) {
        q_ += (at[i] * h_) * q_rate_;
        x_ += (at[i] * h_) * x_rate_;
      }
      if (!self().element(q_, g_)) return false;
      problem_.velocity(x_, xi_);
      self().rate(q_, g_, xi_, q_rate_);
      motion_(from_->t + at[i] * h_, g_, x_, x_rate_);
      q_sum_ += weight[i] * q_rate_;
      x_sum_ += weight[i] * x_rate_;
    }
    q_ = q0_ + h_ * q_sum_;
    if (!self().element(q_, next.g)) return false;
    next.t = from_->t + h_;
    next.x = from_->x + h_ * x_sum_;
    if constexpr (!P::left_invariant) {
      place_.set(problem_, next.t, next.g);
      if (!holds(next)) return false;
      problem_.momentum(place_.inertia, next.x, xi_);
      place_.admissible(xi_, next.x);
    }
    return next.x.allFinite();
  }
  /// Was the last step refused because the constraints do not hold at its end?
  bool lost_constraints() const { return lost_; }

 protected:
  /// coordinates: how many numbers q has.
  RungeKutta4(const P& problem, int coordinates)
      : problem_(problem),
        motion_(problem),
        place_(problem),
        q0_(coordinates),
        g_(problem.element()),
        q_(q0_),
        q_rate_(q0_),
        q_sum_(q0_),
        x_(P::State::Zero(problem.state_size())),
        x_rate_(x_),
        x_sum_(x_),
        xi_(P::Vector::Zero(problem.dim())),
        phi_(problem.held()),
        phi_before_(problem.held()) {}

  P problem_;

 private:
  Derived& self() { return static_cast<Derived&>(*this); }
  const Derived& self() const { return static_cast<const Derived&>(*this); }

  // A x = b and phi = const to a percent of the velocity, in the units of (M39), before they are imposed again: the error of
  // a sound step is a small part of that. It is not where the equations of motion are nearly singular.
  bool holds(const Node& next) const {
    constexpr double most = 0.01;
    const int n = problem_.dim(), k = problem_.rows(), held = problem_.held();
    problem_.holonomic(from_->g, phi_before_);
    problem_.holonomic(next.g, phi_);
    double off = 0, size = 0;
    for (int j = 0; j < n; ++j) size += place_.inertia(j, j) * next.x[j] * next.x[j];
    for (int i = 0; i < k; ++i) {
      double sum = -place_.b[i], weight = 0;
      for (int j = 0; j < n; ++j) {
        sum += place_.a(i, j) * next.x[j];
        weight += place_.a(i, j) * place_.a(i, j) / place_.inertia(j, j);
      }
      if (i >= k - held) {
        const int row = i - (k - held);
        sum = std::max(std::abs(sum), std::abs((phi_[row] - phi_before_[row]) / h_));
      }
      off = std::max(off, sum * sum / weight);
    }
    lost_ = !(off <= most * most * size);
    return !lost_;
  }

  mutable EquationsOfMotion<P> motion_;
  mutable typename P::Place place_;
  const Node* from_ = nullptr;
  double h_ = 0;
  Q q0_;
  mutable Element g_;
  mutable Q q_, q_rate_, q_sum_;
  mutable typename P::State x_, x_rate_, x_sum_;
  mutable Vector xi_;
  mutable typename P::Held phi_, phi_before_;
  mutable bool lost_ = false;
};

/// What they say of themselves.
struct RungeKutta4Defaults : SchemeDefaults {
  static constexpr double fixed_s = 0.5;
  static constexpr bool steps_admissible = false;
  static constexpr bool explicit_step = true;
  static constexpr bool reduced = true;
  static constexpr int stages = 4;
  static ClaimedOrder claim(double /*s*/, TauTraits /*tau*/, bool /*left_invariant*/) {
    return {4, false};
  }
};

}  // namespace hamel
