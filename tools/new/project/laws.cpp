// Holds the system of my_name.toml to the laws of systems, and runs of it with lift to those of
// lift: they keep group and constraints, and return to their start when they are reversed.
#include <iostream>

#include <hamel/framework/check/scheme_laws.hpp>
#include <hamel/framework/check/system_laws.hpp>
#include <hamel/hamel.hpp>

int main() {
  const hamel::Simulation simulation = hamel::simulate("my_name.toml").scheme("lift");
  const hamel::Run run = simulation.build();
  const hamel::SystemModel& system = run.system();
  const auto geometry = hamel::registry().geometry(system.group.name, "cayley");
  bool good = true;
  for (const auto& laws : {hamel::check_system(system, 5, geometry.get()),
                           hamel::check_scheme(simulation, {2, true}, true, 0.01, 1)}) {
    for (const hamel::LawResult& law : laws) {
      std::cout << law << "\n";
      good = good && law.passed();
    }
  }
  return good ? 0 : 1;
}
