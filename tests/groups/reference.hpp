// A reference in 80 digits: small matrices of mpfr::mpreal, exponentials and dexp from their
// series.
#pragma once

#include <mpreal.h>

#include <Eigen/Core>
#include <vector>

namespace reference {

using mpfr::mpreal;

/// Square or rectangular, row by row.
struct Big {
  int rows, cols;
  std::vector<mpreal> a;
  Big(int r, int c) : rows(r), cols(c), a(static_cast<std::size_t>(r * c), mpreal(0)) {}
  mpreal& operator()(int i, int j) { return a[static_cast<std::size_t>(i * cols + j)]; }
  const mpreal& operator()(int i, int j) const { return a[static_cast<std::size_t>(i * cols + j)]; }
};

inline void use_80_digits() { mpreal::set_default_prec(mpfr::digits2bits(80)); }

inline Big identity(int n) {
  Big m(n, n);
  for (int i = 0; i < n; ++i) m(i, i) = 1;
  return m;
}
template <class Derived>
Big big(const Eigen::MatrixBase<Derived>& m) {
  Big r(static_cast<int>(m.rows()), static_cast<int>(m.cols()));
  for (int i = 0; i < r.rows; ++i) {
    for (int j = 0; j < r.cols; ++j) r(i, j) = mpreal(m(i, j));
  }
  return r;
}
inline Big multiply(const Big& x, const Big& y) {
  Big r(x.rows, y.cols);
  for (int i = 0; i < x.rows; ++i) {
    for (int j = 0; j < y.cols; ++j) {
      for (int k = 0; k < x.cols; ++k) r(i, j) += x(i, k) * y(k, j);
    }
  }
  return r;
}
/// x + s y.
inline Big add(const Big& x, const Big& y, const mpreal& s) {
  Big r = x;
  for (std::size_t i = 0; i < r.a.size(); ++i) r.a[i] += s * y.a[i];
  return r;
}
inline Big transpose(const Big& x) {
  Big r(x.cols, x.rows);
  for (int i = 0; i < x.rows; ++i) {
    for (int j = 0; j < x.cols; ++j) r(j, i) = x(i, j);
  }
  return r;
}
/// Gauss-Jordan with pivoting.
inline Big invert(Big m) {
  const int n = m.rows;
  Big r = identity(n);
  for (int c = 0; c < n; ++c) {
    int best = c;
    for (int i = c + 1; i < n; ++i) {
      if (abs(m(i, c)) > abs(m(best, c))) best = i;
    }
    for (int j = 0; j < n; ++j) {
      std::swap(m(c, j), m(best, j));
      std::swap(r(c, j), r(best, j));
    }
    const mpreal pivot = m(c, c);
    for (int j = 0; j < n; ++j) m(c, j) /= pivot, r(c, j) /= pivot;
    for (int i = 0; i < n; ++i) {
      if (i == c) continue;
      const mpreal f = m(i, c);
      for (int j = 0; j < n; ++j) m(i, j) -= f * m(c, j), r(i, j) -= f * r(c, j);
    }
  }
  return r;
}
/// sum x^j/(j + shift)!: the exponential (shift 0), dR exp of ad (shift 1).
inline Big series(const Big& x, int shift) {
  Big term = identity(x.rows), sum(x.rows, x.cols);
  for (int j = 0; j < 120; ++j) {
    sum = add(sum, term, mpreal(1));
    term = multiply(term, x);
    for (auto& entry : term.a) entry /= j + 1 + shift;
  }
  return sum;
}

/// max |m - exact| over the entries, relative to the largest entry of exact.
template <class Derived>
double error(const Eigen::MatrixBase<Derived>& m, const Big& exact) {
  mpreal worst = 0, size = 0;
  for (int i = 0; i < exact.rows; ++i) {
    for (int j = 0; j < exact.cols; ++j) {
      const mpreal difference = abs(mpreal(m(i, j)) - exact(i, j));
      if (!(difference <= worst)) worst = difference;
      if (abs(exact(i, j)) > size) size = abs(exact(i, j));
    }
  }
  return (worst / size).toDouble();
}

}  // namespace reference
