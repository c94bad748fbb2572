// The composition root: the one file that links everything by name.
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/kernels/groups.hpp>
#include <hamel/systems/rolling_disk.hpp>
#include <hamel/systems/simulate.hpp>
#include <hamel/systems/suslov.hpp>

namespace hamel {
namespace {

Registry make_registry() {
  Registry registry;
  add_so2(registry);
  add_so3(registry);
  add_se2(registry);
  add_se3(registry);
  add_rn(registry);
  add_se2_so2(registry);

  Schemes::for_each(
      [&]<class Scheme>(std::type_identity<Scheme>) { registry.add(scheme_info<Scheme>()); });
  registry.add(SolverInfo{
      Newton::name(), "Newton with the Jacobian kept while it contracts, compiled into the kernels",
      "Kelley 2003", nullptr});

  add_system<Suslov>(registry);
  add_system<ChaplyginSleigh>(registry);
  add_system<RollingDisk>(registry);
  return registry;
}

}  // namespace

Registry& registry() {
  static Registry all = make_registry();
  return all;
}

}  // namespace hamel
