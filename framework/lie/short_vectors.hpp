// Sums over a dozen numbers whose count is known at run time only, where a call of Eigen's costs
// more than the sum: by packets of two, which every x86-64 and ARM processor has. For sources of
// the library.
#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace hamel::short_vectors {

using Pair [[gnu::vector_size(16)]] = double;

// By memcpy, as numbers are aligned by 8 (a type aligned by less than its size is GCC's alone).
inline Pair pair_at(const double* x) {
  Pair out;
  std::memcpy(&out, x, sizeof out);
  return out;
}
inline void store(const Pair& pair, double* x) { std::memcpy(x, &pair, sizeof pair); }
/// y += factors x, a pair each.
inline void add_pair(const Pair& factors, const double* x, double* y) {
  store(pair_at(y) + factors * pair_at(x), y);
}

/// 2 P or 2 P - 1 numbers as pairs, the last padded by a 0.
template <int P>
void load(const double* x, int count, Pair* to) {
  for (int p = 0; p < P - 1; ++p) to[p] = pair_at(x + 2 * p);
  to[P - 1] = count == 2 * P ? pair_at(x + 2 * P - 2) : Pair{x[2 * P - 2], 0};
}

/// x . y.
inline double dot(const double* x, const double* y, std::ptrdiff_t count) {
  Pair sum = {0, 0};
  std::ptrdiff_t i = 0;
  for (const std::ptrdiff_t last = count - 1; i < last; i += 2)
    sum += pair_at(x + i) * pair_at(y + i);
  double out = sum[0] + sum[1];
  if (i < count) out += x[i] * y[i];
  return out;
}
/// y += factor x.
inline void add(double factor, const double* x, double* y, std::ptrdiff_t count) {
  const Pair factors = {factor, factor};
  std::ptrdiff_t i = 0;
  for (const std::ptrdiff_t last = count - 1; i < last; i += 2) add_pair(factors, x + i, y + i);
  if (i < count) y[i] += factor * x[i];
}
/// to = factor x.
inline void scale(double factor, const double* x, double* to, std::ptrdiff_t count) {
  const Pair factors = {factor, factor};
  std::ptrdiff_t i = 0;
  for (const std::ptrdiff_t last = count - 1; i < last; i += 2)
    store(factors * pair_at(x + i), to + i);
  if (i < count) to[i] = factor * x[i];
}

/// f(count), an integral_constant; false where that is not among 1, …, most.
template <int most, class F>
bool with_count(int count, F&& f) {
  return [&]<int... i>(std::integer_sequence<int, i...>) {
    return ((count == i + 1 && (f(std::integral_constant<int, i + 1>()), true)) || ...);
  }
  (std::make_integer_sequence<int, most>());
}
/// f(count), an integral_constant where that is among 1, …, most.
template <int most, class F>
void with_any_count(int count, F&& f) {
  if (!with_count<most>(count, f)) f(count);
}
/// f(0), …, f(count - 1); of an integral_constant each is one, and the loop unrolls.
template <class Count, class F>
void each(Count count, F&& f) {
  if constexpr (std::is_integral_v<Count>) {
    for (Count i = 0; i < count; ++i) f(i);
  } else {
    [&]<int... i>(std::integer_sequence<int, i...>) { (f(std::integral_constant<int, i>()), ...); }
    (std::make_integer_sequence<int, Count::value>());
  }
}
/// f(count - 1), …, f(0).
template <class Count, class F>
void each_down(Count count, F&& f) {
  if constexpr (std::is_integral_v<Count>) {
    for (Count i = count; i-- > 0;) f(i);
  } else {
    each(count, [&](auto up) {
      f(std::integral_constant<int, Count::value - 1 - decltype(up)::value>());
    });
  }
}

// Matrices by rows, each of as many pairs, the last of which may be padded by a 0. P: that many
// pairs, whose loops unroll; 0: any.

inline constexpr int kFewPairs = 4;
inline int pairs_of(int columns) { return (columns + 1) / 2; }
/// f(P), P an integral_constant.
template <class F>
void with_pairs(int pairs, F&& f) {
  if (!with_count<kFewPairs>(pairs, f)) f(std::integral_constant<int, 0>());
}
/// to = sum of x_i times row i, of which the first P pairs count where P > 0.
template <int P>
void combine_rows(const double* x, const double* rows, std::ptrdiff_t pairs, std::ptrdiff_t count,
                  double* to) {
  if constexpr (P > 0) {
    Pair sums[P] = {};
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const Pair factors = {x[i], x[i]};
      for (int p = 0; p < P; ++p) sums[p] += factors * pair_at(rows + 2 * (i * pairs + p));
    }
    for (int p = 0; p < P; ++p) store(sums[p], to + 2 * p);
  } else {
    for (std::ptrdiff_t j = 0; j < 2 * pairs; ++j) to[j] = 0;
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      if (x[i] != 0) add(x[i], rows + 2 * pairs * i, to, 2 * pairs);
    }
  }
}
/// to_i += row i . x, x of so many columns.
template <int P>
void add_products(const double* rows, const double* x, int columns, std::ptrdiff_t count,
                  double* to) {
  Pair right[P];
  load<P>(x, columns, right);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Pair sum = pair_at(rows + 2 * i * P) * right[0];
    for (int p = 1; p < P; ++p) sum += pair_at(rows + 2 * (i * P + p)) * right[p];
    to[i] += sum[0] + sum[1];
  }
}

}  // namespace hamel::short_vectors
