#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {
namespace {

// On R^n every retraction is the identity map, registered as exp and cayley.
template <class G, int M>
void add_line(Registry& registry) {
  registry.add(group_info<G>());
  add_retraction<Exp<G>, M>(registry);
  add_as_exp<Cayley<G>, M>(registry);
}

}  // namespace

void add_rn(Registry& registry) {
  add_line<Rn<1>, 1>(registry);
  add_line<Rn<2>, kRunTime>(registry);
  add_line<Rn<3>, kRunTime>(registry);
}

}  // namespace hamel
