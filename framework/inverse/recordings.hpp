// Measured motions: columns over time, with gaps.
//
//   t,omega,v1
//   0,1.01,0.99
//   0.05,,0.98      # an empty cell is a missing number
// Lines that begin with # are comments. Standard-library types only.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/io/export.hpp>

namespace hamel {

struct Recording {
  std::string name;                         // of messages: its file
  std::vector<std::string> columns;         // without t
  std::vector<double> t;                    // growing, s
  std::vector<std::vector<double>> values;  // of each column; NaN where there is none
  std::vector<long> lines;                  // of the rows in the file; may be empty
};

/// Reads a CSV file. ConfigError with file, line and column.
HAMEL_API Recording read_recording(const std::string& path);
HAMEL_API Recording parse_recording(const std::string& text, const std::string& name);

}  // namespace hamel
