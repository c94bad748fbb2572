// Dense solves of a few rows in plain loops: at n <= 8 several times faster than a general library's.
#pragma once

#include <cmath>
#include <utility>

#include <Eigen/Core>

namespace hamel {

/// b <- a^-1 b by elimination with partial pivoting; a is overwritten. Inf or NaN where a is singular.
template <class Matrix, class Vector>
void solve_in_place(Matrix& a, Vector& b) {
  constexpr int fixed = Matrix::RowsAtCompileTime;
  const int n = fixed != Eigen::Dynamic ? fixed : static_cast<int>(a.rows());
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i) {
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    }
    if (pivot != k) {
      for (int j = k; j < n; ++j) std::swap(a(k, j), a(pivot, j));
      std::swap(b[k], b[pivot]);
    }
    const double scale = 1 / a(k, k);
    for (int i = k + 1; i < n; ++i) {
      const double factor = a(i, k) * scale;
      for (int j = k + 1; j < n; ++j) a(i, j) -= factor * a(k, j);
      b[i] -= factor * b[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    double sum = b[k];
    for (int j = k + 1; j < n; ++j) sum -= a(k, j) * b[j];
    b[k] = sum / a(k, k);
  }
}

/// The inverse of a symmetric positive definite a, by Gauss-Jordan sweeps in place.
template <class Matrix>
void invert_definite(Matrix& a) {
  const Eigen::Index n = a.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    const double pivot = 1 / a(k, k);
    a(k, k) = 1;
    for (Eigen::Index j = 0; j < n; ++j) a(k, j) *= pivot;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a(i, k);
      a(i, k) = 0;
      for (Eigen::Index j = 0; j < n; ++j) a(i, j) -= factor * a(k, j);
    }
  }
}

}  // namespace hamel
