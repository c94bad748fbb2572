// The equations of motion: accelerations and reactions at an admissible (t, g, xi).
//
// Lagrange-d'Alembert with multipliers, d/dt along the motion:
//   I xi' = ad*_xi I xi + force - (dI/dt) xi + A^T lambda,   A xi' = db/dt - (dA/dt) xi.
// (dI/dt) xi and db/dt - (dA/dt) xi: by one dual number where the problem has its formulas over any
// scalar, its own where it has them (Mechanics::motion and rates), else by differences along g
// tau(e xi) at t, and in t at g (lie/differences.hpp). A left-invariant problem has y' in closed
// form. Accelerations and multipliers are those of (1) in metric.hpp, mu what changes the momentum
// and c = db/dt - (dA/dt) xi.
#pragma once

#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

#include <hamel/framework/lie/differences.hpp>
#include <hamel/framework/lie/types.hpp>
#include <hamel/framework/metric/metric.hpp>

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
        metric_(problem),
        acceleration_(problem.dim()),
        momentum_(problem.dim()),
        change_(problem.dim()),
        work_(problem.dim()),
        momentum_rate_(problem.dim()),
        row_rate_(Problem::Multipliers::Zero(problem.constraint_count())),
        time_rate_(row_rate_),
        time_work_{row_rate_, row_rate_},
        moved_b_(row_rate_),
        moved_a_(problem.constraint_count(), problem.dim()),
        moved_inertia_(problem.dim(), problem.dim()),
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
      if (has_dual_rates() && metric_.known()) {
        evaluate_with_rates(g, xi);
        factor();
      } else {
        set(t, g);
        find_rates(t, g, xi);
      }
      metric_.momentum(xi, momentum_);
      problem_.force(t, g, xi, change_);
      if (!problem_.constant_inertia()) change_ -= momentum_rate_;
      problem_.ad_transpose(xi, momentum_, work_);
      change_ += work_;
    }
    metric_.solve(change_, row_rate_, acceleration_);
  }
  /// Sets what depends on (t, g) alone.
  void set(double t, const Element& g) { metric_.set(problem_, t, g); }
  /// The smallest v in the metric I with A v = c, A and I those of the last set(); returns its
  /// size, v . I v.
  double smallest(const Multipliers& c, Vector& v) { return metric_.smallest(c, v); }
  /// Moves xi onto A xi = b in the metric I (A, b, I those of the last set()); returns the squared
  /// sizes of what was added, and of xi.
  std::pair<double, double> project(Vector& xi) {
    const double size = metric_.square(xi);
    if (problem_.constraint_count() == 0) return {0, size};
    row_rate_ = metric_.b - metric_.a.lazyProduct(xi);
    const double added = smallest(row_rate_, acceleration_);
    xi += acceleration_;
    return {added, size};
  }
  /// |v| in the metric I at the last place.
  double size(const State& v) {
    if constexpr (Problem::left_invariant) return v.norm();
    else return std::sqrt(std::fmax(0, metric_.square(v)));
  }
  const Vector& acceleration() const { return acceleration_; }
  /// Behind solve().
  const Multipliers& reaction() { return metric_.multipliers(change_, acceleration_); }

 private:
  static constexpr bool has_dual_rates() {
    if constexpr (requires { Problem::has_dual_rates(); }) return Problem::has_dual_rates();
    else return false;
  }
  // All at once, by the problem itself.
  bool evaluate_at_once([[maybe_unused]] double t, [[maybe_unused]] const Element& g,
                        [[maybe_unused]] const Vector& xi) {
    if constexpr (requires {
                    problem_.motion(t, g, xi, metric_.inertia, metric_.a, metric_.b, row_rate_,
                                    change_);
                  }) {
      if (!metric_.known()) set(t, g);
      if (!problem_.motion(t, g, xi, metric_.inertia, metric_.a, metric_.b, row_rate_, change_))
        return false;
      factor();
      return true;
    } else {
      return false;
    }
  }
  // By one dual number; nothing in b is a function of time.
  void evaluate_with_rates([[maybe_unused]] const Element& g, [[maybe_unused]] const Vector& xi) {
    if constexpr (has_dual_rates())
      problem_.dual_rates(g, xi, metric_.a, row_rate_, metric_.inertia, momentum_rate_);
  }
  // I and A have been evaluated.
  void factor() {
    metric_.factor(!problem_.constant_inertia(),
                   problem_.constraint_count() > 0 && !problem_.constant_constraints());
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

  Problem problem_;
  Metric<Vector::RowsAtCompileTime, Multipliers::RowsAtCompileTime> metric_;
  Vector acceleration_, momentum_, change_, work_, momentum_rate_;  // (I xi)' at constant xi
  // Rates of b - A xi at constant xi.
  Multipliers row_rate_, time_rate_;
  std::array<Multipliers, 2> time_work_;
  Multipliers moved_b_;
  typename Problem::ConstraintMatrix moved_a_;
  typename Problem::Matrix moved_inertia_;
  Element moved_;
};

}  // namespace hamel
