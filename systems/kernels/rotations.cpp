// Groups of rotations with their retractions, their types erased.
#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/geometries.hpp>
#include <hamel/systems/kernels/units.hpp>

namespace hamel {

void add_rotations(Registry& registry) {
  add_group<SO2>(registry);
  add_group<SO3>(registry);
}

template <>
WithExp with_exp<SO2>() {
  return {group_info<SO2>(), std::make_shared<TypedGeometry<Exp<SO2>>>()};
}
template <>
WithExp with_exp<SO3>() {
  return {group_info<SO3>(), std::make_shared<TypedGeometry<Exp<SO3>>>()};
}

}  // namespace hamel
