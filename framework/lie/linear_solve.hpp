// Linear equations of a dozen unknowns. One routine for all sizes: Eigen's decompositions cost
// seconds of compilation for each size, and a heap where the size is known at run time only.
#pragma once

#include <type_traits>

#include <Eigen/LU>

namespace hamel {

/// b <- a^-1 b by elimination with partial pivoting; a is n x n, b is n x columns, both
/// column-major, a is overwritten. NaN or infinite where a is singular. Source: Golub, Van Loan,
/// Matrix Computations, 3.4.
void solve_linear(double* a, double* b, int n, int columns);

/// out = a x with at most 16 rows, a column-major.
void multiply_few(const double* a, const double* x, double* out, int rows, int columns);
/// out = a x, out another vector of its size. Eigen's lazy products cost least where the sizes are
/// fixed, and more than twice as much where they are known at run time.
template <class Matrix, class Vector, class Product>
void multiply(const Matrix& a, const Vector& x, Product& out) {
  if constexpr (Matrix::SizeAtCompileTime != Eigen::Dynamic) {
    out = a.lazyProduct(x);
  } else if (a.rows() > 16) {
    out.noalias() = a * x;
  } else {
    multiply_few(a.data(), x.data(), out.data(), static_cast<int>(a.rows()),
                 static_cast<int>(a.cols()));
  }
}

/// m <- m + factor change (m^T along)^T, n x n with n at most 16, column-major.
void add_along(const double* along, const double* change, double factor, double* m, int n);

/// m^-1: in closed form up to 4 x 4.
template <class T, int N>
Eigen::Matrix<T, N, N> inverse_of(const Eigen::Matrix<T, N, N>& m) {
  if constexpr (N > 4 && std::is_same_v<T, double>) {
    Eigen::Matrix<T, N, N> work = m, inverse = Eigen::Matrix<T, N, N>::Identity();
    solve_linear(work.data(), inverse.data(), N, N);
    return inverse;
  } else {
    return m.inverse();
  }
}

}  // namespace hamel
