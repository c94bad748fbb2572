// The mechanisms of the library: the files of this folder, compiled in.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace hamel::mechanisms {

/// (name, text) of each file.
const std::vector<std::pair<std::string, std::string>>& library();

}  // namespace hamel::mechanisms
