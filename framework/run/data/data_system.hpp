// Systems by data alone: a TOML file, no compiler.
//
//   name = "kick scooter"              # left out: the file's
//   group = "se2*so2"                  # any product of registered groups
//   coordinates = ["theta", "x", "y", "steer"]
//                                      # left out: the group's columns
//   rates = ["omega", "v1", "v2", "steer'"]
//                                      # left out: these, which follow from group and coordinates
//   inertia = ["I", "m", "m", 0.02]    # n principal entries, or n rows of n: I(g)
//   constraints = [[0, 0, 1, 0], ["-l*cos(steer)", "sin(steer)", "-cos(steer)", 0]]
//                                      # rows A(t, g)
//   drift = [0, "0.1*sin(t)"]          # b(t, g) of A xi = b (left out: zeros)
//   holonomic = ["z - r"]              # phi(g) = 0; their differentials join A
//   potential = "m*g*sin(slope)*x"     # V(g)
//   force = ["-c*omega", 0, 0, "torque"]
//                                      # f(t, g, xi) in the dual, n entries
//   state = [{ name = "lag", rate = "(steer - lag)/0.2" }]
//                                      # scalars behind the coordinates; rates linear in velocities
//   configuration = [0, 0, 0, "alpha"] # the start: also velocity, momentum
//   contacts = [1]                     # the rows, from 1, whose multiplier is a normal reaction
//   [[contact]]                        # rows that slide, open and strike: friction
//   tangential = [1]                   # (toml_contacts.hpp)
//   from_above = true                  # how it is drawn: also floor; bodies: data_drawing.hpp
//   [parameters]                       # numbers to set, study and sweep (toml_parameters.hpp)
//   m = { value = 2, unit = "kg", meaning = "mass", least = 0 }
//   [inputs]                           # what a run may be driven by; allowed in force and drift
//   torque = { unit = "N m", meaning = "on the handlebar" }
//   [events]                           # zero at the event; direction +1, -1, or 0 for both ways
//   straight = { value = "steer", meaning = "the handlebar is straight", direction = 0 }
//   [invariants]                       # first integrals
//   energy = "0.5*m*(v1^2 + v2^2)"
// Every number may be a formula (io/expression.hpp) of the parameters; the entries of matrices and
// vectors also of the coordinates, of t where it is listed above, of the inputs, those of force,
// events and invariants of the rates. Differentials are exact. The options of the run (scheme,
// step, ...) belong to the command line or --config.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <hamel/framework/run/names/registry.hpp>

namespace hamel {

/// The system of a TOML text. Throws ConfigError with every mistake, file, line and column.
SystemModel data_system(const Registry& registry, const std::string& text,
                        const std::string& origin, const Parameters& given = {});

/// A maker of a file's system; it reads the file when called. A file of another kind
/// (Registry::file_kinds) or of another format (Registry::file_formats) is read as that.
std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path);

/// Reads a file whose text is at hand in the same way.
std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path,
                                                                const std::string& text);

/// The text of a file in another format, "robot.urdf?wheel=left", as TOML. ConfigError with every
/// mistake, or the package that this build lacks.
FileFormat::Converted converted(const Registry& registry, const std::string& system,
                                const std::string& text);

}  // namespace hamel
