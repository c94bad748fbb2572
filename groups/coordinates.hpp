// What every from_coordinates checks first: the number of values, and that they are numbers.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace hamel {

/// A number as text, all digits ("0.10000000000000001").
inline std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// Throws std::invalid_argument: "so3: 8 values, expected 9 (R11, R12, ...)" or
/// "so3: R12 = nan, expected a finite number".
inline void check_coordinates(const std::string& group, std::span<const double> values,
                              const std::vector<std::string>& columns) {
  if (values.size() != columns.size()) {
    std::string list;
    for (const auto& column : columns) list += (list.empty() ? "" : ", ") + column;
    throw std::invalid_argument(group + ": " + std::to_string(values.size()) +
                                " values, expected " + std::to_string(columns.size()) + " (" +
                                list + ")");
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw std::invalid_argument(group + ": " + columns[i] + " = " + to_text(values[i]) +
                                  ", expected a finite number");
    }
  }
}

}  // namespace hamel
