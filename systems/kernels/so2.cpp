#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {

void add_so2(Registry& registry) { add_group<SO2, 1>(registry); }

}  // namespace hamel
