// hamel section; command_lines.cpp reads the command line into its options.
#pragma once

#include <optional>
#include <string>

#include <hamel/framework/analysis/section.hpp>

#include "lines/run_line.hpp"

namespace hamel::tools {

struct SectionOptions {
  Config config;
  SectionRequest request;
  std::string starts;          // a CSV file
  std::string axes;            // --axes A,B of the page; empty: the first two that vary
  std::string output, report;  // -o, --report
  bool json = false, quiet = false, verbose = false;
};

/// Its options on the command line.
class SectionLine {
 public:
  void define(CLI::App& app);
  SectionOptions resolve(const CLI::App& app);

 private:
  void take_from_file(const CLI::App& app);
  RunLine line_;
  SectionOptions options_;
};

int section(const SectionOptions& options);

}  // namespace hamel::tools
