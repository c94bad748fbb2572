// hamel plan; command_lines.cpp reads the command line into its options.
#pragma once

#include <string>

namespace hamel::tools {

struct PlanOptions {
  std::string file;
  std::string output, report, track;  // -o, --report, --track
  bool json = false, quiet = false, verbose = false;
};
int plan(const PlanOptions& options);

}  // namespace hamel::tools
