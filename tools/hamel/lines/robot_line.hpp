// --wheel, --motor, --weld, --weld-all-but, --joint-friction and --root, of commands that take a
// system: what a robot in URDF leaves open; and --hold, joints of any mechanism that are locked.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace hamel::tools {

struct RobotLine {
  std::vector<std::string> wheels, motors, welds, movable, rubbing, held;
  std::string root;

  /// Keys of these in a file of --config.
  static const std::vector<std::string>& keys();

  void define(CLI::App& app);
  /// The name of the system with these: robot.urdf?wheel=left,right&root=free. Throws ConfigError
  /// where they are given for what is no robot.
  std::string resolve(const std::string& system) const;
};

}  // namespace hamel::tools
