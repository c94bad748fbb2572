// The equations of motion: accelerations and reactions at an admissible (t, g, xi).
//
// Lagrange-d'Alembert with multipliers, d/dt along the motion:
//   I xi' = ad*_xi I xi + force - (dI/dt) xi + A^T lambda,   A xi' = db/dt - (dA/dt) xi.
// (dI/dt) xi and db/dt - (dA/dt) xi: by one dual number where the problem has its formulas over any
// scalar, its own where it has them (Mechanics::motion and rates), else by differences along g
// tau(e xi) at t, and in t at g (lie/differences.hpp). A left-invariant problem has y' in closed
// form. With W^T W = I^-1, Y = W A^T and c = W change:
//   Y^T Y lambda = db/dt - (dA/dt) xi - Y^T c,   xi' = W^T (c + Y lambda),
// W and the factors of Y^T Y those of dense_factors.hpp, or of run_time_factors.hpp where sizes are
// known at run time only; there with E of (M5) where the rows are many,
//   A xi' = db/dt - (dA/dt) xi,   E^T I xi' = E^T change,   A^T lambda = I xi' - change.
#pragma once

#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

#include <hamel/framework/lie/differences.hpp>
#include <hamel/framework/lie/types.hpp>
#include <hamel/framework/metric/dense_factors.hpp>
#include <hamel/framework/metric/run_time_factors.hpp>

namespace hamel {

namespace detail {
template <class P>
struct OfMotion {
  using type = P;
};
template <class P>
requires requires { typename P::OfMotion; }
struct OfMotion<P> {
  using type = typename P::OfMotion;
};
}  // namespace detail
/// The problem whose equations of motion are compiled for P: P, or one that several share.
template <class P>
using OfMotion = typename detail::OfMotion<P>::type;

template <class Problem>
class EquationsOfMotion {
 public:
  using Element = typename Problem::Element;
  using Vector = typename Problem::Vector;
  using State = typename Problem::State;
  using Multipliers = typename Problem::Multipliers;

  explicit EquationsOfMotion(const Problem& problem)
      : problem_(problem),
        acceleration_(problem.dim()),
        momentum_(problem.dim()),
        change_(problem.dim()),
        work_(problem.dim()),
        reaction_(problem.constraint_count()),
        b_(problem.constraint_count()),
        row_rate_(Problem::Multipliers::Zero(problem.constraint_count())),
        time_rate_(row_rate_),
        time_work_{row_rate_, row_rate_},
        momentum_rate_(problem.dim()),
        a_(problem.constraint_count(), problem.dim()),
        moved_a_(problem.constraint_count(), problem.dim()),
        moved_b_(problem.constraint_count()),
        inertia_(problem.dim(), problem.dim()),
        moved_inertia_(problem.dim(), problem.dim()),
        rows_(problem.dim(), problem.constraint_count()),
        factors_(problem.dim(), problem.constraint_count()),
        moved_(problem.element()) {}

