// The groups and numbers of admissible directions of the registered left-invariant systems.
#include <hamel/framework/schemes/boxed.hpp>
#include <hamel/framework/schemes/boxed_literal.hpp>
#include <hamel/framework/schemes/unadapted.hpp>
#include <hamel/groups/product_retraction.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/differential_drive.hpp>
#include <hamel/systems/heisenberg_particle.hpp>
#include <hamel/systems/kernels/units.hpp>
#include <hamel/systems/rolling_disk.hpp>
#include <hamel/systems/suslov.hpp>
#include <hamel/systems/unicycle_3d.hpp>

namespace hamel {

void add_left_invariant(Registry& registry) {
  add_left_invariant_on<SO3, 2>(registry);
  // The paper's experiment: 180,000 steps of every variant.
  add_left_invariant_kernels<SO3, 2, Cayley<SO3>, Boxed, BoxedLiteral, Unadapted>(registry);
  add_left_invariant_on<SE2, 2>(registry);
  add_left_invariant_on<RollingDisk::Group, 2>(registry);
  add_left_invariant_on<DifferentialDrive::Group, 2>(registry);
  add_left_invariant_on<Heisenberg, 2>(registry);
  add_left_invariant_on<SE3, 4>(registry);
  add_system<ChaplyginSleigh>(registry);
  add_system<DifferentialDrive>(registry);
  add_system<HeisenbergParticle>(registry);
  add_system<RollingDisk>(registry);
  add_system<Suslov>(registry);
  add_system<Unicycle3d>(registry);
}

}  // namespace hamel
