// Planar: along the plane across the axis, and turning about the axis; against the parent's own
// origin, at the height of the joint.
#pragma once

#include <hamel/groups/se2.hpp>
#include <hamel/systems/mechanisms/joint.hpp>

namespace hamel::mechanisms {

struct PlanarJoint {
  using Group = SE2;
  static std::string name() { return "planar"; }
  static std::vector<std::string> columns() { return SE2::columns(); }
  static std::vector<std::string> rates() { return {"omega", "v1", "v2"}; }
  Mat<6, 3> directions() const { return Mat<6, 6>::Identity().middleCols<3>(2); }
  Rigid motion(const SE2Element<double>& g) const {
    return {turn(g.rotation.c, g.rotation.s), {g.translation[0], g.translation[1], 0}};
  }
  static Rigid on_parent(const Rigid& on_child) {
    const Vec3 axis = on_child.rotation.col(2);
    return {on_child.rotation, axis.dot(on_child.position) * axis};
  }
  static std::vector<double> coordinates(const Rigid& x) {
    return {0, x.position[0], x.position[1]};
  }
};

}  // namespace hamel::mechanisms
