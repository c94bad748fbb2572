// The Hamel frame, an I-orthonormal basis of d = ker A: (M5) of framework/schemes/README.md.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace hamel {
namespace detail {
// Into n x m: memory that Eigen took is given back where it was taken (lie/types.hpp).
void hamel_frame(const Eigen::MatrixXd& inertia, const Eigen::MatrixXd& constraints,
                 Eigen::Ref<Eigen::MatrixXd> frame);
}  // namespace detail

/// E: n x m with A E = 0 and E^T I E = Id, m = n - k. From the QR factors of A^T (the last m
/// columns of Q span ker A) and a Cholesky factor of I restricted to them. inertia: n x n positive
/// definite; constraints: k x n of rank k.
inline Eigen::MatrixXd hamel_frame(const Eigen::MatrixXd& inertia,
                                   const Eigen::MatrixXd& constraints) {
  Eigen::MatrixXd frame(inertia.rows(), inertia.rows() - constraints.rows());
  detail::hamel_frame(inertia, constraints, frame);
  return frame;
}

/// Units of velocities that do not depend on those chosen: 1/sqrt(I_ii), the rate at which each has
/// an energy of 1/2 alone; of massless links that of 1e-14 of the largest.
Eigen::VectorXd velocity_units(const Eigen::MatrixXd& inertia);

/// Are all eigenvalues positive, above 1e-14 of the largest?
bool is_definite(const Eigen::MatrixXd& symmetric);

/// The mistakes in an inertia and constraint rows for a group of dimension n: shape, NaN, symmetry,
/// definiteness, rank. Empty when there are none. Where the inertia is semidefinite, as with
/// massless links, it has to be definite on ker A. As many independent rows as dimensions leave a
/// motion where it is driven, A xi = b with b not 0.
std::vector<std::string> check_system_matrices(const Eigen::MatrixXd& inertia,
                                               const Eigen::MatrixXd& constraints, int n,
                                               bool driven);

}  // namespace hamel
