// The reason why the steps of a run have become so small that it would not end. Not installed.
#pragma once

#include <optional>
#include <string>

#include <hamel/framework/loop/kernel.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// At the state of the kernel, which takes a step; usual: the size from which steps have shrunk, 0
/// where they have not. Rows that are nearly dependent, by name and
/// condition; a force that jumps, by component and formula; a tolerance below the round-off of the
/// equations of motion, with the least that is not; else that none of these was found.
std::string reason_of_small_steps(const SystemModel& system, const KernelSetup& setup,
                                  Kernel& kernel, double usual);

/// The reason why many tries are rejected, or steps have shrunk from a usual size (0: they have
/// not): a tolerance below round-off; none where it is not, or where rows are nearly dependent,
/// which the steps show.
std::optional<std::string> reason_of_round_off(const SystemModel& system, const KernelSetup& setup,
                                               Kernel& kernel, double usual);

}  // namespace hamel
