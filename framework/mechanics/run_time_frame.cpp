#include <hamel/framework/mechanics/run_time_frame.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/mechanics/short_vectors.hpp>

namespace hamel {

using short_vectors::add, short_vectors::add_to_rows, short_vectors::combine_rows,
    short_vectors::dot, short_vectors::pairs_of, short_vectors::scale, short_vectors::with_pairs;

namespace {

size_t product(int rows, int columns) {
  return static_cast<size_t>(rows) * static_cast<size_t>(columns);
}

// |v| with the sign of the last one, or of v where that was none, or changes.
double signed_norm(const double* v, int apart, int count, bool keep_sign, double& sign) {
  double square = 0;
  for (int i = 0; i < count; ++i) square += v[i * apart] * v[i * apart];
  const double norm = std::sqrt(square);
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
      reflections_(product(n, 2 * pairs_of(k))),
      ends_(product(k, 1)),
      l_inverse_diagonal_(product(k, 1)),
      row_weights_(product(2, pairs_of(k))),
      factors_(product(k, 1)),
      signs_(product(k, 1)),
      frame_(product(n, 2 * pairs_of(m_))),
      reduced_inertia_(product(m_, 2 * pairs_of(m_))),
      few_(product(k, 1)),
      work_(product(n, 1)),
      image_(product(n, 1)),
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

// Reflection j of all columns at once; it leaves those up to j.
void RunTimeFrame::factor_rows(const double* a, bool keep_signs) {
  const int n = n_, k = k_, width = 2 * pairs_of(k);
  double* const all = reflections_.data();
  std::fill(row_weights_.begin(), row_weights_.end(), 0.0);
  for (int i = 0; i < n; ++i) {
    double* const row = all + i * width;
    scale(weights_[static_cast<size_t>(i)], a + i * k, row, k);
    for (int j = 0; j < k; ++j) row_weights_[static_cast<size_t>(j)] += row[j] * row[j];
  }
  for (int j = 0; j < k; ++j) {
    double& weight = row_weights_[static_cast<size_t>(j)];
    weight = 1 / std::sqrt(weight);
    int& end = ends_[static_cast<size_t>(j)] = n;
    while (end > j + 1 && all[(end - 1) * width + j] == 0) --end;
  }
  with_pairs(pairs_of(k), [&](auto pairs) {
    constexpr int P = decltype(pairs)::value;
    double* const sums = sums_.data();
    for (int j = 0; j < k; ++j) {
      const auto at = static_cast<size_t>(j);
      double* const rows = all + j * width;
      const int end = ends_[at], count = end - j;
      const double diagonal = signed_norm(rows + j, width, count, keep_signs, signs_[at]);
      l_inverse_diagonal_[at] = -1 / diagonal;
      rows[j] += diagonal;
      factors_[at] = 1 / (diagonal * rows[j]);
      combine_rows<P>(rows + j, width, rows, width / 2, count, sums);
      std::fill_n(sums, j + 1, 0.0);
      for (int l = j + 1; l < k; ++l) {
        if (sums[l] != 0)
          ends_[static_cast<size_t>(l)] = std::max(ends_[static_cast<size_t>(l)], end);
      }
      add_to_rows<P>(-factors_[at], rows + j, width, sums, rows, width / 2, count);
    }
  });
}

void RunTimeFrame::reflect(int j, double* y) const {
  const int width = 2 * pairs_of(k_), end = ends_[static_cast<size_t>(j)];
  const double* const v = reflections_.data() + j;
  double sum = 0;
  for (int i = j; i < end; ++i) sum += v[i * width] * y[i];
  if (sum == 0) return;
  sum *= factors_[static_cast<size_t>(j)];
  for (int i = j; i < end; ++i) y[i] -= sum * v[i * width];
}

void RunTimeFrame::find_frame() {
  with_pairs(pairs_of(m_), [&](auto constant) {
    constexpr int P = decltype(constant)::value;
    const int pairs = P > 0 ? P : pairs_of(m_), width = 2 * pairs, apart = 2 * pairs_of(k_);
    double* const frame = frame_.data();
    std::fill(frame_.begin(), frame_.end(), 0.0);
    for (int j = 0; j < m_; ++j) frame[(k_ + j) * width + j] = 1;
    for (int j = k_ - 1; j >= 0; --j) {
      const double* const v = reflections_.data() + j * (apart + 1);
      const int count = ends_[static_cast<size_t>(j)] - j;
      combine_rows<P>(v, apart, frame + j * width, pairs, count, sums_.data());
      add_to_rows<P>(-factors_[static_cast<size_t>(j)], v, apart, sums_.data(), frame + j * width,
                     pairs, count);
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
    double *const reduced = reduced_inertia_.data(), *const image = sums_.data();
    std::fill(reduced_inertia_.begin(), reduced_inertia_.end(), 0.0);
    for (int i = 0; i < n; ++i) {  // row i of I E
      combine_rows<P>(inertia + i * n, 1, frame, pairs, n, image);
      add_to_rows<P>(1, frame + i * width, 1, image, reduced, pairs, m);
    }
  });
  factor_reduced();
}

// E^T I E = G G^T: column j of G in row j, the inverses of its diagonal on it.
void RunTimeFrame::factor_reduced() {
  const int m = m_, width = 2 * pairs_of(m);
  double* const reduced = reduced_inertia_.data();
  for (int j = 0; j < m; ++j) {
    double* const here = reduced + j * width;
    const double inverse = 1 / std::sqrt(here[j]);
    here[j] = inverse;
    for (int i = j + 1; i < m; ++i) here[i] *= inverse;
    for (int l = j + 1; l < m; ++l) add(-here[l], here + l, reduced + l * width + l, m - l);
  }
}

// E^T mu.
void RunTimeFrame::reduce(const double* mu, double* to) const {
  with_pairs(pairs_of(m_), [&](auto constant) {
    combine_rows<decltype(constant)::value>(mu, 1, frame_.data(), pairs_of(m_), n_, to);
  });
}

// y <- (E^T I E)^-1 y.
void RunTimeFrame::solve_reduced() {
  if (diagonal_) return;
  const int m = m_, width = 2 * pairs_of(m);
  const double* const reduced = reduced_inertia_.data();
  double* const y = y_.data();
  for (int j = 0; j < m; ++j) {
    const double* const here = reduced + j * width;
    y[j] *= here[j];
    for (int i = j + 1; i < m; ++i) y[i] -= here[i] * y[j];
  }
  for (int j = m - 1; j >= 0; --j) {
    const double* const here = reduced + j * width;
    for (int i = j + 1; i < m; ++i) y[j] -= here[i] * y[i];
    y[j] *= here[j];
  }
}

// The velocity with A xi = c, E^T I xi = y.
void RunTimeFrame::combine(const double* inertia, const double* c, double* xi) {
  const int n = n_, apart = 2 * pairs_of(k_), width = 2 * pairs_of(m_);
  double *const work = work_.data(), *const y = y_.data();
  if (m_ < width) y[m_] = 0;  // also after values that were not finite
  std::fill_n(work, n, 0.0);
  if (!std::all_of(c, c + k_, [](double x) { return x == 0; })) {
    for (int j = 0; j < k_; ++j) {  // L^-1 c
      double sum = c[j];
      for (int i = 0; i < j; ++i) sum -= reflections_[static_cast<size_t>(i * apart + j)] * work[i];
      work[j] = sum * l_inverse_diagonal_[static_cast<size_t>(j)];
    }
    for (int j = k_ - 1; j >= 0; --j) reflect(j, work);
    weigh(work);
    if (!diagonal_) {
      double *const image = image_.data(), *const sums = sums_.data();
      for (int i = 0; i < n; ++i) image[i] = dot(inertia + i * n, work, n);
      reduce(image, sums);
      for (int j = 0; j < m_; ++j) y[j] -= sums[j];
    }
  }
  solve_reduced();
  for (int i = 0; i < n; ++i) xi[i] = work[i] + dot(frame_.data() + i * width, y, width);
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

void RunTimeFrame::velocity(const double* inertia, const double* mu, const double* c, double* xi) {
  reduce(mu, y_.data());
  combine(inertia, c, xi);
}

void RunTimeFrame::expand(const double* inertia, double* z) {
  for (int j = 0; j < k_; ++j)
    few_[static_cast<size_t>(j)] = z[j] / row_weights_[static_cast<size_t>(j)];
  std::copy_n(z + k_, m_, y_.begin());
  combine(inertia, few_.data(), z);
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
    for (int i = j + 1; i < k_; ++i)
      sum -= reflections_[static_cast<size_t>(j * width + i)] * lambda[i];
    lambda[j] = sum * l_inverse_diagonal_[static_cast<size_t>(j)];
  }
}

}  // namespace hamel
