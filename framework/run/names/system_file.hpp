// Names of systems: registered ones, and files, "my_system.toml", or in the format of another
// program (registry.hpp, FileFormat); with options behind a question mark,
// "robot.urdf?wheel=left,right&root=free", "bicycle?hold=steer=0.1". Such a name is accepted
// wherever a system is named.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// True of the name of a file, false of what may be a registered name.
bool names_file(const std::string& system);
/// "robot.urdf" of "robot.urdf?wheel=left", "bicycle" of "bicycle?hold=steer".
std::string path_of_system(const std::string& system);
/// ".urdf" of the same.
std::string extension_of_system(const std::string& system);
/// ConfigError for text behind the question mark that is not name=value[,value...][&name=...].
NameOptions options_of_system(const std::string& system);
/// The name with one more option.
std::string with_name_option(const std::string& system, const std::string& option,
                             const std::vector<std::string>& values);

/// The text of the file of that name. ConfigError as read_text_file has it.
std::string read_system_file(const std::string& system);

}  // namespace hamel
