// hamel steady; main.cpp reads the command line into its options.
#pragma once

#include <string>

#include <hamel/framework/run/names/config.hpp>

namespace hamel::tools {

struct SteadyOptions {
  Config config;       // system, parameters, start
  std::string vary;    // name=from:to:count
  std::string report;  // --report
  bool json = false;
};
int steady(const SteadyOptions& options);

}  // namespace hamel::tools
