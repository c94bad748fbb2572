// The work of BranchedFactors for up to 12 velocities and 8 rows, whose loops unroll: looking for
// entries that are 0 costs more there than to go through them. For sources of the library.
//
// Rows of L and Y are found from the last on, each less what all below it leave: it stays in
// registers, and what is subtracted comes in the order in which the branches subtract it.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <hamel/framework/lie/types.hpp>
#include <hamel/framework/mechanics/short_vectors.hpp>

namespace hamel::few_factors {

using short_vectors::Pair, short_vectors::pair_at, short_vectors::store;

inline constexpr int kFewVelocities = 12, kFewRows = 8;

/// f(0), …, f(N - 1), each an integral_constant.
template <int N, class F>
void unrolled(F&& f) {
  [&]<int... i>(std::integer_sequence<int, i...>) { (f(std::integral_constant<int, i>()), ...); }
  (std::make_integer_sequence<int, N>());
}
/// f(count), an integral_constant; false where that is not among 1, …, most.
template <int most, class F>
bool with_count(int count, F&& f) {
  return [&]<int... i>(std::integer_sequence<int, i...>) {
    return ((count == i + 1 && (f(std::integral_constant<int, i + 1>()), true)) || ...);
  }
  (std::make_integer_sequence<int, most>());
}

/// `count` numbers as pairs, the last padded by a 0.
template <int P>
void load(const double* x, int count, Pair* to) {
  for (int p = 0; p < P - 1; ++p) to[p] = pair_at(x + 2 * p);
  to[P - 1] = count == 2 * P ? pair_at(x + 2 * P - 2) : Pair{x[2 * P - 2], 0};
}

/// L by rows of N with 1 number of room behind them, but for its diagonal, and the inverses of
/// that.
template <int N>
HAMEL_FLATTEN bool find_root(const double* inertia, double* lower, double* inverses) {
  bool definite = true;
  unrolled<N>([&](auto up) {
    constexpr int i = N - 1 - decltype(up)::value, P = i / 2 + 1;
    Pair row[P];
    load<P>(inertia + i * N, i + 1, row);
    unrolled<N - 1 - i>([&](auto down) {
      const double* const below = lower + (N - 1 - decltype(down)::value) * N;
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
  unrolled<N>([&](auto up) {
    constexpr int i = N - 1 - decltype(up)::value;
    Pair row[P];
    load<P>(a + i * k, k, row);
    unrolled<N - 1 - i>([&](auto down) {
      constexpr int j = N - 1 - decltype(down)::value;
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
    unrolled<K>([&](auto constant) {
      constexpr int j = decltype(constant)::value;
      const Pair factors = {row[j / 2][j % 2], row[j / 2][j % 2]};
      for (int p = 0; p <= j / 2; ++p) sums[j][p] += factors * row[p];
    });
  }
  unrolled<K>([&](auto constant) {
    constexpr int j = decltype(constant)::value;
    for (int p = 0; p <= j / 2; ++p) store(sums[j][p], gram + 2 * (j * P + p));
  });
}

/// x <- L^-T x.
template <int N>
HAMEL_FLATTEN void solve_transposed(const double* lower, const double* inverses, double* x) {
  unrolled<N>([&](auto up) {
    constexpr int i = N - 1 - decltype(up)::value;
    double sum = x[i];
    unrolled<N - 1 - i>([&](auto down) {
      constexpr int j = N - 1 - decltype(down)::value;
      sum -= lower[j * N + i] * x[j];
    });
    x[i] = sum * inverses[i];
  });
}
/// x <- L^-1 x.
template <int N>
HAMEL_FLATTEN void solve(const double* lower, const double* inverses, double* x) {
  unrolled<N>([&](auto constant) {
    constexpr int i = decltype(constant)::value;
    double sum = x[i];
    unrolled<i>([&](auto j) { sum -= lower[i * N + j] * x[j]; });
    x[i] = sum * inverses[i];
  });
}

/// L D below the diagonal, then L, and D^-1 on it; rows of P pairs.
template <int K, int width = 2 * ((K + 1) / 2)>
HAMEL_FLATTEN void factor_gram(double* gram) {
  unrolled<K>([&](auto constant) {
    constexpr int j = decltype(constant)::value;
    double* const here = gram + j * width;
    double own = here[j], row[j + 1];
    unrolled<j>([&](auto column) {
      constexpr int l = decltype(column)::value;
      const double* const there = gram + l * width;
      double left = here[l];
      unrolled<l>([&](auto i) { left -= row[i] * there[i]; });
      row[l] = left;
      here[l] = left * there[l];
      own -= left * here[l];
    });
    here[j] = own > 0 ? 1 / own : std::numeric_limits<double>::quiet_NaN();
  });
}
/// c <- (L D L^T)^-1 c.
template <int K, int width = 2 * ((K + 1) / 2)>
HAMEL_FLATTEN void solve_gram(const double* gram, double* c) {
  unrolled<K>([&](auto constant) {
    constexpr int i = decltype(constant)::value;
    double sum = c[i];
    unrolled<i>([&](auto l) { sum -= gram[i * width + l] * c[l]; });
    c[i] = sum;
  });
  unrolled<K>([&](auto up) {
    constexpr int i = K - 1 - decltype(up)::value;
    double sum = c[i] * gram[i * width + i];
    unrolled<K - 1 - i>([&](auto down) {
      constexpr int l = i + 1 + decltype(down)::value;
      sum -= gram[l * width + i] * c[l];
    });
    c[i] = sum;
  });
}

}  // namespace hamel::few_factors
