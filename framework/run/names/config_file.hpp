// The file of --config: the options of a run, and those of the command that carries it out.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <hamel/framework/run/names/config.hpp>

namespace hamel {

/// Option of a command in a file: texts (a flag is "true"), and file, line, column.
struct CommandOption {
  std::vector<std::string> values = {};
  std::string place = {};
};
/// Options of a command that are none of a run, by name ("output").
using CommandOptions = std::map<std::string, CommandOption>;

/// The configuration in a file. options: the names that it may have beside those of Config; they
/// receive what it says of them. Throws ConfigError with all mistakes, each with its place.
HAMEL_API Config read_config_file(const std::string& path, CommandOptions& options);

}  // namespace hamel
