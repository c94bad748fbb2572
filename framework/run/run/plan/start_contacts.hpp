// Contacts that may slide and open, at a start: their gaps, and the rows that they have there. Not
// installed.
#pragma once

#include <Eigen/Core>

#include <hamel/framework/run/run/plan/plan.hpp>

namespace hamel {

/// Is a contact open, at the values of the holonomic rows? One that is below its ground is a
/// mistake.
bool look_at_gaps(const SystemModel& system, const Eigen::VectorXd& phi, Mistakes& mistakes);

/// Leaves out the rows of the start that a contact does not have there, and those of contacts that
/// follow from others. slip: all rows of contacts that may slide.
void release_rows(const SystemModel& system, const Eigen::VectorXd& phi, bool slip,
                  PlannedStart& planned);

}  // namespace hamel
