// A matrix as plain numbers. Standard-library types only.
#pragma once

#include <cstddef>
#include <vector>

namespace hamel {

/// Row after row.
struct NumberMatrix {
  int rows = 0, columns = 0;
  std::vector<double> values = {};
  NumberMatrix() = default;
  NumberMatrix(int r, int c)
      : rows(r), columns(c), values(static_cast<size_t>(r) * static_cast<size_t>(c)) {}
  double& operator()(int i, int j) { return values[static_cast<size_t>(i * columns + j)]; }
  double operator()(int i, int j) const { return values[static_cast<size_t>(i * columns + j)]; }
};

}  // namespace hamel
