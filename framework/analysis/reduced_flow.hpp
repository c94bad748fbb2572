// The flow of a system and its symmetries, pointwise and by values only. For steady.cpp, not
// installed.
//
//   Z(g, xi) = (xi, a(g, xi)):  I a = ad*_xi I xi + force - (dI/dt) xi + A^T lambda,
//                               A a = db/dt - (dA/dt) xi.
// A pair (zeta, eta) of the algebra moves g to exp(e zeta) g exp(e eta), so that xi becomes
// Ad_exp(-e eta) xi:
//   X_(zeta, eta)(g, xi) = (Ad_g^-1 zeta + eta, -ad_eta xi),
// and is a symmetry where inertia, ker A, drift, force and phi go with it. The left factor is the
// symmetry of the space around (a level ground), the right one that of the body (a disk and its
// axis). Derivatives are central differences of order 10, 11 points 0.01 apart: round-off 1e-13,
// truncation h^10/2772 of the eleventh derivative.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel::reduced {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr double kStep = 0.01;

/// sum of weight * f(shift) is f'(0): calls add(shift, weight).
template <class Add>
void differentiate(double step, Add&& add) {
  constexpr double weights[] = {5.0 / 6, -5.0 / 21, 5.0 / 84, -5.0 / 504, 1.0 / 1260};
  for (int k = 1; k <= 5; ++k) {
    for (const double side : {step, -step}) add(k * side, weights[k - 1] / side);
  }
}

class Flow {
 public:
  Flow(std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Mechanics> mechanics)
      : geometry_(std::move(geometry)), mechanics_(std::move(mechanics)) {}

  int dim() const { return mechanics_->dim(); }
  int constraint_count() const { return mechanics_->constraint_count(); }
  int holonomic_rows() const { return mechanics_->holonomic_rows(); }
  /// g tau(eta).
  Vector moved(const Vector& g, const Vector& eta) const;
  /// The eta with g tau(eta) = h; 0 where h is out of reach.
  Vector difference(const Vector& g, const Vector& h) const;
  /// a(g, xi).
  Vector acceleration(const Vector& g, const Vector& xi) const;
  /// I(g) xi.
  Vector momentum(const Vector& g, const Vector& xi) const;
  /// phi(g), and A xi - b.
  Vector holonomic(const Vector& g) const;
  Vector slip(const Vector& g, const Vector& xi) const;
  /// ad_xi as a matrix; Ad_g^-1.
  Matrix ad(const Vector& xi) const;
  Matrix Ad_inverse(const Vector& g) const;

  /// A basis of the symmetries that move something, columns (zeta, eta), found at some places near
  /// g. Symmetries that move nothing, as (zeta, -zeta) of a commutative factor, are left out.
  Matrix symmetries(const Vector& g) const;
  /// The columns X_s(g, xi) of these symmetries.
  Matrix orbit(const Matrix& symmetries, const Vector& g, const Vector& xi) const;

 private:
  // The quantities a symmetry keeps, at (g exp(e eta), Ad xi), seen from before the move.
  Vector kept(const Vector& g, const Vector& xi, const Vector& eta, double e) const;

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> mechanics_;
};

/// Orthonormal bases of the range and of the kernel. Singular values below `least` of the largest
/// are none; those of a matrix that is all round-off beside `scale` all are.
Matrix range_of(const Matrix& m, double least, double scale = 0);
Matrix kernel_of(const Matrix& m, double least, double scale = 0);

}  // namespace hamel::reduced
