// Links that look like wheels. Not installed.
#pragma once

#include <vector>

#include <hamel/systems/mechanisms/urdf/urdf_wheels.hpp>

namespace hamel::mechanisms {

/// Has its name "wheel" in it?
bool is_called_wheel(const RobotLink& link);

/// Difference in height of wheels on one ground, of the radius.
inline constexpr double kNearHeight = 0.1;

/// Cylinders about the axis of a hinge and spheres on a hinge, both about a level axle, at the
/// lowest point of the robot. A fixed sphere is a support without friction. Without those whose
/// fork tips: it hangs on a hinge without limits along the way that they roll (a swivel whose
/// <axis> was left out is along x). tipping: what is said of these.
std::vector<RobotWheel> wheels_by_shape(const Robot& robot,
                                        std::vector<std::string>* tipping = nullptr);
/// Links that are called wheels, none of which turns.
std::vector<std::string> fixed_wheels(const Robot& robot);

/// Links without a cylinder or sphere on a hinge without limits about a level axis, each as --wheel
/// has it: LINK:radius=r, r the height of its axle above the origin of the root where that is above
/// 0. Those called wheels; or else, but with `called`, the lowest.
std::vector<std::string> wheels_by_joint(const Robot& robot, bool called = false);

}  // namespace hamel::mechanisms
