// Hinge: turning about the axis.
#pragma once

#include <hamel/groups/so2.hpp>
#include <hamel/systems/mechanisms/joint.hpp>

namespace hamel::mechanisms {

struct HingeJoint {
  using Group = SO2;
  static std::string name() { return "hinge"; }
  static std::vector<std::string> columns() { return {"angle"}; }
  static std::vector<std::string> rates() { return {"rate"}; }
  Vec<6> directions() const { return Vec<6>::Unit(2); }
  Rigid motion(const SO2Element<double>& g) const { return {turn(g.c, g.s), Vec3::Zero()}; }
};

}  // namespace hamel::mechanisms
