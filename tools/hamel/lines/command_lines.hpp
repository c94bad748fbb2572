// The commands of the program by name.
#pragma once

#include <functional>
#include <vector>

#include <CLI/CLI.hpp>

namespace hamel::tools {

using Action = std::function<int()>;

/// A command: its name, its line in `hamel --help`, its options. `define` adds these to its
/// subcommand and returns what runs once they are parsed; it is called when the command line names
/// the command, so that a start does not pay for the options of the others.
struct Command {
  const char* name;
  const char* about;
  Action (*define)(CLI::App&);
};

/// In the order of `hamel --help`.
const std::vector<Command>& commands();

}  // namespace hamel::tools
