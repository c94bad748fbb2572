#include <hamel/framework/lie/linear_solve.hpp>

#include <algorithm>
#include <cmath>

namespace hamel {

void solve_linear(double* a, double* b, int n, int columns) {
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i) {
      if (std::abs(a[k * n + i]) > std::abs(a[k * n + pivot])) pivot = i;
    }
    if (pivot != k) {
      for (int j = k; j < n; ++j) std::swap(a[j * n + k], a[j * n + pivot]);
      for (int j = 0; j < columns; ++j) std::swap(b[j * n + k], b[j * n + pivot]);
    }
    const double scale = 1 / a[k * n + k];
    for (int i = k + 1; i < n; ++i) a[k * n + i] *= scale;  // the factors of L
    for (int j = k + 1; j < n; ++j) {
      for (int i = k + 1; i < n; ++i) a[j * n + i] -= a[k * n + i] * a[j * n + k];
    }
    for (int j = 0; j < columns; ++j) {
      for (int i = k + 1; i < n; ++i) b[j * n + i] -= a[k * n + i] * b[j * n + k];
    }
  }
  for (int j = 0; j < columns; ++j) {
    for (int k = n - 1; k >= 0; --k) {
      b[j * n + k] /= a[k * n + k];
      for (int i = 0; i < k; ++i) b[j * n + i] -= a[k * n + i] * b[j * n + k];
    }
  }
}

}  // namespace hamel
