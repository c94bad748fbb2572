// Reactions of rows that are on, where these may depend on each other.
#include <cmath>
#include <utility>

#include <hamel/framework/contact/contact_dynamics.hpp>
#include <hamel/framework/lie/linear_solve.hpp>

namespace hamel {
namespace {

// A pivot below this part of the largest one is round-off.
constexpr double kNoPivot = 1e-11;

}  // namespace

// Gauss with complete pivoting; unknowns without a pivot are 0 at first.
void ContactDynamics::solve_rows(int m) {
  Eigen::Map<Eigen::MatrixXd> k(k_work_.data(), m, m);
  auto x = multipliers_.head(m);
  for (int i = 0; i < m; ++i) order_[static_cast<size_t>(i)] = i;
  int rank = 0;
  double first = 0;
  for (; rank < m; ++rank) {
    int row = 0, column = 0;
    const int left = m - rank;
    const double pivot = k.bottomRightCorner(left, left).cwiseAbs().maxCoeff(&row, &column);
    if (rank == 0) first = pivot;
    if (!(pivot > kNoPivot * first)) break;
    k.row(rank).swap(k.row(rank + row));
    std::swap(x[rank], x[rank + row]);
    k.col(rank).swap(k.col(rank + column));
    std::swap(order_[static_cast<size_t>(rank)], order_[static_cast<size_t>(rank + column)]);
    for (int i = rank + 1; i < m; ++i) {
      const double factor = k(i, rank) / k(rank, rank);
      for (int j = rank; j < m; ++j) k(i, j) -= factor * k(rank, j);
      x[i] -= factor * x[rank];
    }
  }
  for (int i = rank; i < m; ++i) x[i] = 0;
  for (int i = rank - 1; i >= 0; --i) {
    for (int j = i + 1; j < rank; ++j) x[i] -= k(i, j) * x[j];
    x[i] /= k(i, i);
  }
  if (rank < m) share(m, rank);
  for (int i = 0; i < m; ++i) c_[order_[static_cast<size_t>(i)]] = x[i];
  x = c_.head(m);
}

// In the order of the pivots: x + Z y, Z = [-U_1^-1 U_2; 1] the reactions without effect, with the
// least sum of squares of its entries in units of their bounds: Z^T B^-2 Z y = -Z^T B^-2 x.
void ContactDynamics::share(int m, int rank) {
  Eigen::Map<Eigen::MatrixXd> k(k_work_.data(), m, m);
  auto x = multipliers_.head(m);
  const int open = m - rank;
  for (int c = 0; c < open; ++c) {
    for (int i = 0; i < m; ++i) null_(i, c) = i == rank + c ? 1 : 0;
    for (int i = rank - 1; i >= 0; --i) {
      double sum = -k(i, rank + c);
      for (int j = i + 1; j < rank; ++j) sum -= k(i, j) * null_(j, c);
      null_(i, c) = sum / k(i, i);
    }
  }
  const auto weight = [this](int i) {
    const ContactLaw& law = this->law(on_[static_cast<size_t>(order_[static_cast<size_t>(i)])].contact);
    const double bound = law.normal ? 1 : law.friction * law.load;
    return bound > 0 ? 1 / (bound * bound) : 1;
  };
  Eigen::Map<Eigen::MatrixXd> equations(normal_equations_.data(), open, open);
  for (int c = 0; c < open; ++c) {
    right_.data()[c] = 0;
    for (int d = 0; d < open; ++d) equations(c, d) = 0;
    for (int i = 0; i < m; ++i) {
      const double part = null_(i, c) * weight(i);
      right_.data()[c] -= part * x[i];
      for (int d = 0; d < open; ++d) equations(c, d) += part * null_(i, d);
    }
  }
  solve_linear(equations.data(), right_.data(), open, 1);
  for (int c = 0; c < open; ++c)
    for (int i = 0; i < m; ++i) x[i] += right_.data()[c] * null_(i, c);
}

}  // namespace hamel
