// Straight motions by their speed: what `hamel steady SYSTEM --speed v` starts from.
#pragma once

#include <optional>

#include <hamel/framework/mechanics/system.hpp>

namespace hamel {

/// Straight ahead at v m/s, upright: mechanisms that know one number for a start, falling_disk, segway. Else empty.
std::optional<Start> start_at_speed(const SystemModel& model, double speed);

}  // namespace hamel
