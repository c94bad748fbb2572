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

namespace hamel::graph {

/// Values of the numbers of a recording where its inputs are these.
class Sample {
 public:
  explicit Sample(std::vector<double> inputs) : inputs_(std::move(inputs)) {}
  /// Value of a number of the current recording.
  double value(const Number& x);

 private:
  std::vector<double> inputs_, values_;  // of the nodes so far
};

/// Row and column of a pivot.
using Pivot = std::pair<size_t, size_t>;

struct Frame {
  std::vector<int> independent;
  std::vector<std::vector<Number>> e;  // rows of E, n x m
  std::vector<Number> particular;      // n
  std::vector<Number> pivots;          // those that are not constant
  std::vector<Pivot> order;            // in which they were taken
};

/// Rows from which some velocities were eliminated: a_j x_j = c - sum a_k x_k of the row of a pivot
/// in column j, a_j = 1, over the columns that come later or have none.
struct Eliminated {
  std::vector<std::vector<Number>> a;
  std::vector<Number> c;
  std::vector<Pivot> order;
  std::vector<size_t> left;    // rows without a pivot, in which only such columns are left
  std::vector<Number> pivots;  // those that are not constant

  /// Writes the velocities of the pivots, the others being there.
  void complete(std::vector<Number>& x) const;
};

/// Rows and right-hand sides of A xi' = c, independent at the samples. lasting: large pivots go
/// before cheap ones. Throws std::domain_error where no pivot is left.
Frame eliminate(std::vector<std::vector<Number>> a, std::vector<Number> c,
                std::vector<Sample>& samples, bool lasting = false);

/// With the pivots of another elimination.
Frame eliminate(std::vector<std::vector<Number>> a, std::vector<Number> c,
                const std::vector<Pivot>& order);
/// Pivots, at most so many, in allowed columns alone; where there are not so many as `least`,
/// smaller ones too.
Eliminated eliminate_some(std::vector<std::vector<Number>> a, std::vector<Number> c,
                          std::vector<Sample>& samples, const std::vector<bool>& allowed,
                          size_t least, size_t most);

/// M y = r, y in place of r, by L D L^T.
void solve_symmetric(std::vector<std::vector<Number>> m, std::vector<Number>& r);

/// All velocities are independent.
Frame free_frame(size_t n);

}  // namespace hamel::graph
