#include <hamel/framework/run/names/system_file.hpp>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/run/names/robot_file.hpp>

namespace hamel {
namespace {

// Where the options begin, the end of the name where there are none.
size_t end_of_path(const std::string& system) {
  std::vector<std::string> extensions = robot_extensions();
  extensions.emplace_back(".toml");
  for (const std::string& extension : extensions)
    if (const size_t at = system.find(extension + "?"); at != std::string::npos)
      return at + extension.size();
  const size_t at = system.find('?');  // of a registered name
  return at == std::string::npos || system.find('/') != std::string::npos ? system.size() : at;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) out.push_back(part);
  return out;
}

}  // namespace

const std::vector<std::string>& robot_extensions() {
  static const std::vector<std::string> all = {".urdf", ".URDF", ".xacro", ".sdf", ".xml"};
  return all;
}

std::string path_of_system(const std::string& system) {
  return system.substr(0, end_of_path(system));
}
std::string extension_of_system(const std::string& system) {
  return std::filesystem::path(path_of_system(system)).extension().string();
}
bool names_file(const std::string& system) {
  return extension_of_system(system) == ".toml" || names_robot(system);
}
bool names_robot(const std::string& system) {
  const auto& all = robot_extensions();
  return std::ranges::find(all, extension_of_system(system)) != all.end();
}

NameOptions options_of_system(const std::string& system) {
  NameOptions out;
  const size_t end = end_of_path(system);
  if (end >= system.size()) return out;
  for (const std::string& part : split(system.substr(end + 1), '&')) {
    const size_t equal = part.find('=');
    if (equal == std::string::npos || equal == 0 || equal + 1 == part.size())
      throw ConfigError({fmt::format(
          "system: '{}' in '{}' is not name=value[,value...], as in robot.urdf?wheel=left,right",
          part, system)});
    for (const std::string& value : split(part.substr(equal + 1), ','))
      out[part.substr(0, equal)].push_back(value);
  }
  return out;
}

std::string with_name_option(const std::string& system, const std::string& option,
                             const std::vector<std::string>& values) {
  const char before = end_of_path(system) == system.size() ? '?' : '&';
  return fmt::format("{}{}{}={}", system, before, option, fmt::join(values, ","));
}

std::string read_system_file(const std::string& system) {
  return read_text_file("system", path_of_system(system));
}

}  // namespace hamel
