// Runs by name, and what there is by name. Standard-library types only.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/mechanics/input_table.hpp>
#include <hamel/framework/mechanics/parameters.hpp>
#include <hamel/framework/run/run/simulation.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>

namespace hamel {

/// The library's registry, filled on first use; a program may add to it (add_group, add_system,
/// ...). Not thread-safe while something is being added.
HAMEL_API Registry& registry();

/// A registered system, or one by data ("my_system.toml").
inline Simulation simulate(std::string system) { return {registry(), std::move(system)}; }

/// A mechanism by parts.
HAMEL_API Simulation simulate(const Mechanism& mechanism);

// Names of what is registered, sorted. `hamel list` prints the same.
HAMEL_API std::vector<std::string> groups();
/// Retractions of a group, also of a product "se2*so2^3"; without one all.
HAMEL_API std::vector<std::string> retractions(const std::string& group = "");
HAMEL_API std::vector<std::string> schemes();
HAMEL_API std::vector<std::string> solvers();
/// Registered systems, those of files too.
HAMEL_API std::vector<std::string> systems();

/// Description of a system.
struct SystemDescription {
  std::string name, group;
  std::string summary, formula, known, source;
  std::vector<Field> parameters;  // with their defaults
  std::vector<InputField> inputs;
  std::vector<std::string> coordinates;  // columns of the element
  std::vector<std::string> velocities;   // components of xi, in order
  std::vector<std::string> events;
};
/// ConfigError with the nearest name where there is none.
HAMEL_API SystemDescription describe_system(const std::string& name);

}  // namespace hamel
