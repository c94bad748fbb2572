#include "registry.hpp"

#include <hamel/framework/schemes/boxed.hpp>
#include <hamel/framework/schemes/lift.hpp>
#include <hamel/framework/schemes/rkmk4.hpp>
#include <hamel/groups/cayley.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/product_retraction.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/kernels.hpp>
#include <hamel/systems/rolling_disk.hpp>
#include <hamel/systems/suslov.hpp>

namespace hamel::fuzz {

const Registry& registry() {
  static const Registry all = [] {
    Registry out;
    add_retraction<Exp<SO2>>(out);
    add_retraction<Cayley<SO2>>(out);
    add_retraction<Exp<SO3>>(out);
    add_retraction<Cayley<SO3>>(out);
    add_retraction<Exp<SE2>>(out);
    add_retraction<Exp<SE3>>(out);
    add_retraction<Exp<Rn<1>>>(out);
    out.add(group_info<SE3>());
    out.add(group_info<Rn<1>>());
    out.add(group_info<SO2>());
    out.add(group_info<SO3>());
    out.add(group_info<SE2>());
    add_scheme<Lift>(out);
    add_scheme<Boxed>(out);
    add_scheme<Rkmk4>(out);
    out.add_scheme_alias("dla", Lift::name());
    out.add(SolverInfo{"newton", "", "", nullptr});
    add_system<Suslov>(out);
    add_system<ChaplyginSleigh>(out);
    add_system<RollingDisk>(out);
    return out;
  }();
  return all;
}

}  // namespace hamel::fuzz
