// Compiling kernels, and adding to a registry: the one place where groups, retractions, schemes and
// Newton meet. A user's program adds its own with the add_... functions; the library's own are added
// in systems.cpp, each group's kernels compiled in one unit of systems/kernels/.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include <hamel/framework/loop/compiled_kernel.hpp>
#include <hamel/framework/run/registry.hpp>
#include <hamel/framework/schemes/balance.hpp>
#include <hamel/framework/schemes/boxed.hpp>
#include <hamel/framework/schemes/boxed_literal.hpp>
#include <hamel/framework/schemes/lift.hpp>
#include <hamel/framework/schemes/unadapted.hpp>
#include <hamel/groups/retractions.hpp>
#include <hamel/solvers/newton.hpp>

namespace hamel {

/// The library's schemes. One more scheme: its file, and its name here.
using Schemes = TypeList<Lift, Balance, Boxed, BoxedLiteral, Unadapted>;

template <class Tau>
RetractionInfo retraction_info() {
  return {Tau::name(),
          Tau::Group::name(),
          Tau::formula(),
          Tau::domain(),
          Tau::symmetric,
          Tau::one_parameter,
          std::make_shared<TypedGeometry<Tau>>()};
}

template <class Scheme>
SchemeInfo scheme_info() {
  SchemeInfo info{.name = Scheme::name(),
                  .formula = Scheme::formula(),
                  .source = Scheme::source(),
                  .adapted = Scheme::adapted,
                  .uses_s = Scheme::uses_s,
                  .claimed_order = &Scheme::claimed_order};
  if constexpr (requires { &Scheme::general; }) {
    info.general = &Scheme::general;
    info.general_order = &Scheme::general_order;
  }
  return info;
}

/// A scheme that exists on the general loop only.
template <class Scheme>
void add_general_scheme(Registry& registry) {
  SchemeInfo info;
  info.name = Scheme::name();
  info.formula = Scheme::formula();
  info.source = Scheme::source();
  info.uses_s = Scheme::uses_s;
  if constexpr (requires { Scheme::fixed_s; }) info.fixed_s = Scheme::fixed_s;
  info.invariant_only = Scheme::invariant_only;
  info.steps_admissible = Scheme::steps_admissible;
  info.claimed_order = &Scheme::order;
  info.general = &Scheme::general;
  info.general_order = [](double s) { return Scheme::order(s, s == 0.5); };
  info.explicit_step = Scheme::explicit_step;
  registry.add(std::move(info));
}

/// The time loop compiled for these types; M = kRunTime for any number of admissible directions.
template <class Scheme, class Tau, int M>
KernelFactory compile() {
  using G = typename Tau::Group;
  static_assert(Group<G>, "the retraction's Group does not satisfy hamel::Group");
  static_assert(Retraction<Tau>, "this type does not satisfy hamel::Retraction");
  constexpr int directions = Scheme::adapted ? (G::dim == 1 ? 1 : M) : G::dim;
  using Step = typename Scheme::template Step<LeftInvariant<G, directions>, Tau>;
  static_assert(SchemeStep<Step>, "the scheme's Step does not satisfy hamel::SchemeStep");
  return [](const KernelSetup& setup) -> std::unique_ptr<Kernel> {
    return std::make_unique<CompiledKernel<G, directions, Tau, Scheme, Newton>>(setup);
  };
}

/// Kernels of Scheme with Tau for each M listed.
template <class Scheme, class Tau, int... Ms>
void add_kernels(Registry& registry) {
  const auto add = [&](int m, KernelFactory factory) {
    registry.add_kernel(Tau::Group::name(), m, Tau::name(), Scheme::name(), std::move(factory));
  };
  if constexpr (Scheme::adapted) {
    (add(Ms, compile<Scheme, Tau, Ms>()), ...);
  } else {
    add(Tau::Group::dim, compile<Scheme, Tau, Tau::Group::dim>());
  }
}

/// A retraction of a group, with kernels of every library scheme.
template <class Tau, int... Ms>
void add_retraction(Registry& registry) {
  static_assert(Retraction<Tau>, "this type does not satisfy hamel::Retraction");
  registry.add(retraction_info<Tau>());
  Schemes::for_each([&]<class Scheme>(std::type_identity<Scheme>) {
    if constexpr (sizeof...(Ms) == 0) add_kernels<Scheme, Tau, kRunTime>(registry);
    else add_kernels<Scheme, Tau, Ms...>(registry);
  });
}

/// A retraction that is the same map as Exp on this group: its name on the kernels of Exp.
template <class Tau, int M>
void add_as_exp(Registry& registry) {
  const std::string group = Tau::Group::name();
  registry.add(retraction_info<Tau>());
  Schemes::for_each([&]<class Scheme>(std::type_identity<Scheme>) {
    const int m = Scheme::adapted ? M : Tau::Group::dim;
    registry.add_kernel(group, m, Tau::name(), Scheme::name(),
                        *registry.kernel(group, m, "exp", Scheme::name()));
  });
}

/// A group with the retractions it lists. Ms: numbers of admissible directions to compile for
/// (default: one kernel for any).
template <class G, int... Ms>
void add_group(Registry& registry) {
  static_assert(Group<G>, "this type does not satisfy hamel::Group");
  registry.add(group_info<G>());
  RetractionsOf<G>::type::for_each(
      [&]<class Tau>(std::type_identity<Tau>) { add_retraction<Tau, Ms...>(registry); });
}

/// A group with the retractions it lists and no kernels of its own: its systems run on the general loop.
template <class G>
void add_geometry(Registry& registry) {
  registry.add(group_info<G>());
  RetractionsOf<G>::type::for_each(
      [&]<class Tau>(std::type_identity<Tau>) { registry.add(retraction_info<Tau>()); });
}

/// Kernels with m fixed at compile time, for the schemes and retractions in most use.
template <class G, int M>
void add_fast_kernels(Registry& registry) {
  add_kernels<Lift, Exp<G>, M>(registry);
  add_kernels<Lift, Cayley<G>, M>(registry);
  add_kernels<Balance, Exp<G>, M>(registry);
  add_kernels<Balance, Cayley<G>, M>(registry);
}

/// A scheme, with kernels for every retraction of the groups named.
template <class Scheme, class... Gs>
void add_scheme(Registry& registry) {
  registry.add(scheme_info<Scheme>());
  const auto of_group = [&]<class G>(std::type_identity<G>) {
    RetractionsOf<G>::type::for_each(
        [&]<class Tau>(std::type_identity<Tau>) { add_kernels<Scheme, Tau, kRunTime>(registry); });
  };
  (of_group(std::type_identity<Gs>{}), ...);
}

/// A system; its group must be one of the registry's.
template <class S>
void add_system(Registry& registry) {
  static_assert(System<S> || RunTimeSystem<S>,
                "this type does not satisfy hamel::System: Group, inertia()");
  registry.add(system_info<S>());
}

}  // namespace hamel
