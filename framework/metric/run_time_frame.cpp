#include <hamel/framework/metric/run_time_frame.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <hamel/framework/lie/short_vectors.hpp>

namespace hamel {

using short_vectors::add, short_vectors::add_pair, short_vectors::dot, short_vectors::each,
    short_vectors::each_down, short_vectors::load, short_vectors::Pair, short_vectors::pair_at,
    short_vectors::pairs_of, short_vectors::scale, short_vectors::store,
    short_vectors::with_any_count, short_vectors::with_count, short_vectors::with_pairs;

namespace {

// Loops over so many admissible velocities, and over so many pairs of a column of I, unroll.
constexpr int kFew = 8, kPairsOfInertia = 8;
// Pivots of velocities that are kept, relative to those when they were chosen.
constexpr double kLeast = 0.3, kLeastWithinStep = 0.01;

size_t product(int rows, int columns) {
  return static_cast<size_t>(rows) * static_cast<size_t>(columns);
}

// x . y and y += factor x, of count numbers in P padded pairs; P = 0: of any count.
template <int P>
double dot_pairs(const double* x, const double* y, int count) {
  if constexpr (P == 0) return dot(x, y, count);
  Pair sum = {};
  for (int p = 0; p < P; ++p) sum += pair_at(x + 2 * p) * pair_at(y + 2 * p);
  return sum[0] + sum[1];
}
template <int P>
void add_pairs(double factor, const double* x, double* y, int count) {
  if constexpr (P == 0) return add(factor, x, y, count);
  for (int p = 0; p < P; ++p) add_pair(Pair{factor, factor}, x + 2 * p, y + 2 * p);
}

}  // namespace

RunTimeFrame::RunTimeFrame(int n, int k)
    : n_(n),
      k_(k),
      m_(n - k),
      order_(product(n, 1)),
      pivots_(product(k, 1)),
      weights_(product(n, 1)),
      row_weights_(product(2, pairs_of(k))),
      rows_(product(n, 2 * pairs_of(k))),
      steps_(product(k, 2 * pairs_of(k))),
      momenta_(product(m_, 2 * pairs_of(n))),
      reduced_(product(m_, 2 * pairs_of(m_))),
      d_(product(2, pairs_of(k))),
      y_(product(2, pairs_of(m_))),
      few_(product(2, pairs_of(k))) {
  std::iota(order_.begin(), order_.end(), 0);
}

void RunTimeFrame::set(const double* inertia, const double* a, bool same_frame) {
  find_weights(inertia);
  with_pairs(pairs_of(k_), [&](auto pairs) {
    constexpr int P = decltype(pairs)::value;
    take_rows<P>(a);
    if (chosen_ && eliminate<P>(same_frame ? kLeastWithinStep : kLeast)) return;
    if (chosen_) take_rows<P>(a);
    chosen_ = false;
    eliminate<P>(0);
    chosen_ = true;
  });
  const auto reduce_by = [&](auto pairs) { reduce_inertia<decltype(pairs)::value>(inertia); };
  if (!with_count<kPairsOfInertia>(pairs_of(n_), reduce_by)) reduce_inertia<0>(inertia);
  factor_reduced();
}

void RunTimeFrame::find_weights(const double* inertia) {
  double lightest = 0;
  bool massless = false;
  for (int j = 0; j < n_; ++j) {
    const double own = inertia[j * (n_ + 1)];
    if (own > 0) {
      if (lightest == 0 || own < lightest) lightest = own;
      weights_[static_cast<size_t>(j)] = 1 / std::sqrt(own);
    } else {
      massless = true;
    }
  }
  if (!massless) return;
  for (int j = 0; j < n_; ++j) {
    if (!(inertia[j * (n_ + 1)] > 0)) weights_[static_cast<size_t>(j)] = 1 / std::sqrt(lightest);
  }
}

// A^T by order_, and 1/|D^-1/2 a_i|.
template <int P>
void RunTimeFrame::take_rows(const double* a) {
  const int n = n_, k = k_, width = 2 * pairs_of(k);
  double *const rows = rows_.data(), *const squares = row_weights_.data();
  if constexpr (P > 0) {
    Pair sums[P] = {}, row[P];
    for (int i = 0; i < n; ++i) {
      const int from = order_[static_cast<size_t>(i)];
      const double own = weights_[static_cast<size_t>(from)];
      load<P>(a + from * k, k, row);
      for (int p = 0; p < P; ++p) {
        store(row[p], rows + 2 * (i * P + p));
        const Pair weighted = row[p] * Pair{own, own};
        sums[p] += weighted * weighted;
      }
    }
    for (int p = 0; p < P; ++p) store(sums[p], squares + 2 * p);
  } else {
    std::fill(row_weights_.begin(), row_weights_.end(), 0.0);
    for (int i = 0; i < n; ++i) {
      const int from = order_[static_cast<size_t>(i)];
      const double own = weights_[static_cast<size_t>(from)];
      std::copy_n(a + from * k, k, rows + i * width);
      for (int j = 0; j < k; ++j) {
        const double weighted = own * a[from * k + j];
        squares[j] += weighted * weighted;
      }
    }
  }
  for (int j = 0; j < k; ++j) squares[j] = 1 / std::sqrt(squares[j]);
}

// The velocity that follows from row j.
void RunTimeFrame::choose(int j) {
  const int width = 2 * pairs_of(k_);
  double most = -1;
  int best = j;
  for (int i = j; i < n_; ++i) {
    const double size = std::abs(rows_[static_cast<size_t>(i * width + j)]) *
                        weights_[static_cast<size_t>(order_[static_cast<size_t>(i)])];
    if (size > most) {
      most = size;
      best = i;
    }
  }
  std::swap(order_[static_cast<size_t>(j)], order_[static_cast<size_t>(best)]);
  std::swap_ranges(rows_.begin() + j * width, rows_.begin() + (j + 1) * width,
                   rows_.begin() + best * width);
  pivots_[static_cast<size_t>(j)] = most * row_weights_[static_cast<size_t>(j)];
}

// [A_d A_f] -> [1 B]. False where a pivot is too small. Velocities are chosen where none are.
template <int P>
bool RunTimeFrame::eliminate(double least) {
  const int k = k_, width = P > 0 ? 2 * P : 2 * pairs_of(k);
  double* const end = rows_.data() + n_ * width;
  for (int j = 0; j < k; ++j) {
    const auto at = static_cast<size_t>(j);
    if (!chosen_) choose(j);
    double *const row = rows_.data() + j * width, *const step = steps_.data() + j * width;
    const double pivot = row[j], own = weights_[static_cast<size_t>(order_[at])];
    if (chosen_ && !(std::abs(pivot) * own * row_weights_[at] >= least * pivots_[at])) return false;
    const double inverse = 1 / pivot;
    scale(inverse, row, step, width);
    step[j] = inverse;
    Pair taken[P > 0 ? P : 1];
    for (int p = 0; p < P; ++p) taken[p] = pair_at(step + 2 * p);
    for (double* other = row + width; other != end; other += width) {
      const double entry = other[j];
      if (entry == 0) continue;
      if constexpr (P == 0) add(-entry, step, other, k);
      for (int p = 0; p < P; ++p)
        store(pair_at(other + 2 * p) - Pair{entry, entry} * taken[p], other + 2 * p);
      other[j] = entry * inverse;
    }
  }
  return true;
}

const double* RunTimeFrame::following(int i) const {
  return rows_.data() + (k_ + i) * 2 * pairs_of(k_);
}

double RunTimeFrame::unit(int i) const {
  return weights_[static_cast<size_t>(order_[static_cast<size_t>(k_ + i)])];
}

// (I E)^T and E^T I E.
template <int P>
void RunTimeFrame::reduce_inertia(const double* inertia) {
  const int n = n_, k = k_, m = m_, width = 2 * pairs_of(n), across = 2 * pairs_of(m);
  const int *const d = order_.data(), *const f = d + k;
  double *const few = few_.data(), *const reduced = reduced_.data();
  for (int i = 0; i < m; ++i) {
    const double* const follows = following(i);
    double* const momentum = momenta_.data() + i * width;
    if constexpr (P > 0) {
      Pair sums[P], column[P];
      load<P>(inertia + f[i] * n, n, sums);
      for (int l = 0; l < k; ++l) {
        if (follows[l] == 0) continue;
        load<P>(inertia + d[l] * n, n, column);
        for (int p = 0; p < P; ++p) sums[p] -= Pair{follows[l], follows[l]} * column[p];
      }
      for (int p = 0; p < P; ++p) store(sums[p], momentum + 2 * p);
    } else {
      std::copy_n(inertia + f[i] * n, n, momentum);
      for (int l = 0; l < k; ++l)
        if (follows[l] != 0) add(-follows[l], inertia + d[l] * n, momentum, n);
    }
    for (int l = 0; l < k; ++l) few[l] = momentum[d[l]];
    with_pairs(pairs_of(k), [&](auto pairs) {
      for (int j = 0; j <= i; ++j)
        reduced[j * across + i] = momentum[f[j]] - dot_pairs<pairs>(following(j), few, k);
    });
  }
}

// E^T I E = G G^T: column j of G in row j, the inverses of its diagonal on it.
void RunTimeFrame::factor_reduced() {
  const int width = 2 * pairs_of(m_);
  double* const reduced = reduced_.data();
  with_any_count<kFew>(m_, [&](auto m) {
    each(m, [&](auto j) {
      double* const here = reduced + j * width;
      const double inverse = 1 / std::sqrt(here[j]);
      here[j] = inverse;
      for (int i = j + 1; i < m; ++i) here[i] *= inverse;
      for (int l = j + 1; l < m; ++l) add(-here[l], here + l, reduced + l * width + l, m - l);
    });
  });
}

// y = E^T mu.
void RunTimeFrame::reduce(const double* mu) {
  const int *const d = order_.data(), *const f = d + k_;
  double *const few = few_.data(), *const y = y_.data();
  for (int j = 0; j < k_; ++j) few[j] = mu[d[j]];
  with_pairs(pairs_of(k_), [&](auto pairs) {
    for (int i = 0; i < m_; ++i) y[i] = mu[f[i]] - dot_pairs<pairs>(following(i), few, k_);
  });
}

// y <- (E^T I E)^-1 y.
void RunTimeFrame::solve_reduced() {
  const int width = 2 * pairs_of(m_);
  const double* const reduced = reduced_.data();
  double* const y = y_.data();
  with_any_count<kFew>(m_, [&](auto m) {
    each(m, [&](auto j) {
      const double* const here = reduced + j * width;
      y[j] *= here[j];
      for (int i = j + 1; i < m; ++i) y[i] -= here[i] * y[j];
    });
    each_down(m, [&](auto j) {
      const double* const here = reduced + j * width;
      for (int i = j + 1; i < m; ++i) y[j] -= here[i] * y[i];
      y[j] *= here[j];
    });
  });
}

// d = A_d^-1 c, and y <- y - N^T d.
void RunTimeFrame::move(const double* c) {
  const int k = k_;
  const int* const order = order_.data();
  double *const d = d_.data(), *const y = y_.data();
  std::copy_n(c, k, d);
  if (std::all_of(c, c + k, [](double x) { return x == 0; })) return;
  with_pairs(pairs_of(k), [&](auto pairs) {
    for (int j = 0; j < k; ++j) {
      const double* const step = steps_.data() + j * 2 * pairs_of(k);
      const double own = d[j];
      add_pairs<pairs>(-own, step, d, k);
      d[j] = own * step[j];
    }
  });
  for (int i = 0; i < m_; ++i) {
    const double* const momentum = momenta_.data() + i * 2 * pairs_of(n_);
    double sum = 0;
    for (int j = 0; j < k; ++j) sum += momentum[order[j]] * d[j];
    y[i] -= sum;
  }
}

// The velocity of y and d.
void RunTimeFrame::spread(double* xi) {
  const int *const order = order_.data(), *const f = order + k_;
  double *const d = d_.data(), *const y = y_.data();
  with_pairs(pairs_of(k_), [&](auto pairs) {
    for (int i = 0; i < m_; ++i) {
      add_pairs<pairs>(-y[i], following(i), d, k_);
      xi[f[i]] = y[i];
    }
  });
  for (int j = 0; j < k_; ++j) xi[order[j]] = d[j];
}

void RunTimeFrame::assemble(const double* r, const double* c, double* f) {
  reduce(r);
  for (int j = 0; j < k_; ++j) f[j] = c[j] * row_weights_[static_cast<size_t>(j)];
  for (int i = 0; i < m_; ++i) f[k_ + i] = y_[static_cast<size_t>(i)] * unit(i);
}

void RunTimeFrame::weigh(double* mu) const {
  for (int i = 0; i < n_; ++i) mu[i] *= weights_[static_cast<size_t>(i)];
}

double RunTimeFrame::size(const double* mu) const {
  double sum = 0;
  for (int i = 0; i < n_; ++i) {
    const double part = weights_[static_cast<size_t>(i)] * mu[i];
    sum += part * part;
  }
  return std::sqrt(sum);
}

void RunTimeFrame::velocity(const double* mu, const double* c, double* xi) {
  reduce(mu);
  move(c);
  solve_reduced();
  spread(xi);
}

void RunTimeFrame::expand(double* z) {
  for (int j = 0; j < k_; ++j)
    few_[static_cast<size_t>(j)] = z[j] / row_weights_[static_cast<size_t>(j)];
  for (int i = 0; i < m_; ++i) y_[static_cast<size_t>(i)] = z[k_ + i] / unit(i);
  move(few_.data());
  solve_reduced();
  spread(z);
}

// A_d^T lambda = the rows d of the reaction.
void RunTimeFrame::multipliers(const double* reaction, double* lambda) {
  const int width = 2 * pairs_of(k_);
  for (int j = 0; j < k_; ++j) lambda[j] = reaction[order_[static_cast<size_t>(j)]];
  for (int j = k_ - 1; j >= 0; --j) {
    const double* const step = steps_.data() + j * width;
    const double own = std::exchange(lambda[j], 0);
    lambda[j] = step[j] * own - dot(step, lambda, k_);
  }
}

}  // namespace hamel
