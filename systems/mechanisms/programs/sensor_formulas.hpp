// Measurements of a sensor at a point of a body, recorded: place and yaw, and by derivatives along
// the motion its velocity and acceleration, in the world.
#pragma once

#include <hamel/systems/mechanisms/programs/mechanism_programs.hpp>

namespace hamel::mechanisms {

/// x y z vx vy vz yaw ax ay az; of a state (MechanismState) and behind it xi'. at: as drawn.
FilledProgram record_sensor(const MechanismParts& parts, int link, const Vec3& at);

}  // namespace hamel::mechanisms
