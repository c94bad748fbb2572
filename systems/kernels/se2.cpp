#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {

void add_se2(Registry& registry) {
  add_group<SE2>(registry);
  add_fast_kernels<SE2, 2>(registry);
}

}  // namespace hamel
