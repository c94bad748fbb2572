// Factors of a small matrix whose blocks above the diagonal are zero. Not installed.
//
// Blocks of one size on the diagonal, D_b = P_b^T L_b U_b with pivots of columns; blocks below are
// as they are. Row b of M x = y is D_b x_b = y_b - sum_{c<b} M_bc x_c. Plain loops: dense products
// and factors of run-time sizes below about 16 cost several times their operations.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace hamel {

class BlockFactors {
 public:
  /// Of M, n x n, with blocks of `size`. Where a block is singular solutions are not finite.
  void compute(const Eigen::MatrixXd& M, Eigen::Index size);
  /// x <- M^-1 x.
  void solve(Eigen::VectorXd& x) const;
  /// The same of all columns of a matrix X^T: column i of it is row i of the right side.
  void solve_rows(Eigen::MatrixXd& rows) const;
  /// x <- M^-T x.
  void solve_transposed(Eigen::VectorXd& x) const;

 private:
  void factorise(Eigen::Index begin);
  // Rows of `width` numbers, one after the other.
  void solve_block(Eigen::Index begin, double* x, Eigen::Index width) const;

  Eigen::MatrixXd factors_;
  Eigen::VectorXd inverse_;  // of the diagonals of U
  std::vector<Eigen::Index> pivots_;
  Eigen::Index size_ = 0;
};

}  // namespace hamel
