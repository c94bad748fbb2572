// Kernels of the vehicles with inputs.
#include <hamel/groups/product_retraction.hpp>
#include <hamel/systems/differential_drive.hpp>
#include <hamel/systems/kernels/units.hpp>
#include <hamel/systems/roller_racer.hpp>
#include <hamel/systems/segway.hpp>
#include <hamel/systems/snakeboard.hpp>

namespace hamel {

void add_driven_vehicles(Registry& registry) {
  add_driven<DifferentialDrive>(registry);
  add_driven<RollerRacer>(registry);
  add_driven<Segway>(registry);
  add_driven<Snakeboard>(registry);
}

}  // namespace hamel
