// Ball: turning about the point.
#pragma once

#include <hamel/groups/so3.hpp>
#include <hamel/systems/mechanisms/joint.hpp>

namespace hamel::mechanisms {

struct BallJoint {
  using Group = SO3;
  static constexpr bool has_axis = false;
  static std::string name() { return "ball"; }
  static std::vector<std::string> columns() { return SO3::columns(); }
  static std::vector<std::string> rates() { return {"w1", "w2", "w3"}; }
  Mat<6, 3> directions() const { return Mat<6, 6>::Identity().leftCols<3>(); }
  Rigid motion(const Mat<3, 3>& rotation) const { return {rotation, Vec3::Zero()}; }
};

}  // namespace hamel::mechanisms
