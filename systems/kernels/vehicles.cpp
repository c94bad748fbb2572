#include <hamel/groups/product_retraction.hpp>
#include <hamel/systems/kernels/units.hpp>
#include <hamel/systems/roller_racer.hpp>
#include <hamel/systems/segway.hpp>
#include <hamel/systems/snakeboard.hpp>

namespace hamel {

void add_vehicles(Registry& registry) {
  add_compiled<RollerRacer>(registry);
  add_compiled<Segway>(registry);
  add_compiled<Snakeboard>(registry);
}

}  // namespace hamel
