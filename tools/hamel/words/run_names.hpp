// Names of compared runs: by what differs between them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <hamel/framework/run/record/result.hpp>

namespace hamel::tools {

/// "lift, h = 0.1" and "lift, h = 0.01": the options and parameters in which the runs differ. Runs
/// not distinguished by these are called by their files too, with as many folders as distinguish
/// them; one file given twice is numbered.
std::vector<std::string> names_of(const std::vector<const Result*>& runs,
                                  std::vector<std::filesystem::path> files);

}  // namespace hamel::tools
