// Systems whose text is at hand, and what is stated about the system of a run: for programs that
// keep their systems elsewhere than in files, such as tools/python. Standard-library types only.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/systems/by_name.hpp>

namespace hamel {

/// A system by data, or a mechanism, as TOML; the origin, "skate.toml", is its name in messages and
/// records. Throws ConfigError with every mistake when the run is built.
HAMEL_API Simulation simulate_text(const std::string& text, const std::string& origin);

/// Description of the system of a run, a result or a mechanism, with its units. Summary, formula,
/// known and source are those of a registered system: empty here.
struct ModelDescription : SystemDescription {
  std::vector<std::string> coordinate_units, velocity_units;
  /// Further names that are read, 4_theta, xi4, and their places: coordinates, then velocities.
  std::vector<std::pair<std::string, std::size_t>> other_names;
  std::vector<std::string> parts;  // the bodies of a mechanism
};
HAMEL_API ModelDescription describe_model(const SystemModel& model);

}  // namespace hamel
