// Kernels of mechanisms: lift on recorded programs, else the scheme's own kernel.
#include <hamel/framework/schemes/nonsmooth.hpp>
#include <hamel/systems/kernels/lift_newton.hpp>
#include <hamel/systems/kernels/mechanisms.hpp>
#include <hamel/systems/kernels/units.hpp>
#include <hamel/systems/mechanisms/programs/lift_step.hpp>

namespace hamel {
namespace {

using namespace mechanisms;

using Programs = std::shared_ptr<const LiftPrograms>;

template <int K>
std::unique_ptr<Kernel> program_loop(const KernelSetup& setup,
                                     const std::shared_ptr<const Multibody>& system,
                                     const Programs& programs) {
  using Whole = LiftProblem;
  const Whole whole(setup.geometry, setup.mechanics, system->lift_layout());
  auto changes = std::make_shared<Kernel*>(nullptr);
  auto out = std::make_unique<hamel::Loop<ProgramLift<K>, Whole, LiftNewton>>(
      setup, whole, [&](const Whole& problem) {
        LiftStep<K> step(problem, system, programs);
        step.when_changed([changes] { (*changes)->clear_history(); });
        return step;
      });
  *changes = out.get();
  return out;
}

// Runs that the programs cover (lift_programs.hpp) beside the mechanism itself.
bool is_covered(const KernelSetup& setup) {
  return setup.s == 0.5 && setup.solver == nullptr && setup.force_at == ForceAt::nodes &&
         !setup.errors.chooses_steps();
}

std::unique_ptr<Kernel> make_mechanism_lift(const KernelSetup& setup,
                                            const KernelFactory& general) {
  const auto system = Multibody::of(setup.mechanics);
  if (system == nullptr || !is_covered(setup)) return general(setup);
  const auto layout = system->lift_layout();
  if (layout == nullptr || !layout->moves_by(*setup.geometry)) return general(setup);
  const Programs programs = system->lift_programs();
  if (programs == nullptr) return general(setup);
  switch (programs->sizes().unknowns) {
    case 1: return program_loop<1>(setup, system, programs);
    case 2: return program_loop<2>(setup, system, programs);
    case 3: return program_loop<3>(setup, system, programs);
    case 4: return program_loop<4>(setup, system, programs);
    case 6: return program_loop<6>(setup, system, programs);
    default: return program_loop<Eigen::Dynamic>(setup, system, programs);
  }
}

}  // namespace

void add_mechanism_kernels(Registry& registry) {
  SchemeInfo lift = *registry.scheme(Lift::name());
  lift.erased = [general = lift.erased](const KernelSetup& setup) {
    return make_mechanism_lift(setup, general);
  };
  SchemeInfo nonsmooth = scheme_info<Nonsmooth>();
  nonsmooth.erased = lift.erased;
  registry.add(std::move(nonsmooth));
  registry.add(std::move(lift));
}

}  // namespace hamel
