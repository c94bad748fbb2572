// The wheels of a robot: links that roll on the ground. Not installed.
#pragma once

#include <string>
#include <vector>

#include <hamel/systems/mechanisms/urdf_robot.hpp>

namespace hamel::mechanisms {

struct RobotWheel {
  int link = 0;
  bool ball = false;
  double radius = 0;
  Vec3 centre = Vec3::Zero(), axle = Vec3::UnitY();
  double lowest() const;
};

/// Wheels by the names LINK, LINK:wheel, LINK:ball. Adds what is wrong to mistakes.
std::vector<RobotWheel> find_wheels(const Robot& robot, const std::vector<std::string>& names,
                                    const std::string& path, std::vector<std::string>& mistakes);

}  // namespace hamel::mechanisms
