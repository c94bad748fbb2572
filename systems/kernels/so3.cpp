#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {

void add_so3(Registry& registry) {
  add_group<SO3>(registry);
  add_fast_kernels<SO3, 2>(registry);
}

}  // namespace hamel
