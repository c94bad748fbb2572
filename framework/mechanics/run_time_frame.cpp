#include <hamel/framework/mechanics/run_time_frame.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/mechanics/short_vectors.hpp>

namespace hamel {

using short_vectors::add, short_vectors::dot;

namespace {

size_t product(int rows, int columns) {
  return static_cast<size_t>(rows) * static_cast<size_t>(columns);
}

}  // namespace

RunTimeFrame::RunTimeFrame(int n, int k)
    : n_(n),
      k_(k),
      weights_(product(n, 1)),
      reflections_(product(n, k)),
      ends_(product(k, 1)),
      l_(product(k, k)),
      l_inverse_diagonal_(product(k, 1)),
      row_weights_(product(k, 1)),
      factors_(product(k, 1)),
      signs_(product(k, 1)),
      frame_(product(n, n - k)),
      reduced_inertia_(product(n - k, n - k)),
      few_(product(k, 1)),
      work_(product(n, 1)),
      image_(product(n, 1)),
      y_(product(n - k, 1)) {}

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

void RunTimeFrame::factor_rows(const double* a, bool keep_signs) {
  const int n = n_, k = k_;
  const double* const weights = weights_.data();
  for (int j = 0; j < k; ++j) {
    double* const v = reflection(j);
    const auto at = static_cast<size_t>(j);
    int end = n;
    while (end > j + 1 && a[j + (end - 1) * k] == 0) --end;
    for (int i = 0; i < end; ++i) v[i] = a[j + i * k] * weights[i];
    for (int i = end; i < n; ++i) v[i] = 0;
    row_weights_[at] = 1 / std::sqrt(dot(v, v, end));
    // By those before, of which it keeps what is then before its own entries.
    double* const l = l_.data() + j * k;
    for (int i = 0; i < j; ++i) {
      if (reflect(i, v)) end = std::max(end, ends_[static_cast<size_t>(i)]);
      l[i] = v[i];
    }
    ends_[at] = end;
    const double norm = std::sqrt(dot(v + j, v + j, end - j));
    double& sign = signs_[at];
    if (sign == 0) sign = v[j] < 0 ? -1 : 1;
    else if (!keep_signs && sign * v[j] < -0.1 * norm) sign = -sign;
    const double diagonal = sign * norm;
    l_inverse_diagonal_[at] = -1 / diagonal;
    v[j] += diagonal;
    factors_[at] = 1 / (diagonal * v[j]);
  }
}

// Whether that changes y.
bool RunTimeFrame::reflect(int j, double* y) const {
  const auto at = static_cast<size_t>(j);
  const double *const v = reflection(j) + j, factor = factors_[at];
  const int count = ends_[at] - j;
  const double along = dot(v, y + j, count);
  if (along == 0) return false;
  add(-factor * along, v, y + j, count);
  return true;
}

void RunTimeFrame::find_frame() {
  for (int j = 0; j < m(); ++j) {
    double* const column = frame(j);
    std::fill_n(column, n_, 0.0);
    int first = k_ + j;  // that is not 0
    column[first] = 1;
    for (int i = k_ - 1; i >= 0; --i) {
      if (ends_[static_cast<size_t>(i)] > first && reflect(i, column)) first = i;
    }
    for (int i = first; i < n_; ++i) column[i] *= weights_[static_cast<size_t>(i)];
  }
}

// E^T I E = G G^T: G in the lower triangle, the inverses of its diagonal on it.
void RunTimeFrame::reduce_inertia(const double* inertia) {
  const int n = n_, m = this->m();
  double* const image = image_.data();
  const double* const frame = frame_.data();
  double* const reduced = reduced_inertia_.data();
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) image[i] = dot(inertia + i * n, frame + j * n, n);
    for (int i = j; i < m; ++i) reduced[j * m + i] = dot(frame + i * n, image, n);
  }
  for (int j = 0; j < m; ++j) {
    double* const here = reduced + j * m;
    const double inverse = 1 / std::sqrt(here[j]);
    here[j] = inverse;
    for (int i = j + 1; i < m; ++i) here[i] *= inverse;
    for (int l = j + 1; l < m; ++l) add(-here[l], here + l, reduced + l * m + l, m - l);
  }
}

// y = E^T mu.
void RunTimeFrame::reduce(const double* mu) {
  for (int j = 0; j < m(); ++j) y_[static_cast<size_t>(j)] = dot(frame(j), mu, n_);
}

// y <- (E^T I E)^-1 y.
void RunTimeFrame::solve_reduced() {
  if (diagonal_) return;
  double* const y = y_.data();
  for (int j = 0; j < m(); ++j) {
    y[j] *= reduced(j)[j];
    add(-y[j], reduced(j) + j + 1, y + j + 1, m() - j - 1);
  }
  for (int j = m() - 1; j >= 0; --j) {
    y[j] -= dot(reduced(j) + j + 1, y + j + 1, m() - j - 1);
    y[j] *= reduced(j)[j];
  }
}

// The velocity with A xi = c, E^T I xi = y.
void RunTimeFrame::combine(const double* inertia, const double* c, double* xi) {
  double* const work = work_.data();
  std::fill_n(work, n_, 0.0);
  if (!std::all_of(c, c + k_, [](double x) { return x == 0; })) {
    for (int j = 0; j < k_; ++j)  // L^-1 c
      work[j] = (c[j] - dot(l_.data() + j * k_, work, j)) * l_inverse_diagonal_[static_cast<size_t>(j)];
    for (int j = k_ - 1; j >= 0; --j) reflect(j, work);
    weigh(work);
    if (!diagonal_) {
      double* const image = image_.data();
      for (int i = 0; i < n_; ++i) image[i] = dot(inertia + i * n_, work, n_);
      for (int j = 0; j < m(); ++j) y_[static_cast<size_t>(j)] -= dot(frame(j), image, n_);
    }
  }
  solve_reduced();
  std::copy_n(work, n_, xi);
  for (int j = 0; j < m(); ++j) add(y_[static_cast<size_t>(j)], frame(j), xi, n_);
}

void RunTimeFrame::assemble(const double* r, const double* c, double* f) {
  reduce(r);
  for (int j = 0; j < k_; ++j) f[j] = c[j] * row_weights_[static_cast<size_t>(j)];
  std::copy(y_.begin(), y_.end(), f + k_);
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
  reduce(mu);
  combine(inertia, c, xi);
}

void RunTimeFrame::expand(const double* inertia, double* z) {
  for (int j = 0; j < k_; ++j)
    few_[static_cast<size_t>(j)] = z[j] / row_weights_[static_cast<size_t>(j)];
  std::copy_n(z + k_, m(), y_.begin());
  combine(inertia, few_.data(), z);
}

// L^T lambda = the first k of O^T D^-1/2 times the reaction.
void RunTimeFrame::multipliers(const double* reaction, double* lambda) {
  double* const work = work_.data();
  std::copy_n(reaction, n_, work);
  weigh(work);
  for (int j = 0; j < k_; ++j) reflect(j, work);
  for (int j = k_ - 1; j >= 0; --j) {
    double sum = work[j];
    for (int i = j + 1; i < k_; ++i) sum -= l_[static_cast<size_t>(i * k_ + j)] * lambda[i];
    lambda[j] = sum * l_inverse_diagonal_[static_cast<size_t>(j)];
  }
}

}  // namespace hamel
