// Straight motions by their speed: what a run with `speed` starts from.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <hamel/framework/mechanics/system.hpp>

namespace hamel {

/// Straight ahead at v m/s from time t on: of mechanisms with a root joint that runs ahead, and of systems by these
/// names. Empty where the system knows no such motion.
std::optional<Start> start_at_speed(const SystemModel& model, double speed, double t = 0);

using StartAtSpeed = std::function<Start(const SystemModel& model, double speed)>;
void add_start_at_speed(const std::string& system, StartAtSpeed start);

}  // namespace hamel
