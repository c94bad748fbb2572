// A robot as a URDF file has it, in one pose: that of zero joint angles, along the axes of the root
// link. Read by urdfdom (urdf_robot.cpp), written as a mechanism by urdf.cpp. Not installed.
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

/// The joint by which a link hangs on its parent.
struct RobotJoint {
  std::string name;
  std::string kind;  // of mechanisms: hinge, slider, planar, free, weld
  Vec3 at = Vec3::Zero(), axis = Vec3::UnitX();
  double damping = 0;
  std::optional<double> effort = {};  // the most, where it is limited
  bool limited = false, friction = false;
  bool moves() const { return kind != "weld"; }
};

struct RobotLink {
  std::string name;
  int parent = -1;   // before it in the list; -1: the root
  RobotJoint joint;  // not of the root
  double mass = 0;
  Vec3 centre = Vec3::Zero();
  Mat<3, 3> inertia = Mat<3, 3>::Zero();  // about the mass centre
  std::vector<RobotShape> visuals, collisions;
};

struct Robot {
  std::string name;
  std::vector<RobotLink> links;      // parents first, the root is the first
  std::vector<std::string> rounded;  // whose angles were taken as multiples of a right angle
};

/// Reads the text of a URDF file. Throws ConfigError with every mistake.
Robot read_robot(const std::string& text, const std::string& path);

}  // namespace hamel::mechanisms
