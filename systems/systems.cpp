// The composition root: the one file that links everything by name.
#include <hamel/framework/schemes/baselines.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/product_retraction.hpp>
#include <hamel/solvers/ceres.hpp>
#include <hamel/solvers/ceres_tiny.hpp>
#include <hamel/solvers/hybrid.hpp>
#include <hamel/solvers/nlopt.hpp>
#include <hamel/systems/ball_on_turntable.hpp>
#include <hamel/systems/chaplygin_ball.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/contact_oscillator.hpp>
#include <hamel/systems/differential_drive.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/heisenberg_particle.hpp>
#include <hamel/systems/kernels/groups.hpp>
#include <hamel/systems/knife_edge_on_incline.hpp>
#include <hamel/systems/n_trailer.hpp>
#include <hamel/systems/nonholonomic_particle.hpp>
#include <hamel/systems/rattleback.hpp>
#include <hamel/systems/roller_racer.hpp>
#include <hamel/systems/rolling_ball.hpp>
#include <hamel/systems/rolling_disk.hpp>
#include <hamel/systems/routh_sphere.hpp>
#include <hamel/systems/segway.hpp>
#include <hamel/systems/simulate.hpp>
#include <hamel/systems/snakeboard.hpp>
#include <hamel/systems/suslov.hpp>
#include <hamel/systems/suslov_in_potential.hpp>
#include <hamel/systems/unicycle_3d.hpp>
#include <hamel/systems/veselova.hpp>

namespace hamel {
namespace {

template <class S>
SolverInfo words_of(const S& solver) {
  SolverInfo info{solver.name(), solver.summary(), solver.source(),
                  nullptr,       solver.method(),  solver.stops()};
  if constexpr (requires { solver.package(); }) info.package = solver.package();
  return info;
}

template <class S>
void add_solver(Registry& registry, const S& solver) {
  SolverInfo info = words_of(solver);
  if constexpr (requires { solver.make(); }) info.make = [solver] { return solver.make(); };
  registry.add(std::move(info));
}

void add_solvers(Registry& registry) {
  add_solver(registry, Newton{});
  add_solver(registry, Hybrid{});
#ifdef HAMEL_HAS_CERES
  add_solver(registry, Ceres{});
  add_solver(registry, CeresTiny{});
#else
  registry.add_absent(words_of(Ceres{}));
  registry.add_absent(words_of(CeresTiny{}));
#endif
#ifdef HAMEL_HAS_NLOPT
  for (const Nlopt& algorithm : kNlopt) add_solver(registry, algorithm);
#else
  for (const Nlopt& algorithm : kNlopt) registry.add_absent(words_of(algorithm));
#endif
}

Registry make_registry() {
  Registry registry;
  add_so2(registry);
  add_so3(registry);
  add_se2(registry);
  add_se3(registry);
  add_rn(registry);
  add_se2_so2(registry);
  add_geometry<Heisenberg>(registry);
  add_general(registry);

  Schemes::for_each(
      [&]<class Scheme>(std::type_identity<Scheme>) { registry.add(scheme_info<Scheme>()); });
  registry.add_scheme_alias("dla", Lift::name());  // discrete Lagrange-d'Alembert
  add_general_scheme<EnergyPreserving>(registry);
  add_general_scheme<Gni>(registry);
  add_general_scheme<Reversible>(registry);
  add_general_scheme<Rk4Projected>(registry);
  add_general_scheme<Rkmk4>(registry);
  add_solvers(registry);

  add_system<BallOnTurntable>(registry);
  add_system<ChaplyginBall>(registry);
  add_system<ChaplyginSleigh>(registry);
  add_system<ContactOscillator>(registry);
  add_system<DifferentialDrive>(registry);
  add_system<FallingDisk>(registry);
  add_system<HeisenbergParticle>(registry);
  add_system<KnifeEdgeOnIncline>(registry);
  add_system<NTrailer>(registry);
  add_system<NonholonomicParticle>(registry);
  add_system<Rattleback>(registry);
  add_system<RollerRacer>(registry);
  add_system<RollingBall>(registry);
  add_system<RollingDisk>(registry);
  add_system<RouthSphere>(registry);
  add_system<Segway>(registry);
  add_system<Snakeboard>(registry);
  add_system<Suslov>(registry);
  add_system<SuslovInPotential>(registry);
  add_system<Unicycle3d>(registry);
  add_system<Veselova>(registry);
  return registry;
}

}  // namespace

Registry& registry() {
  static Registry all = make_registry();
  return all;
}

}  // namespace hamel
