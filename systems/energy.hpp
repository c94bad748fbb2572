// The energy of a system, for its list of invariants: add("energy", energy_of(*this)).
#pragma once

#include <hamel/framework/lie/types.hpp>

namespace hamel {

/// (g, xi) -> 1/2 xi^T I xi + V(g), of the system's inertia() or inertia(g), and its potential(g)
/// if it has one.
template <class S>
auto energy_of(const S& system) {
  return [system](const auto& g, const Vec<S::Group::dim>& xi) {
    const auto kinetic = [&](const auto& inertia) { return 0.5 * xi.dot(inertia * xi); };
    double energy = 0;
    if constexpr (requires { system.inertia(); }) energy = kinetic(system.inertia());
    else energy = kinetic(system.inertia(g));
    if constexpr (requires { system.potential(g); }) energy += system.potential(g);
    return energy;
  };
}

}  // namespace hamel
