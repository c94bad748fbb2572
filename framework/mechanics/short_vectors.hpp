// Sums over a dozen numbers whose count is known at run time only, where a call of Eigen's costs more
// than the sum: by packets of two, which every x86-64 and ARM processor has. For sources of the
// library.
#pragma once

#include <cstddef>

namespace hamel::short_vectors {

using Pair [[gnu::vector_size(16), gnu::aligned(8), gnu::may_alias]] = double;

inline const Pair& pair_at(const double* x) { return *reinterpret_cast<const Pair*>(x); }
inline Pair& pair_at(double* x) { return *reinterpret_cast<Pair*>(x); }

/// x . y.
inline double dot(const double* x, const double* y, std::ptrdiff_t count) {
  Pair sum = {0, 0};
  std::ptrdiff_t i = 0;
  for (const std::ptrdiff_t last = count - 1; i < last; i += 2) sum += pair_at(x + i) * pair_at(y + i);
  double out = sum[0] + sum[1];
  if (i < count) out += x[i] * y[i];
  return out;
}
/// y += factor x.
inline void add(double factor, const double* x, double* y, std::ptrdiff_t count) {
  const Pair factors = {factor, factor};
  std::ptrdiff_t i = 0;
  for (const std::ptrdiff_t last = count - 1; i < last; i += 2)
    pair_at(y + i) += factors * pair_at(x + i);
  if (i < count) y[i] += factor * x[i];
}
/// to = factor x.
inline void scale(double factor, const double* x, double* to, std::ptrdiff_t count) {
  const Pair factors = {factor, factor};
  std::ptrdiff_t i = 0;
  for (const std::ptrdiff_t last = count - 1; i < last; i += 2)
    pair_at(to + i) = factors * pair_at(x + i);
  if (i < count) to[i] = factor * x[i];
}

}  // namespace hamel::short_vectors
