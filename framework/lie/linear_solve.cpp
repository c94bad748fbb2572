#include <hamel/framework/lie/linear_solve.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/lie/short_vectors.hpp>

namespace hamel {
namespace {

// The row of the largest entry of column k at or below the diagonal.
int pivot_of(const double* a, int n, int k) {
  int pivot = k;
  for (int i = k + 1; i < n; ++i) {
    if (std::abs(a[k * n + i]) > std::abs(a[k * n + pivot])) pivot = i;
  }
  return pivot;
}

// Subtracts, in each column of m from the first, from the rows below k the factors of L (column k
// of a) times row k.
void eliminate(const double* a, double* m, int n, int k, int first, int columns) {
  for (int j = first; j < columns; ++j) {
    for (int i = k + 1; i < n; ++i) m[j * n + i] -= a[k * n + i] * m[j * n + k];
  }
}

// b <- u^-1 b of one column, with u in the upper triangle of a.
void substitute_back(const double* a, double* b, int n) {
  for (int k = n - 1; k >= 0; --k) {
    b[k] /= a[k * n + k];
    for (int i = 0; i < k; ++i) b[i] -= a[k * n + i] * b[k];
  }
}

}  // namespace

void solve_linear(double* a, double* b, int n, int columns) {
  for (int k = 0; k < n; ++k) {
    const int pivot = pivot_of(a, n, k);
    if (pivot != k) {
      for (int j = k; j < n; ++j) std::swap(a[j * n + k], a[j * n + pivot]);
      for (int j = 0; j < columns; ++j) std::swap(b[j * n + k], b[j * n + pivot]);
    }
    const double scale = 1 / a[k * n + k];
    for (int i = k + 1; i < n; ++i) a[k * n + i] *= scale;  // the factors of L
    eliminate(a, a, n, k, k + 1, n);
    eliminate(a, b, n, k, 0, columns);
  }
  for (int j = 0; j < columns; ++j) substitute_back(a, b + j * n, n);
}

namespace {

// All columns at once, their sums in registers.
template <int rows>
void multiply_each(const double* a, const double* x, double* out, int columns) {
  using short_vectors::Pair, short_vectors::pair_at;
  constexpr int pairs = rows / 2;
  Pair sums[pairs + 1] = {};
  double last = 0;
  for (int j = 0; j < columns; ++j) {
    const double* const column = a + j * rows;
    const Pair factors = {x[j], x[j]};
    for (int p = 0; p < pairs; ++p) sums[p] += factors * pair_at(column + 2 * p);
    if (rows % 2 == 1) last += x[j] * column[rows - 1];
  }
  for (int p = 0; p < pairs; ++p) short_vectors::store(sums[p], out + 2 * p);
  if (rows % 2 == 1) out[rows - 1] = last;
}

}  // namespace

void multiply_few(const double* a, const double* x, double* out, int rows, int columns) {
  short_vectors::with_count<16>(
      rows, [&](auto count) { multiply_each<decltype(count)::value>(a, x, out, columns); });
}

void add_along(const double* along, const double* change, double factor, double* m, int n) {
  short_vectors::with_count<16>(n, [&](auto count) {
    for (double* column = m; column != m + n * count; column += count) {
      const double part = factor * short_vectors::dot(column, along, count);
      short_vectors::add(part, change, column, count);
    }
  });
}

}  // namespace hamel
