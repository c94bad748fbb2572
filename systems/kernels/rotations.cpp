// Groups of rotations with their retractions, their types erased.
#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/units.hpp>

namespace hamel {

void add_rotations(Registry& registry) {
  add_group<SO2>(registry);
  add_group<SO3>(registry);
}

}  // namespace hamel
