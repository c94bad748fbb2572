// Lanes by name: for ensembles of one system, W bodies in one step. An optional component,
// hamel_lanes: the library's own are there where xsimd was (registry().lanes(...) is null else),
// and add_lanes() is for a system of one's own, compiled with the program's flags.
#pragma once

#include <hamel/framework/lanes/lane_loop.hpp>
#include <hamel/framework/lanes/lane_steps.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/schemes/left_invariant.hpp>
#include <hamel/framework/schemes/lift.hpp>
#include <hamel/framework/schemes/lift_reduced.hpp>
#include <hamel/framework/schemes/rkmk4.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/solvers/newton.hpp>

namespace hamel {

/// Registers a batch under the names of its problem.
template <class Scheme, class P>
void add_lanes(Registry& registry, const std::string& instructions, int width,
               LaneMaker<Scheme, P> make) {
  registry.add_lanes(problem_key(P::Group::name(), P::m), P::Tau::name(), Scheme::name(),
                     {width, instructions, [make](std::span<const KernelSetup> setups) {
                        return LaneLoop<Scheme, P, Newton>::make(setups, make);
                      }});
}

/// A left-invariant system in lanes, for lift and rkmk4 with Cayley: in the instruction set that
/// the program is compiled for.
template <class S>
void add_lanes(Registry& registry) {
  using G = typename S::Group;
  static_assert(is_left_invariant<S>(), "lanes are offered for left-invariant systems");
  using P = LeftInvariant<G, G::dim - constraint_count<S>(), Cayley<G>>;
  using Arch = xsimd::default_arch;
  constexpr int width = 2 * Lane<Arch>::width;
  add_lanes<Lift, P>(registry, Arch::name(), width, &make_lanes<Lift, P, Arch>);
  add_lanes<Rkmk4, P>(registry, Arch::name(), width, &make_lanes<Rkmk4, P, Arch>);
}

}  // namespace hamel
