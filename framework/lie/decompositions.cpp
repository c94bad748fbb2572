#include <hamel/framework/lie/decompositions.hpp>

#include <algorithm>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace hamel::dense {

Svd svd(const Matrix& m, unsigned options) {
  const Eigen::JacobiSVD<Matrix> svd(m, options);
  Svd out{svd.singularValues(), {}, {}};
  if (svd.computeU()) out.u = svd.matrixU();
  if (svd.computeV()) out.v = svd.matrixV();
  return out;
}

Qr qr(const Matrix& m) {
  const Eigen::HouseholderQR<Matrix> qr(m);
  return {qr.householderQ(),
          qr.matrixQR().topRows(std::min(m.rows(), m.cols())).triangularView<Eigen::Upper>()};
}
Eigen::Index rank(const Matrix& m, double threshold) {
  Eigen::ColPivHouseholderQR<Matrix> qr(m);
  if (threshold > 0) qr.setThreshold(threshold);
  return qr.rank();
}
std::vector<int> pivots(const Matrix& m) {
  const Eigen::ColPivHouseholderQR<Matrix> qr(m);
  const auto& order = qr.colsPermutation().indices();
  return {order.begin(), order.end()};
}
Matrix pivoted_q(const Matrix& m) { return Eigen::ColPivHouseholderQR<Matrix>(m).householderQ(); }
Matrix solve_pivoted(const Matrix& a, const Matrix& b) {
  return Eigen::ColPivHouseholderQR<Matrix>(a).solve(b);
}
Vector least_norm(const Matrix& a, const Vector& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Matrix> decomposition(a.rows(), a.cols());
  decomposition.setThreshold(threshold);
  return decomposition.compute(a).solve(b);
}

Matrix kernel(const Matrix& m, double threshold) {
  Eigen::FullPivLU<Matrix> decomposition(m);
  if (threshold > 0) decomposition.setThreshold(threshold);
  return decomposition.kernel();
}
Matrix inverse(const Matrix& m) { return m.inverse(); }
Matrix solve_symmetric(const Matrix& a, const Matrix& b) { return a.ldlt().solve(b); }
Matrix solve_lower(const Matrix& a, const Matrix& b) { return a.llt().matrixL().solve(b); }

Pivots pivots_of(const Eigen::PartialPivLU<Matrix>& lu) {
  if (lu.matrixLU().size() == 0) return {};
  const auto pivots = lu.matrixLU().diagonal();
  const double determinant = lu.determinant();
  const double least = pivots.cwiseAbs().minCoeff(), most = pivots.cwiseAbs().maxCoeff();
  if (!(least > 0)) return {0, std::numeric_limits<double>::infinity()};
  return {determinant > 0 ? 1 : determinant < 0 ? -1 : 0, most / least};
}

SymmetricEigen symmetric_eigen(const Matrix& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}
Vector symmetric_eigenvalues(const Matrix& m) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(m, Eigen::EigenvaluesOnly).eigenvalues();
}

Eigensystem eigen(const Matrix& m) {
  const Eigen::EigenSolver<Matrix> solver(m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}
Eigen::VectorXcd eigenvalues(const Matrix& m) {
  return Eigen::EigenSolver<Matrix>(m, false).eigenvalues();
}
Eigen::MatrixXcd left_eigenvectors(const Eigensystem& right) {
  return right.vectors.partialPivLu().inverse().adjoint();
}

}  // namespace hamel::dense
