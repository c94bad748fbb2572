#include <hamel/framework/mechanics/frame.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/lie/decompositions.hpp>

namespace hamel {
namespace {

// Basis of ker A, orthonormal columns; the rows of A are independent.
Eigen::MatrixXd basis_of_kernel(const Eigen::MatrixXd& constraints) {
  const auto n = constraints.cols();
  if (constraints.rows() == 0) return Eigen::MatrixXd::Identity(n, n);
  return dense::qr(constraints.transpose()).q.rightCols(n - constraints.rows());
}

bool definite(const Eigen::VectorXd& values) {
  return values.minCoeff() > 1e-14 * values.maxCoeff();
}

}  // namespace

Eigen::VectorXd velocity_units(const Eigen::MatrixXd& inertia) {
  const Eigen::VectorXd own = inertia.diagonal();
  return own.cwiseMax(1e-14 * own.maxCoeff()).cwiseSqrt().cwiseInverse();
}

bool is_definite(const Eigen::MatrixXd& symmetric) {
  return definite(dense::symmetric_eigenvalues(symmetric));
}

void detail::hamel_frame(const Eigen::MatrixXd& inertia, const Eigen::MatrixXd& constraints,
                         Eigen::Ref<Eigen::MatrixXd> frame) {
  const Eigen::MatrixXd basis = basis_of_kernel(constraints);
  // E = B L^-T:  E^T I E = L^-1 (B^T I B) L^-T = Id.
  frame = dense::solve_lower(basis.transpose() * inertia * basis, basis.transpose()).transpose();
}

std::vector<std::string> check_system_matrices(const Eigen::MatrixXd& inertia,
                                               const Eigen::MatrixXd& constraints, int n,
                                               bool driven) {
  std::vector<std::string> mistakes;
  if (constraints.cols() != n) {
    mistakes.push_back(
        fmt::format("constraints: rows of {} entries, expected {}", constraints.cols(), n));
  } else if (!constraints.allFinite()) {
    mistakes.push_back("constraints: an entry is not finite");
  } else if (constraints.rows() > 0) {
    const auto rank = dense::rank(constraints.transpose());
    if (rank < constraints.rows()) {
      mistakes.push_back(fmt::format("constraints: {} rows of rank {}; rows must be independent",
                                     constraints.rows(), rank));
    } else if (rank == n && !driven) {
      mistakes.push_back(
          fmt::format("constraints: {} independent rows leave no motion in dimension {}", rank, n));
    }
  }
  const bool sound = mistakes.empty();  // the rows
  if (inertia.rows() != n || inertia.cols() != n) {
    mistakes.push_back(fmt::format("inertia: got {} x {}, expected {} x {}", inertia.rows(),
                                   inertia.cols(), n, n));
  } else if (!inertia.allFinite()) {
    mistakes.push_back("inertia: an entry is not finite");
  } else if (const double asymmetry = (inertia - inertia.transpose()).norm();
             asymmetry > 1e-12 * inertia.norm()) {
    mistakes.push_back(fmt::format("inertia: not symmetric, |I - I'| = {:.3g}", asymmetry));
  } else if (const Eigen::VectorXd values = dense::symmetric_eigenvalues(inertia);
             !definite(values)) {
    const bool massless = values.maxCoeff() > 0 && values.minCoeff() > -1e-14 * values.maxCoeff();
    if (!massless || !sound) {
      mistakes.push_back(fmt::format("inertia: not positive definite, eigenvalues {:.6g}",
                                     fmt::join(values.begin(), values.end(), ", ")));
    } else {
      const Eigen::MatrixXd basis = basis_of_kernel(constraints);
      const Eigen::VectorXd reduced =
          dense::symmetric_eigenvalues(basis.transpose() * inertia * basis);
      if (!definite(reduced)) {
        mistakes.push_back(fmt::format(
            "inertia: not positive definite, and not on the admissible velocities either, "
            "eigenvalues {:.6g} there",
            fmt::join(reduced.begin(), reduced.end(), ", ")));
      }
    }
  }
  return mistakes;
}

}  // namespace hamel
