#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {

void add_se2(Registry& registry) { add_group<SE2, kRunTime, 2>(registry); }

}  // namespace hamel
