// Elimination with complete pivoting of a few equations that may depend on each other. No heap
// behind the constructor. Source: Golub, Van Loan, Matrix Computations, 3.4.8.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace hamel {

class Pivots {
 public:
  using Matrix = Eigen::Ref<Eigen::MatrixXd>;

  /// most: unknowns.
  explicit Pivots(int most) : order_(static_cast<std::size_t>(most)), work_(most) {}

  /// k, m x m, stays as U in the order of the pivots; b, m x columns, becomes the solution whose
  /// unknowns without a pivot are 0. Returns the rank: a pivot of 1e-11 of the first is round-off.
  int eliminate(Matrix k, Matrix b);
  /// Behind it: the largest right side that equations without a pivot leave, and nothing solves.
  double left() const { return left_; }
  /// Behind it: Z with K Z = 0, m x (m - rank), [-U_1^-1 U_2; 1] in the order of the pivots.
  void find_null(const Eigen::Ref<const Eigen::MatrixXd>& k, int rank, Matrix out) const;
  /// The unknown of a pivot.
  int of(int pivot) const { return order_[static_cast<std::size_t>(pivot)]; }

 private:
  std::vector<int> order_;
  Eigen::VectorXd work_;
  double left_ = 0;
};

}  // namespace hamel
