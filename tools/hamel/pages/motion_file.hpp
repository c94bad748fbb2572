// File of the motion of a run alone: a film, a picture or a page.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/run/record/result.hpp>

#include "commands.hpp"

namespace hamel::tools {

/// Mistakes of the options and of what is not installed, before anything is read.
std::vector<std::string> motion_mistakes(const ReportOptions& options, const std::string& path);

/// Draws the motion and writes it in the format of the path's extension. ConfigError where the
/// system has no drawing or a time is outside the run.
void write_motion(const Result& result, const ReportOptions& options, const std::string& path);

}  // namespace hamel::tools