  /// The rate of the carried velocity at an admissible (t, g, x): the equations without
  /// multipliers, of which any explicit scheme is made (tests/examples/own_general_scheme.cpp).
  /// With all that they call, inlined once: a third fewer instructions than calls.
  HAMEL_FLATTEN [[gnu::noinline]] void operator()(double t, const Element& g, const State& x,
                                                  State& rate) {
    if constexpr (Problem::left_invariant) {
      problem_.acceleration(x, rate);
    } else {
      solve(t, g, x);
      rate = acceleration_;
    }
  }
  /// xi' and lambda (k entries, N or N m as the rows have it) at (t, g, xi).
  void solve(double t, const Element& g, const Vector& xi) {
    if (!evaluate_at_once(t, g, xi)) {
      if (has_dual_rates() && known_) {
        evaluate_with_rates(g, xi);
        factor(t, g);
      } else {
        set(t, g);
        find_rates(t, g, xi);
      }
      factors_.apply_inertia(inertia_, xi, momentum_);
      problem_.force(t, g, xi, change_);
      if (!problem_.constant_inertia()) change_ -= momentum_rate_;
      problem_.ad_transpose(xi, momentum_, work_);
      change_ += work_;
    }
    if (framed()) return accelerate();
    factors_.apply_root(change_, work_);
    if (problem_.constraint_count() > 0) {
      factors_.subtract_rows(row_rate_, work_, reaction_);
      factors_.solve_gram(reaction_);
      factors_.add_reaction(reaction_, work_);
      if (singular_) reaction_ -= stiffness_ * row_rate_;
    }
    factors_.apply_root_transpose(work_, acceleration_);
  }
  /// Sets what depends on (t, g) alone.
  void set(double t, const Element& g) {
    if (!known_ || !problem_.constant_inertia()) problem_.inertia(g, inertia_);
    if (problem_.constraint_count() > 0 && (!known_ || !problem_.constant_constraints()))
      set_rows(t, g);
    factor(t, g);
  }
  /// The smallest v in the metric I with A v = c, A and I those of the last set(); returns its
  /// size, v . I v.
  double smallest(const Multipliers& c, Vector& v) {
    if (framed()) return smallest_in_frame(c, v);
    reaction_ = c;
    factors_.solve_gram(reaction_);
    factors_.find_reaction(reaction_, work_);
    factors_.apply_root_transpose(work_, v);
    return work_.squaredNorm();
  }
  /// Moves xi onto A xi = b in the metric I (A, b, I those of the last set()); returns the squared
  /// sizes of what was added, and of xi.
  std::pair<double, double> project(Vector& xi) {
    factors_.apply_inertia(inertia_, xi, momentum_);
    const double size = momentum_.dot(xi);
    if (problem_.constraint_count() == 0) return {0, size};
    row_rate_ = b_ - a_.lazyProduct(xi);
    const double added = smallest(row_rate_, acceleration_);
    xi += acceleration_;
    return {added, size};
  }
  /// |v| in the metric I at the last place.
  double size(const State& v) {
    if constexpr (Problem::left_invariant) {
      return v.norm();
    } else {
      factors_.apply_inertia(inertia_, v, momentum_);
      return std::sqrt(std::fmax(0, momentum_.dot(v)));
    }
  }
  const Vector& acceleration() const { return acceleration_; }
  /// Behind solve().
  const Multipliers& reaction() {
    if (framed()) find_reaction();
    return reaction_;
  }

 private:
  static constexpr bool has_dual_rates() {
    if constexpr (requires { Problem::has_dual_rates(); }) return Problem::has_dual_rates();
    else return false;
  }
  static constexpr bool fixed_size = Vector::RowsAtCompileTime != Eigen::Dynamic;

  bool framed() const {
    if constexpr (fixed_size) return false;
    else return factors_.framed();
  }
  void accelerate() {
    if constexpr (!fixed_size) factors_.accelerate(change_, row_rate_, acceleration_);
  }
  double smallest_in_frame([[maybe_unused]] const Multipliers& c, [[maybe_unused]] Vector& v) {
    if constexpr (!fixed_size) {
      work_.setZero();
      factors_.accelerate(work_, c, v);
      factors_.apply_inertia(inertia_, v, work_);
    }
    return work_.dot(v);
  }
  void find_reaction() {
    if constexpr (!fixed_size) {
      factors_.apply_inertia(inertia_, acceleration_, work_);
      work_ -= change_;
      factors_.multipliers(work_, reaction_);
    }
  }

