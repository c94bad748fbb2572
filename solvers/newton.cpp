#include <hamel/solvers/newton.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hamel {

// Gauss-Jordan with partial pivoting. Plain loops: matrices of at most a dozen rows, once a run.
void invert(double* matrix, double* inverse, int n) {
  const auto a = [&](int i, int j) -> double& { return matrix[j * n + i]; };
  const auto b = [&](int i, int j) -> double& { return inverse[j * n + i]; };
  std::fill(inverse, inverse + n * n, 0.0);
  for (int i = 0; i < n; ++i) b(i, i) = 1;
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i) {
      if (std::abs(a(i, k)) > std::abs(a(pivot, k))) pivot = i;
    }
    for (int j = 0; j < n; ++j) {
      std::swap(a(k, j), a(pivot, j));
      std::swap(b(k, j), b(pivot, j));
    }
    const double scale = 1 / a(k, k);
    for (int j = 0; j < n; ++j) {
      a(k, j) *= scale;
      b(k, j) *= scale;
    }
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a(i, k);
      for (int j = 0; j < n; ++j) {
        a(i, j) -= factor * a(k, j);
        b(i, j) -= factor * b(k, j);
      }
    }
  }
}

}  // namespace hamel
