// Compiling kernels, and adding to a registry: the one place where groups, retractions, schemes and
// Newton are combined. A user's program adds its own with the add_... functions; the library's are
// added in systems.cpp, their kernels compiled in the units of systems/kernels/.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <hamel/framework/loop/loop.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/schemes/dynamic_problem.hpp>
#include <hamel/framework/schemes/left_invariant.hpp>
#include <hamel/framework/schemes/static_problem.hpp>
#include <hamel/groups/retractions.hpp>
#include <hamel/solvers/newton.hpp>

namespace hamel {

template <class Tau>
RetractionInfo retraction_info() {
  static_assert(Retraction<Tau>, "this type does not satisfy hamel::Retraction");
  RetractionInfo info{Tau::name(),    Tau::Group::name(), Tau::formula(),        Tau::domain(),
                      Tau::symmetric, Tau::one_parameter, erased_geometry<Tau>()};
  if constexpr (requires { Tau::elsewhere(); }) info.elsewhere = Tau::elsewhere();
  if constexpr (requires { Tau::source(); }) info.source = Tau::source();
  return info;
}

namespace detail {
// Schemes that differ in their tableau only share one loop.
template <class Scheme>
struct FamilyOf {
  using type = Scheme;
};
template <class Scheme>
requires requires { typename Scheme::Family; }
struct FamilyOf<Scheme> {
  using type = typename Scheme::Family;
};
template <class Scheme, class P>
[[gnu::noinline, gnu::cold]] std::unique_ptr<Kernel> make_loop(const KernelSetup& setup) {
  return std::make_unique<Loop<Scheme, P, Newton>>(setup);
}
}  // namespace detail

/// make with a tableau, which lives for ever: of_tableau.cpp.
KernelFactory of_tableau(std::unique_ptr<Kernel> (*make)(const KernelSetup&),
                         const Tableau& tableau);

/// The time loop compiled for these types.
template <class Scheme, class P>
KernelFactory compile() {
  const auto make = &detail::make_loop<typename detail::FamilyOf<Scheme>::type, P>;
  if constexpr (requires { Scheme::tableau(); }) return of_tableau(make, Scheme::tableau());
  else return make;
}

template <class Scheme>
SchemeInfo scheme_info() {
  using Step = typename Scheme::template Step<DynamicProblem>;
  return {.name = Scheme::name(),
          .formula = Scheme::formula(),
          .source = Scheme::source(),
          .adapted = Scheme::constraint_kept != ConstraintKept::nowhere,
          .uses_s = !Scheme::fixed_s.has_value(),
          .fixed_s = Scheme::fixed_s.value_or(0),
          .steps_admissible = Scheme::constraint_kept != ConstraintKept::nodes,
          .left_invariant_only = Scheme::left_invariant_only,
          .explicit_step = ExplicitStep<Step>,
          .estimates_error = Scheme::step_choice == StepChoice::by_estimate,
          .varies_steps = Scheme::step_choice == StepChoice::symmetric,
          .places_forces = std::is_constructible_v<Step, const DynamicProblem&, double, ForceAt>,
          .claims = &Scheme::claim};
}

/// A scheme, on every system and group with any retraction.
template <class Scheme>
void add_scheme(Registry& registry) {
  SchemeInfo info = scheme_info<Scheme>();
  info.erased = compile<Scheme, DynamicProblem>();
  registry.add(std::move(info));
}

/// A retraction of a group.
template <class Tau>
void add_retraction(Registry& registry) {
  registry.add(retraction_info<Tau>());
}

/// A group with the retractions it lists.
template <class G>
void add_group(Registry& registry) {
  static_assert(Group<G>, "this type does not satisfy hamel::Group");
  registry.add(group_info<G>());
  RetractionsOf<G>::type::for_each(
      [&]<class Tau>(std::type_identity<Tau>) { add_retraction<Tau>(registry); });
}

/// A system; its group must be one of the registry's.
template <class S>
void add_system(Registry& registry) {
  static_assert(System<S> || RunTimeSystem<S>,
                "this type does not satisfy hamel::System: Group, inertia()");
  registry.add(system_info<S>());
}

// Kernels are worth their time to compile where a system or a kind of system runs much and often:
// one takes about a second, and runs two to five times faster than the erased one, with the same
// results.

/// Kernels of the schemes for the left-invariant systems on G with m admissible directions.
template <class G, int M, class Tau, class... Schemes>
void add_left_invariant_kernels(Registry& registry) {
  using P = LeftInvariant<G, M, Tau>;
  (registry.add_kernel(problem_key(G::name(), M), Tau::name(), Schemes::name(),
                       compile<Schemes, P>()),
   ...);
}

/// Kernels of the schemes for one system that is not left-invariant.
template <class S, class Tau, class... Schemes>
void add_typed_kernels(Registry& registry) {
  static_assert(!is_left_invariant<S>(), "take add_left_invariant_kernels");
  using P = StaticProblem<S, Tau>;
  (registry.add_kernel(problem_key(typeid(TypedMechanics<S>)), Tau::name(), Schemes::name(),
                       compile<Schemes, P>()),
   ...);
}

}  // namespace hamel
