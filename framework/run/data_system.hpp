// Systems by data alone: a TOML file, no compiler.
//
//   name = "pendulum on a skate"           # left out: the file's
//   group = "se2*so2"                      # any product of registered groups
//   inertia = [0.1, 1, 1, 0.2]             # n principal entries, or n rows of n
//   constraints = [[0, 0, 1, 0]]           # rows of A (left out: none)
//   drift = [0]                            # b of A xi = b (left out: zeros)
//   velocity = [1, 0.5, 0, 0]              # the start: also momentum, configuration
//   [linear]                               # V = sum of weight * column + ...
//   1_x = -2.0                             # N, on the columns of the element (hamel describe se2)
//   [spring]                               # ... 1/2 stiffness (column - rest)^2
//   2_theta = { stiffness = 0.5, rest = 0.1 }
//   [damping]                              # the force -damping xi_i on body velocities 1 to n
//   4 = 0.02
// The options of the run (scheme, step, ...) belong to the command line or --config.
#pragma once

#include <functional>
#include <string>

#include <hamel/framework/run/registry.hpp>

namespace hamel {

/// The system of a TOML text. Throws ConfigError with every mistake, file, line and column.
SystemModel data_system(const Registry& registry, const std::string& text,
                        const std::string& origin);

/// A maker of a file's system; it reads the file when called. The system has no parameters to set.
std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path);

/// The same of a file whose text is at hand.
std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path,
                                                                const std::string& text);

}  // namespace hamel