  // All at once, by the problem itself.
  bool evaluate_at_once([[maybe_unused]] double t, [[maybe_unused]] const Element& g,
                        [[maybe_unused]] const Vector& xi) {
    if constexpr (requires { problem_.motion(t, g, xi, inertia_, a_, b_, row_rate_, change_); }) {
      if (!known_) set(t, g);
      if (!problem_.motion(t, g, xi, inertia_, a_, b_, row_rate_, change_)) return false;
      factor(t, g);
      return true;
    } else {
      return false;
    }
  }
  // By one dual number; nothing in b is a function of time.
  void evaluate_with_rates(const Element& g, const Vector& xi) {
    if constexpr (has_dual_rates())
      problem_.dual_rates(g, xi, rows_, row_rate_, inertia_, momentum_rate_);
  }
  void set_rows(double t, const Element& g) {
    problem_.constraints(t, g, a_, b_);
    if constexpr (fixed_size) rows_ = a_.transpose();
  }
  // Recomputes what depends on inertia_ and a_.
  void factor(double t, const Element& g) {
    const bool inertia_changes = !known_ || !problem_.constant_inertia();
    const bool rows_change =
        problem_.constraint_count() > 0 && (!known_ || !problem_.constant_constraints());
    if (inertia_changes) {
      known_ = true;
      singular_ = !factors_.find_root(inertia_);
    }
    if (singular_) [[unlikely]]
      find_stiff_root(t, g);
    if (problem_.constraint_count() == 0 || !(inertia_changes || rows_change)) return;
    if constexpr (fixed_size) factors_.find_rows(rows_);
    else factors_.find_rows(inertia_, a_);
  }

  void find_rates(double t, const Element& g, const Vector& xi) {
    row_rate_.setZero();
    if (problem_.constraint_count() == 0 && problem_.constant_inertia()) return;
    const bool moves = !problem_.constant_constraints(), varies = !problem_.constant_inertia();
    if (!moves && !varies) return;
    if constexpr (has_dual_rates()) return evaluate_with_rates(g, xi);
    if constexpr (requires { problem_.rates(t, g, xi, row_rate_, momentum_rate_); }) {
      if (problem_.rates(t, g, xi, row_rate_, momentum_rate_)) return;
    }
    row_rate_.setZero();
    momentum_rate_.setZero();
    // b - A xi.
    const auto lack = [&](double at, const Element& where) {
      problem_.constraints(at, where, moved_a_, moved_b_);
      moved_b_ -= moved_a_.lazyProduct(xi);
    };
    differentiate_along(problem_, g, xi, work_, moved_, [&](double, double weight) {
      if (moves) {
        lack(t, moved_);
        row_rate_ += weight * moved_b_;
      }
      if (varies) {
        problem_.inertia(moved_, moved_inertia_);
        momentum_rate_ += weight * moved_inertia_.lazyProduct(xi);
      }
    });
    if (!moves || autonomous()) return;
    differentiate_in_time(
        t,
        [&](double at) -> const Multipliers& {
          lack(at, g);
          return moved_b_;
        },
        time_work_, time_rate_);
    row_rate_ += time_rate_;
  }
  bool autonomous() const {
    if constexpr (requires { problem_.autonomous(); }) return problem_.autonomous();
    else return true;
  }

  // With massless links I is definite on ker A only. I + kappa A^T A has the same motions, as the
  // term it adds to the momentum is a reaction: (I + kappa A^T A) xi' = change + A^T (lambda +
  // kappa A xi').
  [[gnu::noinline, gnu::cold]] void find_stiff_root(double t, const Element& g) {
    set_rows(t, g);
    stiffness_ = inertia_.trace() / a_.squaredNorm();
    const typename Problem::Matrix stiff = inertia_ + stiffness_ * a_.transpose().lazyProduct(a_);
    factors_.find_root(stiff);
  }

  Problem problem_;
  bool known_ = false, singular_ = false;
  double stiffness_ = 0;
  Vector acceleration_, momentum_, change_, work_;
  Multipliers reaction_, b_, row_rate_, time_rate_;  // row_rate_: of b - A xi at constant xi
  std::array<Multipliers, 2> time_work_;
  Vector momentum_rate_;  // of I xi at constant xi
  typename Problem::ConstraintMatrix a_, moved_a_;
  Multipliers moved_b_;
  typename Problem::Matrix inertia_, moved_inertia_;
  struct Nothing {
    Nothing(int /*n*/, int /*k*/) {}
  };
  using Columns = typename DenseFactors<Vector, Multipliers>::Columns;
  [[no_unique_address]] std::conditional_t<fixed_size, Columns, Nothing> rows_;  // A^T
  std::conditional_t<fixed_size, DenseFactors<Vector, Multipliers>, RunTimeFactors> factors_;
  Element moved_;
};

}  // namespace hamel
