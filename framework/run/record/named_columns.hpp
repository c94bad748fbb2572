// The columns of a run's coordinates and velocities, by the names of its system. Not installed.
#pragma once

#include <vector>

#include <hamel/framework/io/row_file.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// The coordinates and the velocities, the groups configuration and xi.
ColumnGroup element_columns(const SystemModel& system);
ColumnGroup velocity_columns(const SystemModel& system);

/// Gives these two of a file of an earlier release, 4_theta and xi4, the names of its system.
void rename_columns(std::vector<ColumnGroup>& groups, const SystemModel& system);

}  // namespace hamel
