// Extensions under which descriptions of robots are found. The reader decides by the text, and
// refuses by name macros, SDF and MJCF.
#pragma once

#include <string>
#include <vector>

namespace hamel {

/// ".urdf" and others.
const std::vector<std::string>& robot_extensions();

/// True of the name of a file with one of them, whatever options are behind it.
bool names_robot(const std::string& system);

}  // namespace hamel
