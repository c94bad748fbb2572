// The equations of motion: accelerations and reactions at an admissible (t, g, xi).
//
// Lagrange-d'Alembert with multipliers, d/dt along the motion:
//   I xi' = ad*_xi I xi + force - (dI/dt) xi + A^T lambda,   A xi' = db/dt - (dA/dt) xi.
// (dI/dt) xi and db/dt - (dA/dt) xi: by one dual number where the problem has its formulas over any
// scalar, else by differences; an erased problem has all at once (Mechanics::motion). A
// left-invariant problem has y' in closed form. Accelerations and multipliers are those of (1) in
// metric.hpp, mu what changes the momentum and c = db/dt - (dA/dt) xi.
#pragma once

#include <cmath>
#include <type_traits>
#include <utility>

#include <Eigen/Core>

#include <hamel/framework/lie/types.hpp>
#include <hamel/framework/mechanics/differenced_rates.hpp>
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
  using Factored =
      Metric<Problem::Vector::RowsAtCompileTime, Problem::Multipliers::RowsAtCompileTime>;
  static constexpr bool evaluates_at_once =
      requires(const Problem& problem, const typename Problem::Element& g,
               typename Problem::Vector& v, typename Problem::Multipliers& c, Factored& at) {
    problem.motion(0.0, g, v, at.inertia, at.a, at.b, c, v);
  };
  static constexpr bool has_dual_rates = [] {
    if constexpr (requires { Problem::has_dual_rates(); }) return Problem::has_dual_rates();
    else return false;
  }();
  static constexpr bool has_differences =
      !evaluates_at_once && !has_dual_rates && !Problem::left_invariant;
  struct NoDifferences {
    explicit NoDifferences(const Problem& /*problem*/) {}
  };
  using Differences = std::conditional_t<has_differences, DifferencedRates<Problem>, NoDifferences>;

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
        differences_(problem) {}

  /// The rate of the carried velocity at an admissible (t, g, x): the equations without
  /// multipliers, of which any explicit scheme is made (tests/examples/own_general_scheme.cpp).
  /// With all that they call, inlined once: a third fewer instructions than calls.
  HAMEL_FLATTEN [[gnu::noinline]] void operator()(double t, const Element& g, const State& x,
                                                  State& rate) {
    if constexpr (Problem::left_invariant) {
      problem_.acceleration(x, rate);
    } else {
      if (gives_accelerations()) return find_accelerations(t, g, x, rate);
      solve(t, g, x);
      rate = acceleration_;
    }
  }
  /// Does the problem have the rate at once? Then operator() sets nothing for what follows.
  bool gives_accelerations() const {
    if constexpr (requires { problem_.has_accelerations(); }) return problem_.has_accelerations();
    else return false;
  }
  /// xi' and lambda (k entries, N or N m as the rows have it) at (t, g, xi).
  void solve(double t, const Element& g, const Vector& xi) {
    if constexpr (evaluates_at_once) {
      if (!metric_.known()) set(t, g);
      problem_.motion(t, g, xi, metric_.inertia, metric_.a, metric_.b, row_rate_, change_);
      factor();
    } else {
      if (!has_dual_rates || !metric_.known()) set(t, g);
      find_rates(t, g, xi);
      if (has_dual_rates) factor();
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
  /// |I^-1 F| of the forces at a state, in the metric I of the last set().
  double force_size(double t, const Element& g, const Vector& xi) {
    problem_.force(t, g, xi, change_);
    return metric_.size(change_);
  }
  const Vector& acceleration() const { return acceleration_; }
  /// Behind solve().
  const Multipliers& reaction() { return metric_.multipliers(change_, acceleration_); }

 private:
  void find_accelerations([[maybe_unused]] double t, [[maybe_unused]] const Element& g,
                          [[maybe_unused]] const State& x, [[maybe_unused]] State& rate) {
    if constexpr (requires { problem_.accelerations(t, g, x, rate); })
      problem_.accelerations(t, g, x, rate);
  }
  // I and A have been evaluated.
  void factor() {
    metric_.factor(!problem_.constant_inertia(),
                   problem_.constraint_count() > 0 && !problem_.constant_constraints());
  }

  // By one dual number, which leaves I and A too (nothing in b is a function of time there).
  void find_rates([[maybe_unused]] double t, [[maybe_unused]] const Element& g,
                  [[maybe_unused]] const Vector& xi) {
    if (problem_.constant_inertia() && problem_.constant_constraints()) row_rate_.setZero();
    else if constexpr (has_dual_rates)
      problem_.dual_rates(g, xi, metric_.a, row_rate_, metric_.inertia, momentum_rate_);
    else if constexpr (has_differences) differences_(problem_, t, g, xi, row_rate_, momentum_rate_);
  }

  Problem problem_;
  Factored metric_;
  Vector acceleration_, momentum_, change_, work_, momentum_rate_;  // (I xi)' at constant xi
  Multipliers row_rate_;                                            // of b - A xi at constant xi
  [[no_unique_address]] Differences differences_;
};

}  // namespace hamel
