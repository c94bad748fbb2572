// hamel::simulate: by name, by object, or with everything compiled for the user's own types.
#pragma once

#include <string>

#include <hamel/framework/run/run/simulation.hpp>
#include <hamel/framework/schemes/balance.hpp>
#include <hamel/framework/schemes/boxed.hpp>
#include <hamel/framework/schemes/boxed_literal.hpp>
#include <hamel/framework/schemes/energy_preserving.hpp>
#include <hamel/framework/schemes/gni.hpp>
#include <hamel/framework/schemes/lift.hpp>
#include <hamel/framework/schemes/reversible.hpp>
#include <hamel/framework/schemes/rk4_projected.hpp>
#include <hamel/framework/schemes/rkmk4.hpp>
#include <hamel/framework/schemes/unadapted.hpp>
#include <hamel/systems/kernels.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>

namespace hamel {

/// The library's registry, filled on first use; a program may add to it (add_group, add_system, ...).
/// Not thread-safe while something is being added.
Registry& registry();

/// A registered system.
inline Simulation simulate(std::string system) { return {registry(), std::move(system)}; }

/// A system object, on a registered group.
template <class S>
requires(!std::convertible_to<const S&, std::string>) Simulation simulate(const S& system) {
  static_assert(System<S> || RunTimeSystem<S>,
                "this type does not satisfy hamel::System: Group, inertia(), constraints()");
  return {registry(), erase_words(system).name, maker(system)};
}

/// A mechanism by parts.
inline Simulation simulate(const Mechanism& mechanism) {
  return {registry(), mechanism.name(), maker(mechanism)};
}

namespace detail {
template <class Scheme, class S, class Tau>
constexpr auto problem_of() {
  constexpr int m = S::Group::dim - constraint_count<S>();
  if constexpr (!is_left_invariant<S>()) return std::type_identity<Typed<S, Tau>>{};
  else if constexpr (Scheme::reduced)
    return std::type_identity<LeftInvariant<typename S::Group, m, Tau>>{};
  else return std::type_identity<Erased>{};
}
}  // namespace detail

/// A system object with the scheme and the retraction named by type; nothing needs to be registered.
///   hamel::simulate<hamel::Lift, hamel::Cayley>(Sleigh{.a = 0.3})
template <class Scheme, template <class> class Tau, class S>
Simulation simulate(const S& system) {
  static_assert(System<S>,
                "this type does not satisfy hamel::System: Group, inertia(), constraints()");
  using R = Tau<typename S::Group>;
  using P = typename decltype(detail::problem_of<Scheme, S, R>())::type;
  Simulation simulation(registry(), erase_words(system).name, maker(system));
  KernelFactory driven;
  if constexpr (has_inputs<S>()) driven = compile<Scheme, Typed<Driven<S>, R>>();
  simulation.kernel(compile<Scheme, P>(), scheme_info<Scheme>(), retraction_info<R>(), driven);
  return simulation;
}

}  // namespace hamel
