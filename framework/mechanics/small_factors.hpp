// Factors of a small symmetric matrix of fixed size: L D L^T, without roots and with one division a
// row, and G G^T (Cholesky), whose halves are solved one by one.
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Core>

namespace hamel {

/// The lower triangle of a symmetric S = L D L^T, L with a unit diagonal, is replaced by L D below
/// the diagonal and D^-1 on it, so that a solve does not divide; not a number from the first pivot
/// on that is not positive.
template <int K>
void factor_small(Eigen::Matrix<double, K, K>& s) {
#pragma GCC unroll 4
  for (int j = 0; j < K; ++j) {
#pragma GCC unroll 4
    for (int i = j; i < K; ++i) {
#pragma GCC unroll 4
      for (int l = 0; l < j; ++l) s(i, j) -= s(i, l) * s(j, l) * s(l, l);
    }
    s(j, j) = s(j, j) > 0 ? 1 / s(j, j) : std::numeric_limits<double>::quiet_NaN();
  }
}

/// c <- S^-1 c, S as factor_small left it.
template <int K>
void solve_small(const Eigen::Matrix<double, K, K>& s, Eigen::Matrix<double, K, 1>& c) {
#pragma GCC unroll 4
  for (int i = 0; i < K; ++i) {
#pragma GCC unroll 4
    for (int l = 0; l < i; ++l) c[i] -= s(i, l) * c[l];
    c[i] *= s(i, i);
  }
#pragma GCC unroll 4
  for (int i = K - 1; i >= 0; --i) {
    double sum = 0;
#pragma GCC unroll 4
    for (int l = i + 1; l < K; ++l) sum += s(l, i) * c[l];
    c[i] -= s(i, i) * sum;
  }
}

// (Inlined: a call would spill what a step keeps in registers, 70 instructions of the disk's
// 4,300.)

/// The lower triangle of S = G G^T is replaced by G, the inverses of its diagonal on it.
template <int M>
[[gnu::always_inline]] inline void factor_cholesky(Eigen::Matrix<double, M, M>& s) {
#pragma GCC unroll 4
  for (int j = 0; j < M; ++j) {
    const double inverse = 1 / std::sqrt(s(j, j));
    s(j, j) = inverse;
#pragma GCC unroll 4
    for (int i = j + 1; i < M; ++i) s(i, j) *= inverse;
#pragma GCC unroll 4
    for (int l = j + 1; l < M; ++l) {
#pragma GCC unroll 4
      for (int i = l; i < M; ++i) s(i, l) -= s(l, j) * s(i, j);
    }
  }
}

/// y <- G^-1 y, S as factor_cholesky left it. y: M numbers.
template <int M, class Vector>
[[gnu::always_inline]] inline void solve_lower(const Eigen::Matrix<double, M, M>& s, Vector&& y) {
#pragma GCC unroll 4
  for (int j = 0; j < M; ++j) {
#pragma GCC unroll 4
    for (int i = 0; i < j; ++i) y[j] -= s(j, i) * y[i];
    y[j] *= s(j, j);
  }
}

/// y <- G^-T y.
template <int M, class Vector>
[[gnu::always_inline]] inline void solve_upper(const Eigen::Matrix<double, M, M>& s, Vector&& y) {
#pragma GCC unroll 4
  for (int j = M - 1; j >= 0; --j) {
#pragma GCC unroll 4
    for (int i = j + 1; i < M; ++i) y[j] -= s(i, j) * y[i];
    y[j] *= s(j, j);
  }
}

}  // namespace hamel
