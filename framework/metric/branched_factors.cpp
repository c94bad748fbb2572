#include <hamel/framework/metric/branched_factors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <hamel/framework/lie/short_vectors.hpp>
#include <hamel/framework/metric/few_factors.hpp>

namespace hamel {

using few_factors::kFewRows;
using short_vectors::add, short_vectors::add_products, short_vectors::combine_rows,
    short_vectors::dot, short_vectors::each, short_vectors::each_down, short_vectors::pairs_of,
    short_vectors::scale, short_vectors::with_any_count, short_vectors::with_count,
    short_vectors::with_pairs, short_vectors::kFewPairs;

static_assert(kFewRows <= 2 * kFewPairs);

namespace {

// f(n), n an integral_constant, where the few velocities and rows are: else along the branches.
template <class F>
bool with_few(int n, int k, F&& f) {
  return k <= kFewRows && with_count<few_factors::kFewVelocities>(n, f);
}

// S = L D L^T by rows: L below the diagonal, D^-1 on it; the columns of D L^T above serve as work
// space. True where a row is nearly a combination of those before.
template <class Count>
HAMEL_FLATTEN bool factor_rows(Count k, int width, double* s) {
  constexpr double kNearlyDependent = 1e-4;  // of a pivot in |y|^2
  bool nearly_dependent = false;
  each(k, [&](auto j) {
    double* const here = s + j * width;
    double own = here[j];
    const double least = kNearlyDependent * own;
    each(j, [&](auto l) {
      const double* const there = s + l * width;
      double left = here[l];
      each(l, [&](auto i) { left -= s[i * width + j] * there[i]; });
      s[l * width + j] = left;
      here[l] = left * there[l];
      own -= left * here[l];
    });
    nearly_dependent = nearly_dependent || own < least;
    here[j] = own > 0 ? 1 / own : std::numeric_limits<double>::quiet_NaN();
  });
  return nearly_dependent;
}
// c <- S^-1 c.
template <class Count>
HAMEL_FLATTEN void solve_rows(Count k, int width, const double* s, double* c) {
  each(k, [&](auto i) {
    double sum = c[i];
    each(i, [&](auto l) { sum -= s[i * width + l] * c[l]; });
    c[i] = sum;
  });
  each(k, [&](auto i) { c[i] *= s[i * width + i]; });
  each_down(k, [&](auto i) { each(i, [&](auto l) { c[l] -= s[i * width + l] * c[i]; }); });
}

template <class Span>
struct Parts {
  int n, k;
  const double *lower, *inverses;
  const int *runs, *counts;
  double *y, *gram;
  Span* spans;
};

// Row i of Y, all below it eliminated: leaves those above, and goes to Y^T Y.
template <int P, class Span>
void eliminate(const Parts<Span>& parts, int i) {
  const int n = parts.n, width = P > 0 ? 2 * P : 2 * pairs_of(parts.k);
  Span span = {0, width};
  if constexpr (P == 0) span = parts.spans[i];
  const int count = span.end - span.begin;
  double* const here = parts.y + i * width + span.begin;
  scale(parts.inverses[i], here, here, count);
  const int* const runs = parts.runs + i * (n + 1);
  const int end = parts.counts[i];
  for (int r = 0; r < end; r += 2) {
    const int after = runs[r + 1];
    for (int j = runs[r]; j < after; ++j) {
      add(-parts.lower[i * n + j], here, parts.y + j * width + span.begin, count);
      if constexpr (P == 0) parts.spans[j].join(span);
    }
  }
  const int last = std::min(span.end, parts.k);
  for (int j = span.begin; j < last; ++j) {
    double* const row = parts.gram + j * width + span.begin;  // up to its diagonal
    add(here[j - span.begin], here, row, P > 0 ? 2 * P : j + 1 - span.begin);
  }
}

}  // namespace

BranchedFactors::BranchedFactors(int n, int k)
    : n_(n),
      k_(k),
      lower_(static_cast<size_t>(n) * static_cast<size_t>(n) + 1),
      inverse_(static_cast<size_t>(n)),
      runs_(static_cast<size_t>(n) * static_cast<size_t>(n + 1)),
      run_count_(static_cast<size_t>(n)),
      y_(static_cast<size_t>(n) * static_cast<size_t>(2 * pairs_of(k))),
      spans_(static_cast<size_t>(n)),
      gram_(static_cast<size_t>(k) * static_cast<size_t>(2 * pairs_of(k))),
      sums_(static_cast<size_t>(2 * pairs_of(k))) {}

// Row i leaves the rows of its entries: those of I without the velocities from i on. (Pointers are
// local throughout: numbers that are written could else be those of a vector's own.)
bool BranchedFactors::find_root(const double* inertia) {
  const int n = n_;
  double *const lower = lower_.data(), *const inverses = inverse_.data();
  bool definite = true;
  if (with_few(n, k_, [&](auto count) {
        definite = few_factors::find_root<decltype(count)::value>(inertia, lower, inverses);
      }))
    return definite;
  int* const counts = run_count_.data();
  for (int i = 0; i < n; ++i) scale(1, inertia + i * n, lower + i * n, i + 1);
  for (int i = n - 1; i >= 0; --i) {
    double* const here = lower + i * n;
    int* const runs = runs_.data() + i * (n + 1);
    definite = definite && here[i] > 1e-14 * inertia[i * (n + 1)];
    const double inverse = inverses[i] = 1 / std::sqrt(here[i]);
    int end = 0;
    for (int j = 0; j < i; ++j) {
      if (here[j] == 0) continue;
      const int begin = runs[end] = j;
      while (j < i && here[j] != 0) ++j;
      scale(inverse, here + begin, here + begin, j - begin);
      runs[end + 1] = j;
      end += 2;
    }
    counts[i] = end;
    for (int r = 0; r < end; r += 2) {
      const int begin = runs[r], after = runs[r + 1];
      for (int j = begin; j < after; ++j) {
        double* const there = lower + j * n;
        const double factor = -here[j];
        for (int part = 0; part < r; part += 2)
          add(factor, here + runs[part], there + runs[part], runs[part + 1] - runs[part]);
        add(factor, here + begin, there + begin, j + 1 - begin);
      }
    }
  }
  return definite;
}

// L^T Y = A^T, all columns at once, and Y^T Y on the way.
void BranchedFactors::find_rows(const double* a) {
  const int n = n_, k = k_, width = 2 * pairs_of(k);
  if (with_few(n, k, [&](auto velocities) {
        with_pairs(pairs_of(k), [&](auto pairs) {
          constexpr int N = decltype(velocities)::value, P = decltype(pairs)::value;
          if constexpr (P > 0)  // k <= kFewRows
            few_factors::find_rows<N, P>(k, a, lower_.data(), inverse_.data(), y_.data());
        });
      })) {
    with_count<kFewRows>(k, [&](auto rows) {
      constexpr int K = decltype(rows)::value;
      few_factors::find_gram<K>(n, y_.data(), gram_.data());
    });
    factor_gram(width);
    return;
  }
  for (int i = 0; i < n; ++i) {
    double* const here = y_.data() + i * width;
    for (int j = 0; j < k; ++j) here[j] = a[i * k + j];
    if (k < width) here[k] = 0;  // also after values that were not finite
    if (width > 2 * kFewPairs) spans_[static_cast<size_t>(i)] = span_of(here, k);
  }
  std::fill(gram_.begin(), gram_.end(), 0.0);
  with_pairs(pairs_of(k), [&](auto pairs) {
    const Parts<Span> parts = {n,
                               k,
                               lower_.data(),
                               inverse_.data(),
                               runs_.data(),
                               run_count_.data(),
                               y_.data(),
                               gram_.data(),
                               spans_.data()};
    for (int i = n - 1; i >= 0; --i) eliminate<decltype(pairs)::value>(parts, i);
  });
  factor_gram(width);
}

// But for its last zeros and those before the first entry, in whole pairs.
BranchedFactors::Span BranchedFactors::span_of(const double* row, int k) {
  Span out = {k, 0};
  for (int j = 0; j < k; ++j) {
    if (row[j] != 0) out.join({j / 2 * 2, j / 2 * 2 + 2});
  }
  return out;
}

void BranchedFactors::factor_gram(int width) {
  with_any_count<kFewRows>(
      k_, [&](auto k) { nearly_dependent_ = factor_rows(k, width, gram_.data()); });
}

// x <- L^-T x.
void BranchedFactors::solve_transposed(double* x) const {
  const int n = n_;
  const double *const lower = lower_.data(), *const inverses = inverse_.data();
  if (with_few(n, k_, [&](auto count) {
        few_factors::solve_transposed<decltype(count)::value>(lower, inverses, x);
      }))
    return;
  const int* const counts = run_count_.data();
  for (int i = n - 1; i >= 0; --i) {
    const double value = x[i] *= inverses[i];
    const int* const runs = runs_.data() + i * (n + 1);
    const int end = counts[i];
    for (int r = 0; r < end; r += 2)
      add(-value, lower + i * n + runs[r], x + runs[r], runs[r + 1] - runs[r]);
  }
}

void BranchedFactors::solve(double* x) const {
  const int n = n_;
  const double *const lower = lower_.data(), *const inverses = inverse_.data();
  if (with_few(n, k_,
               [&](auto count) { few_factors::solve<decltype(count)::value>(lower, inverses, x); }))
    return;
  const int* const counts = run_count_.data();
  for (int i = 0; i < n; ++i) {
    double sum = x[i];
    const int* const runs = runs_.data() + i * (n + 1);
    const int end = counts[i];
    for (int r = 0; r < end; r += 2)
      sum -= dot(lower + i * n + runs[r], x + runs[r], runs[r + 1] - runs[r]);
    x[i] = sum * inverses[i];
  }
}

void BranchedFactors::subtract_rows(const double* c, const double* v, double* out) const {
  with_pairs(pairs_of(k_), [&](auto pairs) {
    constexpr int P = decltype(pairs)::value;
    const int n = n_, k = k_, width = 2 * pairs_of(k);
    const double* const y = y_.data();
    double* const sums = sums_.data();
    if constexpr (P > 0) {
      combine_rows<P>(v, y, P, n, sums);
    } else {
      std::fill_n(sums, width, 0.0);
      for (int i = 0; i < n; ++i) {
        const Span span = spans_[static_cast<size_t>(i)];
        add(v[i], y + i * width + span.begin, sums + span.begin, span.end - span.begin);
      }
    }
    for (int j = 0; j < k; ++j) out[j] = c[j] - sums[j];
  });
}

void BranchedFactors::add_reaction(const double* lambda, double* out) const {
  with_pairs(pairs_of(k_), [&](auto pairs) {
    constexpr int P = decltype(pairs)::value;
    const int n = n_, k = k_, width = 2 * pairs_of(k);
    const double* const y = y_.data();
    if constexpr (P > 0) {
      add_products<P>(y, lambda, k, n, out);
    } else {
      double* const padded = sums_.data();
      for (int j = 0; j < width; ++j) padded[j] = j < k ? lambda[j] : 0;
      for (int i = 0; i < n; ++i) {
        const Span span = spans_[static_cast<size_t>(i)];
        out[i] += dot(y + i * width + span.begin, padded + span.begin, span.end - span.begin);
      }
    }
  });
}

void BranchedFactors::solve_gram(double* c) const {
  with_any_count<kFewRows>(k_, [&](auto k) { solve_rows(k, 2 * pairs_of(k_), gram_.data(), c); });
}

}  // namespace hamel
