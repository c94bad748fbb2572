// The measurements of a state, from the configurations: nothing that a step has just set is
// measured by itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/loop/kernel.hpp>

namespace hamel {

/// The two ends of the last step; before the first one both are the start.
template <class Element>
struct LastStep {
  const Element& before;
  double time_before;
  const Element& after;
  double time_after;
  double h;  // of the last substep; 0 before the first
};

/// A v of the last substep, v recovered from its two configurations (xi at the start); for
/// holonomic rows the change of phi. Returns |A v - b| over the other rows.
template <class P>
[[gnu::cold]] double recover_rates(const P& problem, const LastStep<typename P::Element>& last,
                                   double s, const typename P::Vector& xi,
                                   std::vector<double>& rates) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const int k = problem.constraint_count(), held = problem.holonomic_rows();
  rates.assign(static_cast<size_t>(k), unknown);
  double squared = 0;
  if constexpr (P::Multipliers::RowsAtCompileTime != 0) {
    if (k == 0) return 0;
    typename P::Vector v = xi;
    typename P::Element base = last.after;
    double t = last.time_after;
    const bool moved = last.h != 0;
    if (moved) {
      typename P::Element delta = problem.element();
      problem.inverse(last.before, delta);
      problem.compose(delta, last.after, delta);
      if (!problem.recover_step(delta, s, v)) return unknown;
      const typename P::Vector z = -s * v;
      problem.tau(z, delta);
      problem.inverse(delta, delta);
      problem.compose(last.before, delta, base);
      t = last.time_before + s * last.h;
      v /= last.h;
    }
    typename P::ConstraintMatrix a(k, problem.dim());
    typename P::Multipliers b(k);
    problem.constraints(t, base, a, b);
    Eigen::Map<Eigen::VectorXd> found(rates.data(), k);
    for (int i = 0; i < k; ++i) found[i] = a.row(i).dot(v);
    if (moved && held > 0) {
      typename P::HolonomicValues before(held), after(held);
      problem.holonomic(last.before, before);
      problem.holonomic(last.after, after);
      for (int i = 0; i < held; ++i) found[k - held + i] = (after[i] - before[i]) / last.h;
    }
    for (int i = 0; i < k - held; ++i) squared += (found[i] - b[i]) * (found[i] - b[i]);
  }
  return std::sqrt(squared);
}

/// I(g) xi.
template <class P>
void find_momentum(const P& problem, const typename P::Element& g, const typename P::Vector& xi,
                   typename P::Vector& out) {
  if constexpr (P::Vector::RowsAtCompileTime == Eigen::Dynamic) {  // some have it without I
    typename P::Vector inertial_force(problem.dim());
    problem.momentum_at(g, xi, out, inertial_force);
  } else {
    typename P::Matrix inertia;
    problem.inertia(g, inertia);
    out = inertia.lazyProduct(xi);
  }
}

/// The velocity, and what is wanted of the coordinates, the element, momentum and energy. xi: the
/// nodal velocity.
template <class P>
[[gnu::cold]] void state(const P& problem, const typename P::Element& g,
                         const typename P::Vector& xi, Snapshot& out, const StateParts& parts) {
  out.coordinates.resize(parts.coordinates ? static_cast<size_t>(problem.columns()) : 0);
  if (parts.coordinates) problem.coordinates(g, out.coordinates.data());
  out.element.resize(parts.element ? static_cast<size_t>(problem.element_size()) : 0);
  if (parts.element) problem.store(g, out.element.data());
  out.velocity.assign(xi.data(), xi.data() + xi.size());
  out.momentum.clear();
  if (!parts.momentum && !parts.energy) return;
  typename P::Vector mu(problem.dim());
  find_momentum(problem, g, xi, mu);
  if (parts.momentum) out.momentum.assign(mu.data(), mu.data() + mu.size());
  if (parts.energy) out.energy = 0.5 * mu.dot(xi) + problem.potential(g);
}

/// Measures the state and the step that led to it.
template <class P>
[[gnu::cold]] void measure(const P& problem, const LastStep<typename P::Element>& last, double s,
                           const typename P::Vector& xi, Snapshot& out) {
  const typename P::Element& g = last.after;
  out.constraint = recover_rates(problem, last, s, xi, out.constraint_rates);
  typename P::HolonomicValues phi(problem.holonomic_rows());
  problem.holonomic(g, phi);
  out.holonomic = 0;
  for (int i = 0; i < phi.size(); ++i) out.holonomic = std::max(out.holonomic, std::abs(phi[i]));
  out.group_defect = problem.defect(g);
  typename P::Element delta = problem.element();
  problem.inverse(last.before, delta);
  problem.compose(delta, g, delta);
  out.rotation = problem.rotation_angle(delta);
}

}  // namespace hamel
