// The energy of a system, for its list of invariants: add("energy", energy_of(*this)).
#pragma once

#include <hamel/framework/lie/types.hpp>

namespace hamel {

/// (g, xi) -> 1/2 xi^T I xi + V(g), of the system's inertia() or inertia(g), and its potential(g)
/// if it has one.
template <class S>
struct EnergyOf {
  static constexpr bool is_energy = true;  // a run has it of its states
  S system;

  double operator()(const auto& g, const Vec<S::Group::dim>& xi) const {
    const auto kinetic = [&](const auto& inertia) { return 0.5 * xi.dot(inertia * xi); };
    double energy = 0;
    if constexpr (requires { system.inertia(); }) energy = kinetic(system.inertia());
    else energy = kinetic(system.inertia(g));
    if constexpr (requires { system.potential(g); }) energy += system.potential(g);
    return energy;
  }
};
template <class S>
EnergyOf<S> energy_of(const S& system) {
  return {system};
}

}  // namespace hamel
