#include <hamel/groups/all.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {
namespace {

// On R^n every retraction is the identity map; exp and cayley are the names that users try.
template <class G, int... Ms>
void add_line(Registry& registry) {
  registry.add(group_info<G>());
  add_retraction<Exp<G>, Ms...>(registry);
  add_retraction<Cayley<G>, Ms...>(registry);
}

}  // namespace

void add_rn(Registry& registry) {
  add_line<Rn<1>, 1>(registry);
  add_line<Rn<2>>(registry);
  add_line<Rn<3>>(registry);
}

}  // namespace hamel
