// Groups of motions of the plane with their retractions, their types erased.
#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/geometries.hpp>
#include <hamel/systems/kernels/units.hpp>

namespace hamel {

void add_motions_of_the_plane(Registry& registry) {
  add_group<SE2>(registry);
  add_group<Product<SE2, SO2>>(registry);
}

template <>
WithExp with_exp<SE2>() {
  return {group_info<SE2>(), std::make_shared<TypedGeometry<Exp<SE2>>>()};
}

}  // namespace hamel
