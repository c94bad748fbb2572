// The simulation that a run file was recorded from. Not installed.
#pragma once

#include <hamel/framework/run/record/run_file.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

/// Made of the texts in the file: the files that it was made of may be others by now, or gone.
Simulation recorded_simulation(const RunFile& run, const Registry& registry);

}  // namespace hamel
