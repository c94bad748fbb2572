// Every scheme for problems whose types are known at run time only. One more scheme: its #include
// and its line.
#include <hamel/framework/schemes/boxed.hpp>
#include <hamel/framework/schemes/boxed_literal.hpp>
#include <hamel/framework/schemes/dop853.hpp>
#include <hamel/framework/schemes/dopri5.hpp>
#include <hamel/framework/schemes/energy_preserving.hpp>
#include <hamel/framework/schemes/gni.hpp>
#include <hamel/framework/schemes/reversible.hpp>
#include <hamel/framework/schemes/tsit5.hpp>
#include <hamel/framework/schemes/unadapted.hpp>
#include <hamel/systems/kernels/units.hpp>

namespace hamel {

void add_erased_schemes(Registry& registry) {
  add_scheme<Balance>(registry);
  add_scheme<Boxed>(registry);
  add_scheme<BoxedLiteral>(registry);
  add_scheme<Dop853>(registry);
  add_scheme<Dopri5>(registry);
  add_scheme<EnergyPreserving>(registry);
  add_scheme<Gni>(registry);
  add_scheme<Lift>(registry);
  add_scheme<Reversible>(registry);
  add_scheme<Rk4Projected>(registry);
  add_scheme<Rkmk4>(registry);
  add_scheme<Tsit5>(registry);
  add_scheme<Unadapted>(registry);
}

}  // namespace hamel
