// The joints of a mechanism: a group each, its embedding in the motions of space, the names of its
// numbers.
//
//   kind     group   motion of the child against the parent, in the joint's frame
//   free     se3     any
//   planar   se2     along the plane across the axis, and turning about the axis
//   hinge    so2     turning about the axis
//   slider   r1      along the axis
//   ball     so3     turning about the point
//
// xi of a joint is its left-trivialised velocity, so that the child moves against the parent with
// the twist S xi in the joint's frame on the child, S constant.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/lie/group_info.hpp>
#include <hamel/systems/mechanisms/screw.hpp>

namespace hamel::mechanisms {

enum class JointKind { free, planar, hinge, slider, ball };

/// What a joint's group says of it.
struct JointType {
  GroupInfo group;
  std::shared_ptr<const Geometry>
      geometry;  // with exp: to move about when a mechanism is put together
  std::vector<std::string> columns, rates;  // names of coordinates and velocities
};
const JointType& type_of(JointKind kind);

/// S, 6 x dim: the twist of the child per unit of each velocity.
Eigen::Matrix<double, 6, Eigen::Dynamic> directions(JointKind kind);

/// The motion that an element, as Packing lays it out, stands for.
Rigid motion(JointKind kind, const double* element);

/// A rotation that takes e3 to this axis, of length 1.
Mat<3, 3> frame_along(const Vec3& axis);

}  // namespace hamel::mechanisms
