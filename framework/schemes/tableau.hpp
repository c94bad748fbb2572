// The coefficients of an explicit Runge-Kutta method, as data.
//
//   k_i = f(t + c_i h, y + h sum_{j<i} a_ij k_j),  i = 0 .. S-1,     y_1 = y + h sum_{j<S} b_j k_j,
//   k_S = f(t + h, y_1), the first stage of the next step: row S of a is b.
// Error estimate h sum_{i<=S} e_i k_i. Dense output, with further stages S+1, ...:
//   y(t + theta h) = y + h sum_i b_i(theta) k_i,   b_i(theta) = theta sum_j p_ij theta^j.
// Source: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.1, II.4 to II.6.
#pragma once

#include <cstddef>
#include <span>

namespace hamel {

struct Tableau {
  int order;                  // of y_1
  int stages;                 // S
  std::span<const double> c;  // all stages, those of the dense output too
  std::span<const double> a;  // rows 1, 2, ...; row i has i entries
  /// With a second estimate of order 3 (dop853) the error is |e|^2 / sqrt(|e|^2 + 0.01 |e3|^2).
  std::span<const double> e = {}, e3 = {};
  int estimated_order = 0;             // k: the estimate is O(h^k)
  std::span<const double> dense = {};  // p, a row for each stage
  int degree = 0;                      // entries in a row of it

  double at(int i, int j) const { return a[static_cast<std::size_t>(i * (i - 1) / 2 + j)]; }
  int all_stages() const { return static_cast<int>(c.size()); }
  bool estimates() const { return !e.empty(); }
};

}  // namespace hamel
