// A frame of the admissible velocities, found by elimination.
//
// Gauss-Jordan elimination of rows A xi' = c over recorded numbers writes each dependent velocity
// by the independent ones, xi' = E y + particular. A pivot is the cheapest entry (constants first,
// then few others in its row and column) among those of at least 0.05 of the largest in their row
// at all sample places; with structural zeros it stays sparse. Source: Markowitz, The elimination
// form of the inverse and its application to linear programming, Management Science 3 (1957).
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <hamel/framework/graph/number.hpp>

namespace hamel::mechanisms {

using graph::Number;

/// Values of the numbers of a recording where its inputs are these.
class Sample {
 public:
  explicit Sample(std::vector<double> inputs) : inputs_(std::move(inputs)) {}
  /// Value of a number of the current recording.
  double value(const Number& x);

 private:
  std::vector<double> inputs_, values_;  // of the nodes so far
};

struct Frame {
  std::vector<int> independent;
  std::vector<std::vector<Number>> e;  // rows of E, n x m
  std::vector<Number> particular;      // n
  std::vector<Number> pivots;          // those that are not constant
};

/// Rows and right-hand sides of A xi' = c, independent at the samples. Throws std::domain_error
/// where no pivot is left.
Frame eliminate(std::vector<std::vector<Number>> a, std::vector<Number> c,
                std::vector<Sample>& samples);

/// All velocities are independent.
Frame free_frame(size_t n);

}  // namespace hamel::mechanisms
