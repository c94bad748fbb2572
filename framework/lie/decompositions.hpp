// Decompositions of matrices whose sizes are known at run time only, compiled once: each costs
// seconds of compilation wherever it is instantiated. For sources of the library: no installed
// header includes this one, since a user's flags may align Eigen's memory differently.
#pragma once

#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

namespace hamel::dense {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// m = u diag(values) v^T, the largest value first; u, v empty where the options do not request
/// them.
struct Svd {
  Vector values;
  Matrix u, v;
};
/// By Jacobi's method. Options: Eigen::ComputeThinU, ComputeFullU, ComputeFullV.
Svd svd(const Matrix& m, unsigned options = 0);

/// m = Q R by Householder's reflections.
struct Qr {
  Matrix q;  // square
  Matrix r;  // upper triangular, as many rows as the smaller size
};
Qr qr(const Matrix& m);
/// The rank of m by QR with pivoted columns; threshold: relative to the largest pivot, 0 for
/// Eigen's.
Eigen::Index rank(const Matrix& m, double threshold = 0);
/// The columns of m in the order in which QR with pivoted columns takes them.
std::vector<int> pivots(const Matrix& m);
/// Q of QR with pivoted columns, square.
Matrix pivoted_q(const Matrix& m);
/// x with a x = b, or of least residual, by QR with pivoted columns.
Matrix solve_pivoted(const Matrix& a, const Matrix& b);
/// The x of least norm among those of least residual; threshold: of the rank of a, relative.
Vector least_norm(const Matrix& a, const Vector& b, double threshold);

/// Columns that span {x : m x = 0}, by LU with full pivoting; one column of zeros where that is 0.
/// threshold: as of rank().
Matrix kernel(const Matrix& m, double threshold = 0);
Matrix inverse(const Matrix& m);
/// x with a x = b for a symmetric and semi-definite.
Matrix solve_symmetric(const Matrix& a, const Matrix& b);
/// L^-1 b for a = L L^T symmetric and positive definite.
Matrix solve_lower(const Matrix& a, const Matrix& b);

/// The sign of det m, 0 where a pivot is, and the largest over the smallest pivot of an LU
/// decomposition.
struct Pivots {
  int sign = 1;
  double ratio = 1;
};
Pivots pivots_of(const Eigen::PartialPivLU<Matrix>& lu);

/// Eigenvalues and eigenvectors of a symmetric matrix, in ascending order.
struct SymmetricEigen {
  Vector values;
  Matrix vectors;
};
SymmetricEigen symmetric_eigen(const Matrix& m);
Vector symmetric_eigenvalues(const Matrix& m);

/// m vectors = vectors diag(values).
struct Eigensystem {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};
Eigensystem eigen(const Matrix& m);
Eigen::VectorXcd eigenvalues(const Matrix& m);
/// Left eigenvectors of the same matrix, w^H m = value w^H and w^H v = 1, as columns; not finite
/// where m has a Jordan block.
Eigen::MatrixXcd left_eigenvectors(const Eigensystem& right);

}  // namespace hamel::dense
