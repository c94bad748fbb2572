#include <hamel/framework/tangent/block_factors.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hamel {
namespace {

void subtract_multiple(double factor, const double* from, double* to, Eigen::Index width) {
  for (Eigen::Index i = 0; i < width; ++i) to[i] -= factor * from[i];
}

}  // namespace

void BlockFactors::compute(const Eigen::MatrixXd& M, Eigen::Index size) {
  factors_ = M;
  size_ = size;
  inverse_.resize(M.rows());
  pivots_.resize(static_cast<std::size_t>(M.rows()));
  for (Eigen::Index begin = 0; begin < M.rows(); begin += size) factorise(begin);
}

void BlockFactors::factorise(Eigen::Index begin) {
  const Eigen::Index n = factors_.rows(), end = begin + size_;
  double* a = factors_.data();
  for (Eigen::Index j = begin; j < end; ++j) {
    double* column = a + j * n;
    Eigen::Index pivot = j;
    for (Eigen::Index i = j + 1; i < end; ++i)
      if (std::abs(column[i]) > std::abs(column[pivot])) pivot = i;
    pivots_[static_cast<std::size_t>(j)] = pivot;
    if (pivot != j)
      for (Eigen::Index k = begin; k < end; ++k) std::swap(a[j + k * n], a[pivot + k * n]);
    const double inverse = inverse_[j] = 1 / column[j];
    for (Eigen::Index i = j + 1; i < end; ++i) column[i] *= inverse;
    for (Eigen::Index k = j + 1; k < end; ++k)
      if (const double factor = a[j + k * n]; factor != 0)
        subtract_multiple(factor, column + j + 1, a + k * n + j + 1, end - j - 1);
  }
}

void BlockFactors::solve_block(Eigen::Index begin, double* x, Eigen::Index width) const {
  const Eigen::Index end = begin + size_;
  const auto row = [&](Eigen::Index i) { return x + i * width; };
  for (Eigen::Index j = begin; j < end; ++j)
    if (const Eigen::Index pivot = pivots_[static_cast<std::size_t>(j)]; pivot != j)
      std::swap_ranges(row(j), row(j) + width, row(pivot));
  for (Eigen::Index j = begin; j < end; ++j)
    for (Eigen::Index i = j + 1; i < end; ++i)
      if (const double factor = factors_(i, j); factor != 0)
        subtract_multiple(factor, row(j), row(i), width);
  for (Eigen::Index j = end; j-- > begin;) {
    for (Eigen::Index k = 0; k < width; ++k) row(j)[k] *= inverse_[j];
    for (Eigen::Index i = begin; i < j; ++i)
      if (const double factor = factors_(i, j); factor != 0)
        subtract_multiple(factor, row(j), row(i), width);
  }
}

void BlockFactors::solve(Eigen::VectorXd& x) const {
  const Eigen::Index n = factors_.rows();
  const auto column = [&](Eigen::Index j) { return factors_.data() + j * n; };
  for (Eigen::Index begin = 0; begin < n; begin += size_) {
    const Eigen::Index end = begin + size_;
    for (Eigen::Index j = begin; j < end; ++j)
      std::swap(x[j], x[pivots_[static_cast<std::size_t>(j)]]);
    for (Eigen::Index j = begin; j < end; ++j)
      subtract_multiple(x[j], column(j) + j + 1, x.data() + j + 1, end - j - 1);
    for (Eigen::Index j = end; j-- > begin;) {
      x[j] *= inverse_[j];
      subtract_multiple(x[j], column(j) + begin, x.data() + begin, j - begin);
    }
    for (Eigen::Index j = begin; j < end; ++j)
      subtract_multiple(x[j], column(j) + end, x.data() + end, n - end);
  }
}

void BlockFactors::solve_rows(Eigen::MatrixXd& rows) const {
  const Eigen::Index width = rows.rows();
  double* x = rows.data();
  for (Eigen::Index begin = 0; begin < factors_.rows(); begin += size_) {
    for (Eigen::Index c = 0; c < begin; ++c)
      for (Eigen::Index i = begin; i < begin + size_; ++i)
        if (const double factor = factors_(i, c); factor != 0)
          subtract_multiple(factor, x + c * width, x + i * width, width);
    solve_block(begin, x, width);
  }
}

// D_b^T = U^T L^T P.
void BlockFactors::solve_transposed(Eigen::VectorXd& x) const {
  for (Eigen::Index begin = factors_.rows() - size_; begin >= 0; begin -= size_) {
    const Eigen::Index end = begin + size_;
    for (Eigen::Index j = begin; j < end; ++j) {
      for (Eigen::Index i = begin; i < j; ++i) x[j] -= factors_(i, j) * x[i];
      x[j] *= inverse_[j];
    }
    for (Eigen::Index j = end; j-- > begin;) {
      for (Eigen::Index i = j + 1; i < end; ++i) x[j] -= factors_(i, j) * x[i];
    }
    for (Eigen::Index j = end; j-- > begin;)
      std::swap(x[j], x[pivots_[static_cast<std::size_t>(j)]]);
    for (Eigen::Index c = 0; c < begin; ++c)
      for (Eigen::Index i = begin; i < end; ++i) x[c] -= factors_(i, c) * x[i];
  }
}

}  // namespace hamel
