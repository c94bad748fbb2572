// The composition root: the one file that links everything by name.
#include <hamel/solvers/ceres.hpp>
#include <hamel/solvers/ceres_tiny.hpp>
#include <hamel/solvers/hybrid.hpp>
#include <hamel/solvers/nlopt.hpp>
#include <hamel/systems/by_name.hpp>
#include <hamel/systems/kernels/mechanisms.hpp>
#include <hamel/systems/kernels/units.hpp>
#ifdef HAMEL_HAS_XSIMD
#include <hamel/systems/lanes/lane_tables.hpp>
#endif
#include <hamel/systems/mechanisms/library.hpp>
#include <hamel/systems/mechanisms/mechanism_file.hpp>
#include <hamel/systems/mechanisms/urdf/urdf.hpp>
#include <hamel/systems/n_trailer.hpp>
#include <hamel/systems/recorded_groups.hpp>
#include <hamel/systems/recorded_systems.hpp>

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
  if constexpr (requires { solver.found(); }) {
    if (!solver.found()) return registry.add_absent(std::move(info));
  }
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

// Files with parts are mechanisms; those of the library go by name.
void add_mechanisms(Registry& registry) {
  registry.add(FileKind{
      {"body", "joint", "wheel", "roller", "ball", "blade", "loop"}, {"hold"}, mechanism_from});
  for (const FileFormat& format : urdf_formats()) registry.add(format);
  for (const auto& [name, text] : mechanisms::library()) {
    registry.add_deferred(
        name, [&name = name, &text = text] { return mechanism_info(text, name + ".toml"); });
  }
}

Registry make_registry() {
  Registry registry;
  add_groups(registry);
  add_recorded_groups();
  add_erased_schemes(registry);
  registry.add_scheme_alias("dla", Lift::name());  // discrete Lagrange-d'Alembert
  add_solvers(registry);

  add_left_invariant(registry);
  add_particles(registry);
  add_balls(registry);
  add_disk_and_rattleback(registry);
  add_vehicles(registry);
  add_system<NTrailer>(registry);
  add_mechanisms(registry);
  add_mechanism_kernels(registry);
  add_recorded_systems();
#ifdef HAMEL_HAS_XSIMD
  add_library_lanes(registry);
#endif
  return registry;
}

}  // namespace

Registry& registry() {
  static Registry all = make_registry();
  return all;
}

}  // namespace hamel
