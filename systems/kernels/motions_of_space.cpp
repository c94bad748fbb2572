// The group of motions of space with its retractions, their types erased.
#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/units.hpp>

namespace hamel {

void add_motions_of_space(Registry& registry) { add_group<SE3>(registry); }

}  // namespace hamel
