// Command lines of what is written as a page or a picture of its own: report, live.
#pragma once

#include "lines/command_lines.hpp"

namespace hamel::tools {

Action define_report(CLI::App& app);
Action define_live(CLI::App& app);

}  // namespace hamel::tools
