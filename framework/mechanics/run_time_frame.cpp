#include <hamel/framework/mechanics/run_time_frame.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/lie/short_vectors.hpp>

namespace hamel {

using short_vectors::add, short_vectors::add_products, short_vectors::add_to_rows,
    short_vectors::combine_rows, short_vectors::load, short_vectors::pair_at, short_vectors::Pair,
    short_vectors::store, short_vectors::dot, short_vectors::each, short_vectors::each_down,
    short_vectors::pairs_of, short_vectors::scale, short_vectors::with_any_count,
    short_vectors::with_pairs;

namespace {

// out = x rows of a symmetric x: two rows at a time.
template <int P>
void multiply_rows(const double* x, const double* rows, int pairs, int n, double* out) {
  int i = 0;
  if constexpr (P > 0) {
    for (; i + 1 < n; i += 2) {
      Pair sums[P] = {}, more[P] = {};
      for (int j = 0; j < n; ++j) {
        const double* const two = x + j * n + i;
        const Pair factors = {two[0], two[0]}, others = {two[1], two[1]};
        for (int p = 0; p < P; ++p) {
          const Pair row = pair_at(rows + 2 * (j * P + p));
          sums[p] += factors * row;
          more[p] += others * row;
        }
      }
      for (int p = 0; p < P; ++p) {
        store(sums[p], out + 2 * (i * P + p));
        store(more[p], out + 2 * ((i + 1) * P + p));
      }
    }
  }
  for (; i < n; ++i) combine_rows<P>(x + i * n, rows, pairs, n, out + 2 * i * pairs);
}

constexpr int kFew = 8;  // admissible velocities: loops over them unroll

size_t product(int rows, int columns) {
  return static_cast<size_t>(rows) * static_cast<size_t>(columns);
}

// |v| with the sign of the last one, or of v where that was none, or changes.
double signed_norm(const double* v, int count, bool keep_sign, double& sign) {
  const double norm = std::sqrt(dot(v, v, count));
  if (sign == 0) sign = v[0] < 0 ? -1 : 1;
  else if (!keep_sign && sign * v[0] < -0.1 * norm) sign = -sign;
  return sign * norm;
}

}  // namespace

RunTimeFrame::RunTimeFrame(int n, int k)
    : n_(n),
      k_(k),
      m_(n - k),
      weights_(product(n, 1)),
      rows_(product(n, 2 * pairs_of(k))),
      reflections_(product(k, n)),
      ends_(product(k, 1)),
      l_inverse_diagonal_(product(k, 1)),
      row_weights_(product(2, pairs_of(k))),
      factors_(product(k, 1)),
      signs_(product(k, 1)),
      frame_(product(n, 2 * pairs_of(m_))),
      momenta_(product(n, 2 * pairs_of(m_))),
      reduced_inertia_(product(m_, 2 * pairs_of(m_))),
      few_(product(k, 1)),
      work_(product(n, 1)),
      y_(product(2, pairs_of(m_))),
      sums_(product(2, std::max(pairs_of(k), pairs_of(m_)))) {}

void RunTimeFrame::set(const double* inertia, const double* a, bool same_frame) {
  find_weights(inertia);
  factor_rows(a, same_frame);
  find_frame();
  if (!diagonal_) reduce_inertia(inertia);  // else I = D: E^T I E = 1
}

void RunTimeFrame::find_weights(const double* inertia) {
  diagonal_ = true;
  double lightest = 0;
  bool massless = false;
  for (int j = 0; j < n_; ++j) {
    const double* const column = inertia + j * n_;
    const double own = column[j];
    if (own > 0) {
      if (lightest == 0 || own < lightest) lightest = own;
      weights_[static_cast<size_t>(j)] = 1 / std::sqrt(own);
    } else {
      massless = true;
    }
    for (int i = j + 1; diagonal_ && i < n_; ++i) diagonal_ = column[i] == 0;
  }
  if (!massless) return;
  diagonal_ = false;
  for (int j = 0; j < n_; ++j) {
    if (!(inertia[j * (n_ + 1)] > 0)) weights_[static_cast<size_t>(j)] = 1 / std::sqrt(lightest);
  }
}

// D^-1/2 A^T and, in row_weights_, the squares of its columns.
template <int P>
void RunTimeFrame::weigh_rows(const double* a) {
  const int n = n_, k = k_;
  double *const all = rows_.data(), *const squares = row_weights_.data();
  if constexpr (P > 0) {
    Pair sums[P] = {}, row[P];
    for (int i = 0; i < n; ++i) {
      const Pair weights = {weights_[static_cast<size_t>(i)], weights_[static_cast<size_t>(i)]};
      load<P>(a + i * k, k, row);
      for (int p = 0; p < P; ++p) {
        row[p] *= weights;
        store(row[p], all + 2 * (i * P + p));
        sums[p] += row[p] * row[p];
      }
    }
    for (int p = 0; p < P; ++p) store(sums[p], squares + 2 * p);
  } else {
    const int width = 2 * pairs_of(k);
    std::fill(row_weights_.begin(), row_weights_.end(), 0.0);
    for (int i = 0; i < n; ++i) {
      double* const row = all + i * width;
      scale(weights_[static_cast<size_t>(i)], a + i * k, row, k);
      for (int j = 0; j < k; ++j) squares[j] += row[j] * row[j];
    }
  }
}

void RunTimeFrame::factor_rows(const double* a, bool keep_signs) {
  const int n = n_, k = k_, width = 2 * pairs_of(k);
  double* const all = rows_.data();
  with_pairs(pairs_of(k), [&](auto pairs) { weigh_rows<decltype(pairs)::value>(a); });
  for (int j = 0; j < k; ++j) {
    double& weight = row_weights_[static_cast<size_t>(j)];
    weight = 1 / std::sqrt(weight);
    int& end = ends_[static_cast<size_t>(j)] = n;
    while (end > j + 1 && all[(end - 1) * width + j] == 0) --end;
  }
  with_pairs(pairs_of(k), [&](auto pairs) {
    constexpr int P = decltype(pairs)::value;
    if constexpr (P == 0) {
      for (int j = 0; j < k; ++j) reflect_rows<0>(j, 0, keep_signs);
    } else {
      each(std::integral_constant<int, 2 * P>(), [&](auto j) {
        constexpr int first = (decltype(j)::value + 1) / 2;
        if (j < k) reflect_rows<P - first>(j, first, keep_signs);
      });
    }
  });
}

// Reflection j of the columns behind it, which begin with pair `first` and are of P pairs; P = 0:
// of all, or of none where it is the last.
template <int P>
void RunTimeFrame::reflect_rows(int j, int first, bool keep_signs) {
  const int n = n_, k = k_, width = 2 * pairs_of(k), end = ends_[static_cast<size_t>(j)];
  const auto at = static_cast<size_t>(j);
  double *const rows = rows_.data() + j * width, *const v = reflections_.data() + j * n + j,
                *const sums = sums_.data();
  const int count = end - j;
  for (int i = 0; i < count; ++i) v[i] = rows[i * width + j];
  const double diagonal = signed_norm(v, count, keep_signs, signs_[at]);
  l_inverse_diagonal_[at] = -1 / diagonal;
  v[0] += diagonal;
  factors_[at] = 1 / (diagonal * v[0]);
  if (j + 1 == k) return;
  double* const behind = rows + 2 * first;
  combine_rows<P>(v, behind, width / 2, count, sums);
  std::fill_n(sums, j + 1 - 2 * first, 0.0);
  for (int l = j + 1; l < k; ++l) {
    int& last = ends_[static_cast<size_t>(l)];
    if (last < end && sums[l - 2 * first] != 0) last = end;
  }
  add_to_rows<P>(-factors_[at], v, sums, behind, width / 2, count);
}

void RunTimeFrame::reflect(int j, double* y) const {
  const double* const v = reflections_.data() + j * n_ + j;
  const int count = ends_[static_cast<size_t>(j)] - j;
  const double sum = dot(v, y + j, count);
  if (sum != 0) add(-factors_[static_cast<size_t>(j)] * sum, v, y + j, count);
}

void RunTimeFrame::find_frame() {
  with_pairs(pairs_of(m_), [&](auto constant) {
    constexpr int P = decltype(constant)::value;
    const int pairs = P > 0 ? P : pairs_of(m_), width = 2 * pairs;
    double *const frame = frame_.data(), *const sums = sums_.data();
    std::fill(frame_.begin(), frame_.end(), 0.0);
    for (int j = 0; j < m_; ++j) frame[(k_ + j) * width + j] = 1;
    for (int j = k_ - 1; j >= 0; --j) {
      const double* const v = reflections_.data() + j * n_ + j;
      const int count = ends_[static_cast<size_t>(j)] - j;
      combine_rows<P>(v, frame + j * width, pairs, count, sums);
      add_to_rows<P>(-factors_[static_cast<size_t>(j)], v, sums, frame + j * width, pairs, count);
    }
    for (int i = 0; i < n_; ++i)
      scale(weights_[static_cast<size_t>(i)], frame + i * width, frame + i * width, width);
  });
}

void RunTimeFrame::reduce_inertia(const double* inertia) {
  with_pairs(pairs_of(m_), [&](auto constant) {
    constexpr int P = decltype(constant)::value;
    const int n = n_, m = m_, pairs = P > 0 ? P : pairs_of(m), width = 2 * pairs;
    const double* const frame = frame_.data();
    double *const reduced = reduced_inertia_.data(), *const momenta = momenta_.data();
    std::fill(reduced_inertia_.begin(), reduced_inertia_.end(), 0.0);
    multiply_rows<P>(inertia, frame, pairs, n, momenta);  // I E
    for (int i = 0; i < n; ++i) {
      add_to_rows<P>(1, frame + i * width, momenta + i * width, reduced, pairs, m);
    }
  });
  factor_reduced();
}

// E^T I E = G G^T: column j of G in row j, the inverses of its diagonal on it.
void RunTimeFrame::factor_reduced() {
  const int width = 2 * pairs_of(m_);
  double* const reduced = reduced_inertia_.data();
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

// E^T mu.
void RunTimeFrame::reduce(const double* mu, double* to) const {
  with_pairs(pairs_of(m_), [&](auto constant) {
    combine_rows<decltype(constant)::value>(mu, frame_.data(), pairs_of(m_), n_, to);
  });
}

// y <- (E^T I E)^-1 y.
void RunTimeFrame::solve_reduced() {
  if (diagonal_) return;
  const int width = 2 * pairs_of(m_);
  const double* const reduced = reduced_inertia_.data();
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

// The velocity with A xi = c, E^T I xi = y.
void RunTimeFrame::combine(const double* c, double* xi) {
  const int n = n_, apart = 2 * pairs_of(k_), pairs = pairs_of(m_);
  double *const work = work_.data(), *const y = y_.data();
  std::fill_n(work, n, 0.0);
  const bool moved = !std::all_of(c, c + k_, [](double x) { return x == 0; });
  if (moved) {
    for (int j = 0; j < k_; ++j) {  // L^-1 c
      double sum = c[j];
      for (int i = 0; i < j; ++i) sum -= rows_[static_cast<size_t>(i * apart + j)] * work[i];
      work[j] = sum * l_inverse_diagonal_[static_cast<size_t>(j)];
    }
    for (int j = k_ - 1; j >= 0; --j) reflect(j, work);
    weigh(work);
  }
  with_pairs(pairs, [&](auto constant) {
    constexpr int P = decltype(constant)::value;
    if (moved && !diagonal_) {
      double* const sums = sums_.data();
      combine_rows<P>(work, momenta_.data(), pairs, n, sums);
      for (int j = 0; j < m_; ++j) y[j] -= sums[j];
    }
    solve_reduced();
    if constexpr (P > 0) {
      std::copy_n(work, n, xi);
      add_products<P>(frame_.data(), y, m_, n, xi);
    } else {
      for (int i = 0; i < n; ++i) xi[i] = work[i] + dot(frame_.data() + 2 * i * pairs, y, m_);
    }
  });
}

void RunTimeFrame::assemble(const double* r, const double* c, double* f) {
  reduce(r, y_.data());
  for (int j = 0; j < k_; ++j) f[j] = c[j] * row_weights_[static_cast<size_t>(j)];
  std::copy_n(y_.begin(), m_, f + k_);
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
  reduce(mu, y_.data());
  combine(c, xi);
}

void RunTimeFrame::expand(double* z) {
  for (int j = 0; j < k_; ++j)
    few_[static_cast<size_t>(j)] = z[j] / row_weights_[static_cast<size_t>(j)];
  std::copy_n(z + k_, m_, y_.begin());
  combine(few_.data(), z);
}

// L^T lambda = the first k of O^T D^-1/2 times the reaction.
void RunTimeFrame::multipliers(const double* reaction, double* lambda) {
  const int width = 2 * pairs_of(k_);
  double* const work = work_.data();
  std::copy_n(reaction, n_, work);
  weigh(work);
  for (int j = 0; j < k_; ++j) reflect(j, work);
  for (int j = k_ - 1; j >= 0; --j) {
    double sum = work[j];
    for (int i = j + 1; i < k_; ++i) sum -= rows_[static_cast<size_t>(j * width + i)] * lambda[i];
    lambda[j] = sum * l_inverse_diagonal_[static_cast<size_t>(j)];
  }
}

}  // namespace hamel
