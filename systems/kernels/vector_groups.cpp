// The vector groups with their retractions, their types erased.
#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/geometries.hpp>
#include <hamel/systems/kernels/units.hpp>

namespace hamel {

void add_vector_groups(Registry& registry) {
  add_group<Rn<1>>(registry);
  add_group<Rn<2>>(registry);
  add_group<Rn<3>>(registry);
}

template <>
WithExp with_exp<Rn<1>>() {
  return {group_info<Rn<1>>(), std::make_shared<TypedGeometry<Exp<Rn<1>>>>()};
}

}  // namespace hamel
