// The vector groups with their retractions, their types erased.
#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/units.hpp>

namespace hamel {

void add_vector_groups(Registry& registry) {
  add_group<Rn<1>>(registry);
  add_group<Rn<2>>(registry);
  add_group<Rn<3>>(registry);
}

}  // namespace hamel
