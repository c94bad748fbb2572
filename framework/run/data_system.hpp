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
#include <vector>

#include <hamel/framework/run/registry.hpp>

namespace hamel {

/// Another kind of file that describes a system, told by a key that it has and others do not: "body" of mechanisms.
struct FileKind {
  std::string key;
  /// Throws ConfigError with every mistake, file, line and column.
  std::function<SystemModel(const std::string& text, const std::string& origin,
                            const Parameters& given)>
      read;
  std::vector<SystemInfo>
      library;  // files that go by name as systems do (Registry::system), listed apart
};
const std::vector<FileKind>& file_kinds();
/// Not thread-safe.
void add_file_kind(FileKind kind);

/// The system of a TOML text. Throws ConfigError with every mistake, file, line and column.
SystemModel data_system(const Registry& registry, const std::string& text,
                        const std::string& origin);

/// A maker of a file's system; it reads the file when called. A file of another kind (file_kinds) is read as
/// that; a system by data has no parameters to set.
std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path);

/// The same of a file whose text is at hand.
std::function<SystemModel(const Parameters&)> data_system_maker(const Registry& registry,
                                                                const std::string& path,
                                                                const std::string& text);

}  // namespace hamel
