// The equations of motion: accelerations and reactions at an admissible (t, g, xi).
//
// Lagrange-d'Alembert with multipliers, d/dt along the motion:
//   I xi' = ad*_xi I xi + force - (dI/dt) xi + A^T lambda,   A xi' = db/dt - (dA/dt) xi.
// dI/dt, dA/dt, db/dt: by one dual number where the problem has its formulas over any scalar, else by
// differences along g tau(e xi), t + e (lie/differences.hpp). A left-invariant problem has y' in closed form.
#pragma once

#include <hamel/framework/lie/differences.hpp>

namespace hamel {

template <class Problem>
class Motion {
 public:
  using Element = typename Problem::Element;
  using Vector = typename Problem::Vector;
  using State = typename Problem::State;
  using Few = typename Problem::Few;

  explicit Motion(const Problem& problem)
      : problem_(problem),
        place_(problem),
        acceleration_(problem.dim()),
        momentum_(problem.dim()),
        change_(problem.dim()),
        work_(problem.dim()),
        reaction_(problem.rows()),
        b_(problem.rows()),
        b_rate_(problem.rows()),
        a_(problem.rows(), problem.dim()),
        a_rate_(problem.rows(), problem.dim()),
        inertia_(problem.dim(), problem.dim()),
        inertia_rate_(problem.dim(), problem.dim()),
        moved_(problem.element()) {}

  /// The rate of the carried velocity at an admissible (t, g, x).
  void operator()(double t, const Element& g, const State& x, State& rate) {
    if constexpr (Problem::left_invariant) {
      problem_.acceleration(x, rate);
    } else {
      solve(t, g, x);
      rate = acceleration_;
    }
  }
  /// xi' and lambda (k entries, N or N m as the rows have it).
  void solve(double t, const Element& g, const Vector& xi) {
    place_.set(problem_, t, g);
    find_rates(t, g, xi);
    momentum_.noalias() = place_.inertia * xi;
    problem_.force(t, g, xi, change_);
    if (!problem_.constant_inertia()) change_.noalias() -= inertia_rate_ * xi;
    problem_.ad_transpose(xi, momentum_, work_);
    change_ += work_;
    // I xi' = change + A^T lambda, A xi' = db/dt - dA/dt xi.
    b_rate_.noalias() -= a_rate_ * xi;
    place_.velocity(change_, b_rate_, acceleration_);
  }
  const Vector& acceleration() const { return acceleration_; }
  const Few& reaction() {
    momentum_.noalias() = place_.inertia * acceleration_;
    momentum_ -= change_;
    place_.multipliers(momentum_, reaction_);
    return reaction_;
  }

 private:
  void find_rates(double t, const Element& g, const Vector& xi) {
    b_rate_.setZero();
    a_rate_.setZero();
    const bool moves = !problem_.constant_constraints(), varies = !problem_.constant_inertia();
    if (!moves && !varies) return;
    if constexpr (requires { problem_.dual_rates(g, xi, a_rate_, inertia_rate_); }) {
      if constexpr (Problem::has_dual_rates()) {
        problem_.dual_rates(g, xi, a_rate_, inertia_rate_);
        return;
      }
    }
    inertia_rate_.setZero();
    differentiate_along(problem_, g, xi, work_, moved_, [&](double shift, double weight) {
      if (moves) {
        problem_.constraints(t + shift, moved_, a_, b_);
        a_rate_ += weight * a_;
        b_rate_ += weight * b_;
      }
      if (varies) {
        problem_.inertia(moved_, inertia_);
        inertia_rate_ += weight * inertia_;
      }
    });
  }

  Problem problem_;
  typename Problem::Place place_;
  Vector acceleration_, momentum_, change_, work_;
  Few reaction_, b_, b_rate_;
  typename Problem::Rows a_, a_rate_;
  typename Problem::Matrix inertia_, inertia_rate_;
  Element moved_;
};

}  // namespace hamel
