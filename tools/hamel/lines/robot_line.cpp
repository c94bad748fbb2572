#include "lines/robot_line.hpp"

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/names/robot_file.hpp>
#include <hamel/framework/run/names/system_file.hpp>

#include "lines/help.hpp"

namespace hamel::tools {

const std::vector<std::string>& RobotLine::keys() {
  static const std::vector<std::string> all = {"wheel",          "motor", "weld", "weld_all_but",
                                               "joint_friction", "root",  "hold"};
  return all;
}

void RobotLine::define(CLI::App& app) {
  const auto list = [&](const char* flag, std::vector<std::string>& names, const char* type,
                        const char* text) {
    app.add_option(flag, names, text)->type_name(type)->delimiter(',')->allow_extra_args(false);
  };
  list("--wheel", wheels, "LINK[:kind][,radius=r]",
       "a link of robot.urdf that rolls on the ground, with the radius of its cylinder or sphere, "
       "or this one (m); kind: wheel, ball, omni, mecanum, with angle=a (rad) of its rollers; "
       "friction=mu: it slides too; auto: the links that look like wheels (repeatable)");
  list(
      "--motor", motors, "JOINT",
      "a joint with a motor [the wheels' joints, and those with a transmission or an effort limit] "
      "(repeatable)");
  list("--weld", welds, "JOINT", "a joint that is rigid in the drawn pose (repeatable)");
  list("--weld-all-but", movable, "JOINT", "all other joints are rigid (repeatable)");
  list("--joint-friction", rubbing, "JOINT",
       "a joint of robot.urdf that keeps its dry friction, <dynamics friction=...>; all: every one "
       "that states it (repeatable)");
  app.add_option(
      "--root", root,
      "how the root link of robot.urdf hangs on the ground: planar, free or fixed [planar]");
  list("--hold", held, "JOINT[=value]",
       "a hinge or slider of a mechanism that is locked, where the run starts or at this angle "
       "(rad) or position (m) (repeatable)");
  group_options(
      app, "Robot",
      {"--wheel", "--motor", "--weld", "--weld-all-but", "--joint-friction", "--root", "--hold"});
}

std::string RobotLine::resolve(const std::string& system) const {
  std::string out = system;
  const std::vector<std::string> roots =
      root.empty() ? std::vector<std::string>{} : std::vector<std::string>{root};
  for (const auto& [option, values] :
       {std::pair{"wheel", &wheels}, std::pair{"motor", &motors}, std::pair{"weld", &welds},
        std::pair{"weld-all-but", &movable}, std::pair{"joint-friction", &rubbing},
        std::pair{"root", &roots}, std::pair{"hold", &held}}) {
    if (values->empty()) continue;
    if (option != std::string_view("hold") && !names_robot(system))
      throw ConfigError(
          {fmt::format("--{}: for a robot, FILE.urdf; got the system '{}'", option, system)});
    out = with_name_option(out, option, *values);
  }
  return out;
}

}  // namespace hamel::tools
