#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {

void add_se3(Registry& registry) { add_group<SE3>(registry); }

}  // namespace hamel
