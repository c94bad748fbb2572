// hamel fit; command_lines.cpp reads the command line into its options.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/inverse/fit.hpp>

#include "lines/run_line.hpp"

namespace hamel::tools {

struct FitOptions {
  Config config;
  FitRequest request;
  std::string output, report;  // -o, --report
  bool json = false, quiet = false, verbose = false;
};

/// Its options on the command line.
class FitLine {
 public:
  void define(CLI::App& app);
  FitOptions resolve(const CLI::App& app);

 private:
  RunLine line_;
  FitOptions options_;
  std::vector<std::string> data_, names_, sigmas_, observed_;
  std::string loss_;
};

int fit(const FitOptions& options);

}  // namespace hamel::tools
