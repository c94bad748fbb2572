#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {

void add_rn(Registry& registry) {
  add_group<Rn<1>, 1>(registry);
  add_group<Rn<2>>(registry);
  add_group<Rn<3>>(registry);
}

}  // namespace hamel
