#include <hamel/groups/product_retraction.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/kernels/units.hpp>
#include <hamel/systems/rattleback.hpp>

namespace hamel {

void add_disk_and_rattleback(Registry& registry) {
  add_compiled<FallingDisk>(registry);
  add_compiled<Rattleback>(registry);
  add_typed_kernels<FallingDisk, Exp<SE3>, Lift>(registry);
  add_typed_kernels<Rattleback, Exp<SE3>, Lift, Balance>(registry);
}

}  // namespace hamel
