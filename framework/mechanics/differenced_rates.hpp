// Rates of rows and momenta along a motion, by differences: of systems that state the values of
// I(g) and A(t, g) alone.
//
// Along g tau(e xi) at t and, where the problem is not autonomous, in t at g (lie/differences.hpp).
#pragma once

#include <array>

#include <hamel/framework/lie/differences.hpp>

namespace hamel {

/// problem: I and A as a problem of schemes/problem.hpp has them, tau and the products of its
/// group.
template <class Problem>
class DifferencedRates {
 public:
  using Element = typename Problem::Element;
  using Vector = typename Problem::Vector;
  using Multipliers = typename Problem::Multipliers;

  explicit DifferencedRates(const Problem& problem)
      : step_(problem.dim()),
        b_(Multipliers::Zero(problem.constraint_count())),
        time_rate_(b_),
        time_work_{b_, b_},
        a_(problem.constraint_count(), problem.dim()),
        inertia_(problem.dim(), problem.dim()),
        moved_(problem.element()) {}

  /// rows: db/dt - (dA/dt) xi;  momentum: (dI/dt) xi.
  void operator()(const Problem& problem, double t, const Element& g, const Vector& xi,
                  Multipliers& rows, Vector& momentum) {
    rows.setZero();
    momentum.setZero();
    const bool moves = problem.constraint_count() > 0 && !problem.constant_constraints();
    const bool varies = !problem.constant_inertia();
    if (!moves && !varies) return;
    // b - A xi.
    const auto lack = [&](double at, const Element& where) {
      problem.constraints(at, where, a_, b_);
      b_ -= a_.lazyProduct(xi);
    };
    differentiate_along(problem, g, xi, step_, moved_, [&](double, double weight) {
      if (moves) {
        lack(t, moved_);
        rows += weight * b_;
      }
      if (varies) {
        problem.inertia(moved_, inertia_);
        momentum += weight * inertia_.lazyProduct(xi);
      }
    });
    if (!moves || problem.autonomous()) return;
    differentiate_in_time(
        t,
        [&](double at) -> const Multipliers& {
          lack(at, g);
          return b_;
        },
        time_work_, time_rate_);
    rows += time_rate_;
  }

 private:
  Vector step_;
  Multipliers b_, time_rate_;
  std::array<Multipliers, 2> time_work_;
  typename Problem::ConstraintMatrix a_;
  typename Problem::Matrix inertia_;
  Element moved_;
};

}  // namespace hamel
