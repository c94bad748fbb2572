// Joints of a robot that are welded, and those that a motor drives. Not installed.
#pragma once

#include <string>
#include <vector>

#include <hamel/systems/mechanisms/urdf/urdf_wheels.hpp>

namespace hamel::mechanisms {

/// Keeps the dry friction that the file states for these joints, or all. Joints that are rigid
/// have none.
void keep_friction(Robot& robot, const std::vector<std::string>& names, const std::string& path,
                   std::vector<std::string>& mistakes);

/// Makes joints rigid in the drawn pose: those of `weld`, or all that move but `all_but`, and those
/// that mimic one of them, with a note. Adds what is wrong to mistakes.
void weld_joints(Robot& robot, const std::vector<std::string>& weld,
                 const std::vector<std::string>& all_but, const std::string& path,
                 std::vector<std::string>& mistakes, std::vector<std::string>& notes);

/// Links whose joint has a motor: those of `names`, if any; else, first, the hinges of wheels, then
/// the others with a transmission or an effort limit. A caster (a wheel that trails a hinge about
/// an upright axis without either) has none, nor have hinges of wheels without either where others
/// have one, nor joints that mimic, nor those with an effort limit of 0. Without wheels, and
/// without any transmission and effort limit, all joints have a motor. At most kMostInputs, with a
/// note.
std::vector<int> driven_joints(const Robot& robot, const std::vector<RobotWheel>& wheels,
                               const std::vector<std::string>& names, const std::string& path,
                               std::vector<std::string>& mistakes, std::vector<std::string>& notes);

}  // namespace hamel::mechanisms
