// A start by names: coordinates and velocities "NAME=VALUE", the others as usual. Not installed.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/names/config.hpp>

namespace hamel {

/// The values, by the names of columns. Throws ConfigError with all mistakes.
std::map<std::string, double> values_by_name(const SystemModel& system,
                                             const std::vector<std::string>& texts);

/// The start of Config::start_values, also beside a speed. Throws ConfigError where a name or value
/// does not fit, or the rows forbid such a motion.
SystemStart start_by_name(const SystemModel& system, const Config& config);

}  // namespace hamel
