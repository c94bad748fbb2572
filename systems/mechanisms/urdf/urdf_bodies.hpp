// Bodies of a robot and what is welded to them, as entries of TOML tables. Not installed.
#pragma once

#include <set>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/urdf/urdf_robot.hpp>

namespace hamel::mechanisms {

std::string spelled(double x);
std::string spelled(const Vec3& v);

class RobotBodies {
 public:
  /// Takes a robot whose root link is the ground, or not; renames a link named ground.
  RobotBodies(Robot& robot, bool root_is_ground);

  /// The body of a link as a quoted name; of a frame, without mass and shape, the one that it is
  /// welded to.
  std::string name_of(int link) const;

  std::vector<std::string> bodies;  // entries
  std::vector<std::string> welds;   // entries of joints, of further shapes to their bodies
  std::vector<std::string> renamed, undrawn, turned;  // links

 private:
  static bool is_frame(const RobotLink& l);
  void find_bodies();
  std::string unused(std::string name);
  void name_bodies();
  std::string words_of(const RobotShape& shape, const RobotLink& l);
  const std::vector<RobotShape>& drawn_shapes(const RobotLink& l);
  void write(const RobotLink& l);

  Robot& robot_;
  bool root_is_ground_;
  std::vector<int> bodies_of_;
  std::set<std::string> taken_;
};

}  // namespace hamel::mechanisms
