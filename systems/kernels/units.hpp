// The units of systems/kernels/: what is compiled for the types of the registered systems.
#pragma once

#include <hamel/framework/schemes/balance.hpp>
#include <hamel/framework/schemes/boxed.hpp>
#include <hamel/framework/schemes/boxed_literal.hpp>
#include <hamel/framework/schemes/dop853.hpp>
#include <hamel/framework/schemes/dopri5.hpp>
#include <hamel/framework/schemes/lift.hpp>
#include <hamel/framework/schemes/rk4_projected.hpp>
#include <hamel/framework/schemes/rkmk4.hpp>
#include <hamel/framework/schemes/tsit5.hpp>
#include <hamel/framework/schemes/unadapted.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/systems/kernels.hpp>

namespace hamel {

// Groups.
void add_rotations(Registry& registry);             // so2, so3
void add_motions_of_the_plane(Registry& registry);  // se2, se2*so2
void add_motions_of_space(Registry& registry);      // se3
void add_vector_groups(Registry& registry);         // r1, r2, r3
// Schemes, and systems.
void add_erased_schemes(Registry& registry);
void add_left_invariant(Registry& registry);
void add_particles(Registry& registry);
void add_balls(Registry& registry);
void add_disk_and_rattleback(Registry& registry);
void add_vehicles(Registry& registry);
void add_driven_vehicles(Registry& registry);

// Which kernels there are, what each gains and what it costs: the table in tests/README.md. rkmk4,
// dopri5, tsit5 and dop853 share one.

/// The problem of left-invariant systems on G with m = M.
template <class G, int M>
void add_left_invariant_on(Registry& registry) {
  add_left_invariant_kernels<G, M, Exp<G>, Lift, Balance>(registry);
  add_left_invariant_kernels<G, M, Cayley<G>, Lift, Balance, Rkmk4, Dopri5, Tsit5, Dop853>(
      registry);
}

/// The kernels of a system with inputs.
template <class S>
void add_driven(Registry& registry) {
  add_typed_kernels<Driven<S>, Cayley<typename S::Group>, Lift, Rkmk4>(registry);
}

/// A registered system with its kernels.
template <class S>
void add_compiled(Registry& registry) {
  add_system<S>(registry);
  add_typed_kernels<S, Cayley<typename S::Group>, Lift, Rkmk4, Dopri5, Tsit5, Dop853>(registry);
}

}  // namespace hamel
