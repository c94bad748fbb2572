#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {

void add_se2_so2(Registry& registry) {
  add_group<Product<SE2, SO2>>(registry);
  add_fast_kernels<Product<SE2, SO2>, 2>(registry);
}

}  // namespace hamel
