// The wheels of a robot: links that roll on the ground. Not installed.
//
//   LINK[:kind][:radius=r][:angle=a]   commas for the colons too: LINK:kind,radius=r
//   kind   wheel, ball, omni (slips along its axle), mecanum (rollers at the angle pi/4, whose sign
//          is that of the usual mounting: rollers in contact lie across the diagonals)
//   radius left out, that of the link's first cylinder or sphere, of the collisions before the
//          visuals
//   friction=mu   it slides at that, [:friction=mu] (left out: it never slides)
//   auto   the links that look like wheels: wheels_by_shape; auto[:friction=mu]
// A wheel turns about the axis of a hinge between it and the root, or with a free root.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/urdf/urdf_robot.hpp>

namespace hamel::mechanisms {

struct RobotWheel {
  enum class Kind { wheel, ball, omni, mecanum } kind = Kind::wheel;
  int link = 0;
  double radius = 0;
  Vec3 centre = Vec3::Zero(), axle = Vec3::UnitY();
  double angle = 0;                         // rad, of the rollers against the plane of the wheel
  std::optional<double> friction = {};      // with the ground
  std::vector<std::string> corrected = {};  // notes on what is drawn otherwise
  int turns = -1;  // the link on the hinge about the axle, of a ball on a hinge; -1: none
  /// Its lowest point as drawn, below its centre by this much.
  double depth() const;
  double lowest() const { return centre[2] - depth(); }
};

/// A wheel by its link and what is given of it. Adds what is wrong to mistakes, without the path.
struct WheelWords {
  std::string name;  // of the link
  std::string kind = {};
  std::optional<double> radius = {}, angle = {}, friction = {};
};
std::optional<RobotWheel> wheel_of(const Robot& robot, int link, const WheelWords& words,
                                   std::vector<std::string>& mistakes);

/// Wheels by their names. Adds what is wrong to mistakes; notes on what was chosen.
std::vector<RobotWheel> find_wheels(const Robot& robot, const std::vector<std::string>& names,
                                    const std::string& path, std::vector<std::string>& mistakes,
                                    std::vector<std::string>& notes);

/// Lets wheels that hang less than a tenth of their radius above the lowest one touch the ground
/// there, by a larger radius, with a note; others are a mistake.
void level_wheels(const Robot& robot, std::vector<RobotWheel>& wheels, const std::string& path,
                  std::vector<std::string>& mistakes, std::vector<std::string>& notes);

}  // namespace hamel::mechanisms
