// The group of motions of space with its retractions, their types erased.
#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/geometries.hpp>
#include <hamel/systems/kernels/units.hpp>

namespace hamel {

void add_motions_of_space(Registry& registry) { add_group<SE3>(registry); }

template <>
WithExp with_exp<SE3>() {
  return {group_info<SE3>(), std::make_shared<TypedGeometry<Exp<SE3>>>()};
}

}  // namespace hamel
