// The rows that are on and their reactions, where rows may depend on each other.
#include <algorithm>
#include <cmath>
#include <utility>

#include <hamel/framework/contact/contact_dynamics.hpp>
#include <hamel/framework/lie/linear_solve.hpp>

namespace hamel {
namespace {

// A pivot below this part of the largest one is round-off.
constexpr double kNoPivot = 1e-11;
// What is left of a row beside others, relative to it, that is round-off.
constexpr double kDependent = 1e-9;

}  // namespace

std::vector<int> ContactDynamics::rows(const ContactStates& states) const {
  std::vector<int> out = always_;
  for (int i = 0; i < count(); ++i) {
    const ContactMode mode = states[static_cast<size_t>(i)].mode;
    if (mode != ContactMode::open && law(i).normal) out.push_back(*law(i).normal);
    if (mode != ContactMode::rolls) continue;
    out.insert(out.end(), law(i).tangential.begin(), law(i).tangential.end());
  }
  std::sort(out.begin(), out.end());
  const size_t wanted = out.size();
  std::vector<int> kept;
  Eigen::MatrixXd basis(a_.cols(), static_cast<Eigen::Index>(wanted));
  const auto add = [&](int row) {
    const auto at = static_cast<Eigen::Index>(kept.size());
    Eigen::VectorXd rest = a_.row(row).transpose();
    const double length = rest.norm();
    for (int pass = 1; pass <= 2; ++pass)
      for (Eigen::Index j = 0; j < at; ++j) rest -= basis.col(j).dot(rest) * basis.col(j);
    if (!(rest.norm() > kDependent * length)) return;
    basis.col(at) = rest.normalized();
    kept.push_back(row);
  };
  for (const int row : always_) add(row);
  for (const int row : out)
    if (std::ranges::count(always_, row) == 0) add(row);
  std::sort(kept.begin(), kept.end());
  return kept;
}

// Gauss with complete pivoting of the first m rows of k_work_, which stay as U in the order of
// order_; b, m x columns, becomes the solution whose unknowns without a pivot are 0.
int ContactDynamics::eliminate(int m, double* b, int columns) {
  Eigen::Map<Eigen::MatrixXd> k(k_work_.data(), m, m), x(b, m, columns);
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
    x.row(rank).swap(x.row(rank + row));
    k.col(rank).swap(k.col(rank + column));
    std::swap(order_[static_cast<size_t>(rank)], order_[static_cast<size_t>(rank + column)]);
    for (int i = rank + 1; i < m; ++i) {
      const double factor = k(i, rank) / k(rank, rank);
      for (int j = rank; j < m; ++j) k(i, j) -= factor * k(rank, j);
      x.row(i) -= factor * x.row(rank);
    }
  }
  for (int c = 0; c < columns; ++c) {
    work_m_.setZero();
    for (int i = rank - 1; i >= 0; --i) {
      double sum = x(i, c);
      for (int j = i + 1; j < rank; ++j) sum -= k(i, j) * work_m_[order_[static_cast<size_t>(j)]];
      work_m_[order_[static_cast<size_t>(i)]] = sum / k(i, i);
    }
    for (int i = 0; i < m; ++i) x(i, c) = work_m_[i];
  }
  return rank;
}

void ContactDynamics::solve_rows(int m) {
  const int rank = eliminate(m, multipliers_.data(), 1);
  if (rank < m) share(m, rank);
}

// l + Z y, Z = [-U_1^-1 U_2; 1] the reactions without effect in the order of the pivots, with the
// least sum of squares of the entries in units of their bounds: Z^T B^-2 Z y = -Z^T B^-2 l.
void ContactDynamics::share(int m, int rank) {
  const Eigen::Map<Eigen::MatrixXd> k(k_work_.data(), m, m);
  const int open = m - rank;
  for (int c = 0; c < open; ++c) {
    for (int i = rank; i < m; ++i) null_(i, c) = i == rank + c ? 1 : 0;
    for (int i = rank - 1; i >= 0; --i) {
      double sum = -k(i, rank + c);
      for (int j = i + 1; j < rank; ++j) sum -= k(i, j) * null_(j, c);
      null_(i, c) = sum / k(i, i);
    }
  }
  Eigen::Map<Eigen::MatrixXd> equations(normal_equations_.data(), open, open);
  equations.setZero();
  work_m_.setZero();
  for (int i = 0; i < m; ++i) {
    const int row = order_[static_cast<size_t>(i)];
    const ContactLaw& law = this->law(on_[static_cast<size_t>(row)].contact);
    const double bound = law.normal ? 1 : law.friction * law.load;
    const double weight = bound > 0 ? 1 / (bound * bound) : 1;
    for (int c = 0; c < open; ++c) {
      work_m_[c] -= weight * null_(i, c) * multipliers_[row];
      for (int d = 0; d < open; ++d) equations(c, d) += weight * null_(i, c) * null_(i, d);
    }
  }
  solve_linear(equations.data(), work_m_.data(), open, 1);
  for (int i = 0; i < m; ++i)
    for (int c = 0; c < open; ++c)
      multipliers_[order_[static_cast<size_t>(i)]] += work_m_[c] * null_(i, c);
}

}  // namespace hamel
