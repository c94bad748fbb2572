// A robot as a URDF file has it, in one pose: that of zero joint angles, along the axes of the root
// link. Read by urdfdom (urdf_robot.cpp), written as a mechanism by urdf_mechanism.cpp. Not
// installed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/screw.hpp>

namespace hamel::mechanisms {

struct RobotShape {
  enum class Kind { box, cylinder, sphere, mesh } kind = Kind::mesh;
  Rigid pose;                // a cylinder is along its third axis
  Vec3 size = Vec3::Zero();  // m: edges; radius and length; radius
  bool round() const { return kind == Kind::cylinder || kind == Kind::sphere; }
  double radius() const { return size[0]; }
  Vec3 axis() const { return pose.rotation.col(2); }
};

/// Follows another joint: angle = ratio * (angle of `to`) + offset.
struct RobotMimic {
  std::string to;
  double ratio = 1, offset = 0;
};

/// The joint by which a link hangs on its parent.
struct RobotJoint {
  std::string name;
  std::string kind;  // of mechanisms: hinge, slider, planar, free, weld
  Vec3 at = Vec3::Zero(), axis = Vec3::UnitX();
  double damping = 0;
  double friction = 0;                // N m or N
  std::optional<double> effort = {};  // the most, where it is limited
  std::optional<RobotMimic> mimic = {};
  bool limited = false;
  bool rubs = false;     // its friction is kept
  bool endless = false;  // a hinge that turns right round within its limits
  bool driven = false;   // by a transmission
  bool idle = false;     // fixed, with damping, friction or limits
  bool welded = false;   // by --weld
  bool moves() const { return kind != "weld"; }
  /// Has a coordinate, which a motor may drive.
  bool turns_or_slides() const { return kind == "hinge" || kind == "slider"; }
};

struct RobotLink {
  std::string name;
  int parent = -1;   // before it in the list; -1: the root
  RobotJoint joint;  // not of the root
  Vec3 origin = Vec3::Zero();
  double mass = 0;
  Vec3 centre = Vec3::Zero();
  Mat<3, 3> inertia = Mat<3, 3>::Zero();  // about the mass centre
  std::vector<RobotShape> visuals, collisions;
  /// Its first cylinder or sphere, of the collisions before the visuals; null without one.
  const RobotShape* round_shape() const;
};

struct Robot {
  std::string name;
  std::vector<RobotLink> links;      // parents first, the root is the first
  std::vector<std::string> rounded;  // whose angles were taken as multiples of a right angle
  std::vector<std::string> cleaned;  // macros taken out of names
  bool root_free = false;

  const RobotLink& link(int i) const { return links[static_cast<size_t>(i)]; }
  RobotLink& link(int i) { return links[static_cast<size_t>(i)]; }
  int count() const { return static_cast<int>(links.size()); }
  std::vector<std::string> link_names() const;
  /// Names of all joints that move.
  std::vector<std::string> joint_names() const;
  /// The link that hangs on a joint of this name, else -1.
  int link_of_joint(const std::string& of) const;
};

/// Names for a note: "a", "b".
std::string quoted(const std::vector<std::string>& names);

/// Reads the text of a URDF file. Throws ConfigError with every mistake.
Robot read_robot(const std::string& text, const std::string& path);

}  // namespace hamel::mechanisms
