// Free: any motion, against the axes of the ground.
#pragma once

#include <hamel/groups/se3.hpp>
#include <hamel/systems/mechanisms/joint.hpp>

namespace hamel::mechanisms {

struct FreeJoint {
  using Group = SE3;
  static constexpr bool has_axis = false;
  static std::string name() { return "free"; }
  static std::vector<std::string> columns() { return SE3::columns(); }
  static std::vector<std::string> rates() { return {"w1", "w2", "w3", "v1", "v2", "v3"}; }
  Mat<6, 6> directions() const { return Mat<6, 6>::Identity(); }
  Rigid motion(const SE3Element<double>& g) const { return {g.rotation, g.translation}; }
  static Rigid on_parent(const Rigid&) { return {}; }
  static std::vector<double> coordinates(const Rigid& x) {
    return SE3::coordinates(SE3Element<double>{x.rotation, x.position});
  }
};

}  // namespace hamel::mechanisms
