// Screw: turning about the axis, and along it by `pitch` for each radian.
#pragma once

#include <cmath>

#include <hamel/groups/rn.hpp>
#include <hamel/systems/mechanisms/joint.hpp>

namespace hamel::mechanisms {

struct MyJoint {
  using Group = Rn<1>;
  double pitch = 0.1;  // m/rad
  static std::string name() { return "my_joint"; }
  static std::vector<std::string> columns() { return {"angle"}; }
  static std::vector<std::string> rates() { return {"rate"}; }
  void fields(auto& f) { f("pitch", pitch, "m/rad", "advance along the axis"); }
  Vec<6> directions() const { return Vec<6>::Unit(2) + pitch * Vec<6>::Unit(5); }
  Rigid motion(const Vec<1>& angle) const {
    return {turn(std::cos(angle[0]), std::sin(angle[0])), {0, 0, pitch * angle[0]}};
  }
};

}  // namespace hamel::mechanisms
