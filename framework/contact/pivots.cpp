#include <hamel/framework/contact/pivots.hpp>

#include <utility>

namespace hamel {
namespace {

constexpr double kNoPivot = 1e-11;

}  // namespace

int Pivots::eliminate(Matrix k, Matrix b) {
  const auto m = static_cast<int>(k.rows());
  for (int i = 0; i < m; ++i) order_[static_cast<std::size_t>(i)] = i;
  int rank = 0;
  double first = 0;
  for (; rank < m; ++rank) {
    int row = 0, column = 0;
    const int left = m - rank;
    const double pivot = k.bottomRightCorner(left, left).cwiseAbs().maxCoeff(&row, &column);
    if (rank == 0) first = pivot;
    if (!(pivot > kNoPivot * first)) break;
    k.row(rank).swap(k.row(rank + row));
    b.row(rank).swap(b.row(rank + row));
    k.col(rank).swap(k.col(rank + column));
    std::swap(order_[static_cast<std::size_t>(rank)],
              order_[static_cast<std::size_t>(rank + column)]);
    for (int i = rank + 1; i < m; ++i) {
      const double factor = k(i, rank) / k(rank, rank);
      for (int j = rank; j < m; ++j) k(i, j) -= factor * k(rank, j);
      b.row(i) -= factor * b.row(rank);
    }
  }
  left_ = rank < m && b.cols() > 0 ? b.bottomRows(m - rank).cwiseAbs().maxCoeff() : 0;
  for (Eigen::Index c = 0; c < b.cols(); ++c) {
    work_.setZero();
    for (int i = rank - 1; i >= 0; --i) {
      double sum = b(i, c);
      for (int j = i + 1; j < rank; ++j) sum -= k(i, j) * work_[of(j)];
      work_[of(i)] = sum / k(i, i);
    }
    for (int i = 0; i < m; ++i) b(i, c) = work_[i];
  }
  return rank;
}

void Pivots::find_null(const Eigen::Ref<const Eigen::MatrixXd>& k, int rank, Matrix out) const {
  const auto m = static_cast<int>(k.rows());
  for (int c = 0; c < m - rank; ++c) {
    for (int i = rank; i < m; ++i) out(of(i), c) = i == rank + c ? 1 : 0;
    for (int i = rank - 1; i >= 0; --i) {
      double sum = -k(i, rank + c);
      for (int j = i + 1; j < rank; ++j) sum -= k(i, j) * out(of(j), c);
      out(of(i), c) = sum / k(i, i);
    }
  }
}

}  // namespace hamel
