// hamel steady; command_lines.cpp reads the command line into its options.
#pragma once

#include <optional>
#include <string>

#include <hamel/framework/run/names/config.hpp>

namespace hamel::tools {

struct SteadyOptions {
  Config config;          // system, parameters, start
  std::string vary;       // name=from:to:count
  bool branches = false;  // follow those that cross it, too
  std::string report;     // --report
  bool json = false, verbose = false;
  std::optional<double> sample_time;  // of the discrete pair, in s
};
int steady(const SteadyOptions& options);

}  // namespace hamel::tools
