#include <hamel/framework/mechanics/frame.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace hamel {

void detail::hamel_frame(const Eigen::MatrixXd& inertia, const Eigen::MatrixXd& constraints,
                         Eigen::Ref<Eigen::MatrixXd> frame) {
  const auto n = inertia.rows();
  Eigen::MatrixXd basis = Eigen::MatrixXd::Identity(n, n);
  if (constraints.rows() > 0) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(constraints.transpose());
    const Eigen::MatrixXd q = qr.householderQ();
    basis = q.rightCols(n - constraints.rows());
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(basis.transpose() * inertia * basis);
  // E = B L^-T:  E^T I E = L^-1 (B^T I B) L^-T = Id.
  frame = llt.matrixL().solve(basis.transpose()).transpose();
}

std::vector<std::string> check_system_matrices(const Eigen::MatrixXd& inertia,
                                               const Eigen::MatrixXd& constraints, int n) {
  std::vector<std::string> mistakes;
  if (inertia.rows() != n || inertia.cols() != n) {
    mistakes.push_back(fmt::format("inertia: got {} x {}, expected {} x {}", inertia.rows(),
                                   inertia.cols(), n, n));
  } else if (!inertia.allFinite()) {
    mistakes.push_back("inertia: an entry is not finite");
  } else {
    const double asymmetry = (inertia - inertia.transpose()).norm();
    const Eigen::VectorXd values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(inertia, Eigen::EigenvaluesOnly)
            .eigenvalues();
    if (asymmetry > 1e-12 * inertia.norm()) {
      mistakes.push_back(fmt::format("inertia: not symmetric, |I - I'| = {:.3g}", asymmetry));
    } else if (!(values.minCoeff() > 1e-14 * values.maxCoeff())) {
      mistakes.push_back(fmt::format("inertia: not positive definite, eigenvalues {:.6g}",
                                     fmt::join(values.begin(), values.end(), ", ")));
    }
  }
  if (constraints.cols() != n) {
    mistakes.push_back(
        fmt::format("constraints: rows of {} entries, expected {}", constraints.cols(), n));
  } else if (!constraints.allFinite()) {
    mistakes.push_back("constraints: an entry is not finite");
  } else if (constraints.rows() > 0) {
    const auto rank = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(constraints.transpose()).rank();
    if (rank < constraints.rows()) {
      mistakes.push_back(fmt::format("constraints: {} rows of rank {}; rows must be independent",
                                     constraints.rows(), rank));
    } else if (rank == n) {
      mistakes.push_back(
          fmt::format("constraints: {} independent rows leave no motion in dimension {}", rank, n));
    }
  }
  return mistakes;
}

}  // namespace hamel
