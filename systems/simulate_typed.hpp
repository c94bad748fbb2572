// hamel::simulate by object, or with everything compiled for the program's own types.
#pragma once

#include <string>

#include <hamel/framework/lie/retraction_members.hpp>
#include <hamel/framework/run/run/own_system.hpp>
#include <hamel/framework/run/run/simulation.hpp>
#include <hamel/framework/schemes/balance.hpp>
#include <hamel/framework/schemes/boxed.hpp>
#include <hamel/framework/schemes/boxed_literal.hpp>
#include <hamel/framework/schemes/dop853.hpp>
#include <hamel/framework/schemes/dopri5.hpp>
#include <hamel/framework/schemes/energy_preserving.hpp>
#include <hamel/framework/schemes/gni.hpp>
#include <hamel/framework/schemes/lift.hpp>
#include <hamel/framework/schemes/reversible.hpp>
#include <hamel/framework/schemes/rk4_projected.hpp>
#include <hamel/framework/schemes/rkmk4.hpp>
#include <hamel/framework/schemes/tsit5.hpp>
#include <hamel/framework/schemes/unadapted.hpp>
#include <hamel/systems/by_name.hpp>
#include <hamel/systems/kernels.hpp>

namespace hamel {

/// A system object, on a registered group.
template <class S>
requires(!std::convertible_to<const S&, std::string>) Simulation simulate(const S& system) {
  static_assert(System<S> || RunTimeSystem<S>,
                "this type does not satisfy hamel::System: Group, inertia(), constraints()");
  return {registry(), erase_words(system).name, OwnSystem{maker(system)}};
}

namespace detail {
template <class Scheme, class S, class Tau>
constexpr auto problem_of() {
  constexpr int m = S::Group::dim - constraint_count<S>();
  if constexpr (!is_left_invariant<S>()) return std::type_identity<StaticProblem<S, Tau>>{};
  else if constexpr (Scheme::reduced)
    return std::type_identity<LeftInvariant<typename S::Group, m, Tau>>{};
  else return std::type_identity<DynamicProblem>{};
}
}  // namespace detail

/// In place of add_retraction (kernels.hpp) for what is no retraction.
template <class Tau>
requires(!Retraction<Tau>) void add_retraction(Registry&) { refuse_incomplete<Tau>(); }

/// A system object with the scheme and the retraction named by type; nothing needs to be
/// registered.
///   hamel::simulate<hamel::Lift, hamel::Cayley>(Sleigh{.a = 0.3})
template <class Scheme, template <class> class Tau, class S>
Simulation simulate(const S& system) {
  static_assert(System<S>,
                "this type does not satisfy hamel::System: Group, inertia(), constraints()");
  using R = Tau<typename S::Group>;
  refuse_incomplete<R>();
  OwnSystem own{.make = maker(system), .scheme = scheme_info<Scheme>()};
  if constexpr (Retraction<R>) {
    using P = typename decltype(detail::problem_of<Scheme, S, R>())::type;
    own.kernel = compile<Scheme, P>();
    own.retraction = retraction_info<R>();
    if constexpr (has_inputs<S>()) own.driven = compile<Scheme, StaticProblem<WithInputs<S>, R>>();
  }
  return {registry(), erase_words(system).name, std::move(own)};
}

}  // namespace hamel
