// The units of systems/kernels/: what is compiled for the types of the registered systems.
#pragma once

#include <hamel/framework/schemes/balance.hpp>
#include <hamel/framework/schemes/dop853.hpp>
#include <hamel/framework/schemes/dopri5.hpp>
#include <hamel/framework/schemes/lift.hpp>
#include <hamel/framework/schemes/rk4_projected.hpp>
#include <hamel/framework/schemes/rkmk4.hpp>
#include <hamel/framework/schemes/tsit5.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/systems/kernels.hpp>

namespace hamel {

void add_groups(Registry& registry);
// Schemes, and systems.
void add_erased_schemes(Registry& registry);
void add_left_invariant(Registry& registry);
void add_particles(Registry& registry);
void add_balls(Registry& registry);
void add_disk_and_rattleback(Registry& registry);
void add_vehicles(Registry& registry);

// Which kernels there are, what each gains and what it costs: the table in tests/README.md. rkmk4,
// dopri5, tsit5 and dop853 share one.

/// The problem of left-invariant systems on G with m = M.
template <class G, int M>
void add_left_invariant_on(Registry& registry) {
  add_left_invariant_kernels<G, M, Exp<G>, Lift, Balance, Rkmk4, Dopri5, Tsit5, Dop853>(registry);
  add_left_invariant_kernels<G, M, Cayley<G>, Lift, Balance, Rkmk4, Dopri5, Tsit5, Dop853>(
      registry);
}

/// A registered system with its kernels.
template <class S>
void add_compiled(Registry& registry) {
  add_system<S>(registry);
  add_typed_kernels<S, Cayley<typename S::Group>, Lift, Rkmk4, Dopri5, Tsit5, Dop853>(registry);
  add_typed_kernels<S, Exp<typename S::Group>, Rkmk4, Dopri5, Tsit5, Dop853>(registry);
}

}  // namespace hamel
