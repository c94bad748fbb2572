// Robot of a URDF file as a mechanism in TOML. Not installed.
#pragma once

#include <string>

#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/names/system_file.hpp>
#include <hamel/systems/mechanisms/urdf/urdf_robot.hpp>

namespace hamel::mechanisms {

/// Throws ConfigError with every mistake in the options, and of the robot with them.
FileFormat::Converted mechanism_of(Robot robot, const std::string& path,
                                   const NameOptions& options);

}  // namespace hamel::mechanisms
