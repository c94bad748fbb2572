// The work of BranchedFactors for up to 12 velocities and 8 rows, whose loops unroll: looking for
// entries that are 0 costs more there than to go through them. For sources of the library.
//
// Rows of L and Y are found from the last on, each less what all below it leave: it stays in
// registers, and what is subtracted comes in the order in which the branches subtract it.
#pragma once

#include <cmath>
#include <type_traits>

#include <hamel/framework/lie/short_vectors.hpp>
#include <hamel/framework/lie/types.hpp>

namespace hamel::few_factors {

using short_vectors::each, short_vectors::each_down, short_vectors::load, short_vectors::Pair,
    short_vectors::pair_at, short_vectors::store;

inline constexpr int kFewVelocities = 12, kFewRows = 8;

template <int N>
using Count = std::integral_constant<int, N>;

/// L by rows of N with 1 number of room behind them, but for its diagonal, and the inverses of
/// that.
template <int N>
HAMEL_FLATTEN bool find_root(const double* inertia, double* lower, double* inverses) {
  bool definite = true;
  each_down(Count<N>(), [&](auto row_of) {
    constexpr int i = decltype(row_of)::value, P = i / 2 + 1;
    Pair row[P];
    load<P>(inertia + i * N, i + 1, row);
    each(Count<N - 1 - i>(), [&](auto down) {
      const double* const below = lower + (N - 1 - down) * N;
      const Pair factors = {below[i], below[i]};
      for (int p = 0; p < P; ++p) row[p] -= factors * pair_at(below + 2 * p);
    });
    const double own = row[i / 2][i % 2];
    definite = definite && own > 1e-14 * inertia[i * (N + 1)];
    inverses[i] = 1 / std::sqrt(own);
    const Pair scale = {inverses[i], inverses[i]};
    for (int p = 0; p < P; ++p) store(scale * row[p], lower + i * N + 2 * p);
  });
  return definite;
}

/// Y by rows of P pairs, k numbers each.
template <int N, int P>
HAMEL_FLATTEN void find_rows(int k, const double* a, const double* lower, const double* inverses,
                             double* y) {
  each_down(Count<N>(), [&](auto row_of) {
    constexpr int i = decltype(row_of)::value;
    Pair row[P];
    load<P>(a + i * k, k, row);
    each(Count<N - 1 - i>(), [&](auto down) {
      const int j = N - 1 - down;
      const Pair factors = {lower[j * N + i], lower[j * N + i]};
      for (int p = 0; p < P; ++p) row[p] -= factors * pair_at(y + 2 * (j * P + p));
    });
    const Pair scale = {inverses[i], inverses[i]};
    for (int p = 0; p < P; ++p) store(scale * row[p], y + 2 * (i * P + p));
  });
}

/// The lower triangle of Y^T Y, K rows of P pairs.
template <int K, int P = (K + 1) / 2>
HAMEL_FLATTEN void find_gram(int n, const double* y, double* gram) {
  Pair sums[K][P] = {};
  for (int i = n - 1; i >= 0; --i) {
    Pair row[P];
    for (int p = 0; p < P; ++p) row[p] = pair_at(y + 2 * (i * P + p));
    each(Count<K>(), [&](auto j) {
      const Pair factors = {row[j / 2][j % 2], row[j / 2][j % 2]};
      for (int p = 0; p <= j / 2; ++p) sums[j][p] += factors * row[p];
    });
  }
  each(Count<K>(), [&](auto j) {
    for (int p = 0; p <= j / 2; ++p) store(sums[j][p], gram + 2 * (j * P + p));
  });
}

/// x <- L^-T x.
template <int N>
HAMEL_FLATTEN void solve_transposed(const double* lower, const double* inverses, double* x) {
  each_down(Count<N>(), [&](auto row_of) {
    constexpr int i = decltype(row_of)::value;
    double sum = x[i];
    each(Count<N - 1 - i>(), [&](auto down) {
      const int j = N - 1 - down;
      sum -= lower[j * N + i] * x[j];
    });
    x[i] = sum * inverses[i];
  });
}
/// x <- L^-1 x.
template <int N>
HAMEL_FLATTEN void solve(const double* lower, const double* inverses, double* x) {
  each(Count<N>(), [&](auto i) {
    double sum = x[i];
    each(i, [&](auto j) { sum -= lower[i * N + j] * x[j]; });
    x[i] = sum * inverses[i];
  });
}

}  // namespace hamel::few_factors
