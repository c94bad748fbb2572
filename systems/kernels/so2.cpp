#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {

void add_so2(Registry& registry) {
  registry.add(group_info<SO2>());
  add_retraction<Exp<SO2>, 1>(registry);
  add_retraction<Cayley<SO2>, 1>(registry);
  add_as_exp<SecondKind<SO2>, 1>(registry);
  add_as_exp<SecondKindSymmetric<SO2>, 1>(registry);
}

}  // namespace hamel
