// JSON of hamel steady.
#pragma once

#include <nlohmann/json.hpp>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/systems/by_name.hpp>

#include "steady.hpp"

namespace hamel::tools {

/// sweep: null without --vary; then the linearisation is part of it.
nlohmann::ordered_json steady_json(const SteadyOptions& options, const Simulation& first,
                                   const SystemModel& system, const SteadyMotion& motion,
                                   const SteadySweep* sweep);

}  // namespace hamel::tools
