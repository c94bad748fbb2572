// The problem of a step: a nonholonomic system on a group with a retraction, as the schemes see it.
//
// Three models of one concept:
//   LeftInvariant<G, M, Tau>    constant inertia and rows, m fixed: the state is y, xi = E y
//   StaticProblem<System, Tau>  whatever C++ type describes the system: fixed sizes, no virtuals
//   DynamicProblem              run-time sizes: systems by data, products put together by name
// A step is a template over the problem; nothing in it depends on which of the three it has, but
// for `if constexpr (Problem::left_invariant)`, where constants have been contracted.
#pragma once

#include <concepts>

#include <Eigen/Core>

namespace hamel {

/// A node: time, element, and the admissible velocity in the coordinates in which a problem carries
/// it.
template <class Problem>
struct Node {
  double t = 0;
  typename Problem::Element g;
  typename Problem::State x;
  explicit Node(const Problem& problem)
      : g(problem.element()), x(Problem::State::Zero(problem.state_size())) {}
};

/// Operations available to a step. Sizes: n = dim(), k = constraint_count(), the last
/// holonomic_rows() of them differentials of holonomic rows. Out-parameters have their size before
/// a call. Elements: Problem::Element.
template <class P>
concept Problem = requires(const P& problem, typename P::Element& g, typename P::Vector& v,
                           typename P::State& x, typename P::Matrix& inertia,
                           typename P::ConstraintMatrix& a, typename P::Multipliers& b,
                           typename P::HolonomicValues& phi, typename P::Metric& place, double t) {
  { P::left_invariant } -> std::convertible_to<bool>;
  { problem.dim() } -> std::convertible_to<int>;
  { problem.constraint_count() } -> std::convertible_to<int>;
  { problem.holonomic_rows() } -> std::convertible_to<int>;
  { problem.state_size() } -> std::convertible_to<int>;
  { problem.symmetric() } -> std::convertible_to<bool>;
  { problem.one_parameter() } -> std::convertible_to<bool>;
  // The group and its retraction (lie/group_operations.hpp).
  { problem.element() } -> std::convertible_to<typename P::Element>;
  problem.compose(g, g, g);
  problem.inverse(g, g);
  problem.normalise(g);
  problem.Ad_transpose(g, v, v);
  problem.ad_transpose(v, v, v);
  problem.tau(v, g);
  problem.dtau_right_transpose(v, v, v);
  problem.dtau_left_inverse(v, v, v);
  problem.mixed_momentum(t, v, v, v, v);
  { problem.in_domain(v) } -> std::convertible_to<bool>;
  // xi of a carried velocity, and back; its momentum I xi, given I(g).
  problem.velocity(x, v);
  problem.to_state(v, x);
  problem.momentum(inertia, x, v);
  // The system (mechanics/mechanics.hpp): I(g), A(t, g) and b(t, g), phi(g), the force.
  { problem.constant_inertia() } -> std::convertible_to<bool>;
  { problem.constant_constraints() } -> std::convertible_to<bool>;
  problem.inertia(g, inertia);
  problem.momentum_at(g, v, v, v);
  problem.constraints(t, g, a, b);
  problem.constraint_values(t, g, v, b);
  problem.holonomic(g, phi);
  problem.force(t, g, v, v);
  problem.inertial_force(g, v, v);
  problem.applied_force(t, g, v, v);
  { problem.force_depends_on_velocity() } -> std::convertible_to<bool>;
  // Inertia and rows at a configuration, factored (metric/metric.hpp).
  place.set(problem, t, g);
  place.assemble(v, b, x);
  place.admissible(v, x);
};

/// Do the steps over this problem state their Jacobians in closed form?
template <class P>
concept HasJacobians = requires {
  requires P::has_jacobians;
};

}  // namespace hamel
