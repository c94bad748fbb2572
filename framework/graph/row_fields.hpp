// Rows A xi = b as formulas of numbers that move with xi: brackets are taken of the fields that
// they admit.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <hamel/framework/graph/number.hpp>

namespace hamel::graph {

struct RowFields {
  std::shared_ptr<const Recording> recording;  // its inputs: the numbers
  std::vector<Number> rows;                    // A, k x n, row by row
  std::vector<Number> drift;                   // b
  std::vector<Number> moves;  // input by input, n each: xi moves it at the sum of moves_i xi_i
  int time = -1;              // the input that moves at 1; -1: none
  /// Values of the inputs at an element and a time.
  std::function<std::vector<double>(const double* element, double t)> inputs;
};

/// A system that has its rows as formulas of numbers of its own.
class HasRowFields {
 public:
  virtual ~HasRowFields() = default;
  /// Empty where a part of a row is no formula. The system outlives them.
  virtual std::optional<RowFields> row_fields() const = 0;
};

}  // namespace hamel::graph
