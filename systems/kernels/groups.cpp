// The groups with their retractions, their types erased.
#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/units.hpp>

namespace hamel {

void add_groups(Registry& registry) {
  add_group<SO2>(registry);
  add_group<SO3>(registry);
  add_group<SE2>(registry);
  add_group<Product<SE2, SO2>>(registry);
  add_group<SE3>(registry);
  add_group<Rn<1>>(registry);
  add_group<Rn<2>>(registry);
  add_group<Rn<3>>(registry);
  add_group<Heisenberg>(registry);
}

}  // namespace hamel
