// L D L^T of a small symmetric matrix of fixed size, without roots and with one division a row.
#pragma once

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

}  // namespace hamel
