// Systems that are files, by their names: "my_system.toml"; or in the format of another program,
// with what that format leaves open behind a question mark, "robot.urdf?wheel=left,right&root=free"
// (registry.hpp, FileFormat). Such a name is accepted wherever a system is named.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace hamel {

/// Options of a foreign format by name, each a list.
using FileOptions = std::map<std::string, std::vector<std::string>>;

/// True of the name of a file, false of what may be a registered name.
bool names_file(const std::string& system);
/// "robot.urdf" of "robot.urdf?wheel=left".
std::string path_of_system(const std::string& system);
/// ".urdf" of the same.
std::string extension_of_system(const std::string& system);
/// ConfigError for text behind the question mark that is not name=value[,value...][&name=...].
FileOptions options_of_system(const std::string& system);
/// The name with one more option.
std::string with_file_option(const std::string& system, const std::string& option,
                             const std::vector<std::string>& values);

/// The text of the file of that name. ConfigError as read_text_file has it.
std::string read_system_file(const std::string& system);

}  // namespace hamel
