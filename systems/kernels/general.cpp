// The one time loop of all general systems.
#include <hamel/framework/loop/general_kernel.hpp>
#include <hamel/solvers/newton.hpp>
#include <hamel/systems/kernels/groups.hpp>

namespace hamel {

void add_general(Registry& registry) {
  registry.set_general_kernel([](const KernelSetup& setup, const GeneralSetup& general,
                                 std::unique_ptr<GeneralStep> step) -> std::unique_ptr<Kernel> {
    return std::make_unique<GeneralKernel<Newton>>(setup, general, std::move(step));
  });
}

}  // namespace hamel
