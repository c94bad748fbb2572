#include "lines/robot_line.hpp"

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/names/system_file.hpp>

#include "lines/help.hpp"

namespace hamel::tools {

void RobotLine::define(CLI::App& app) {
  app.add_option(
         "--wheel", wheels,
         "a link of robot.urdf that rolls on the ground, with the radius of its cylinder or "
         "sphere; LINK:wheel for a sphere that turns about its joint (repeatable)")
      ->type_name("LINK")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option(
      "--root", root,
      "how the root link of robot.urdf hangs on the ground: planar, free or fixed [planar]");
  group_options(app, "Robot", {"--wheel", "--root"});
}

std::string RobotLine::resolve(const std::string& system) const {
  std::string out = system;
  if (wheels.empty() && root.empty()) return out;
  if (extension_of_system(system) != ".urdf")
    throw ConfigError({fmt::format("{}: for a robot, FILE.urdf; got the system '{}'",
                                   wheels.empty() ? "--root" : "--wheel", system)});
  if (!wheels.empty()) out = with_file_option(out, "wheel", wheels);
  if (!root.empty()) out = with_file_option(out, "root", {root});
  return out;
}

}  // namespace hamel::tools
