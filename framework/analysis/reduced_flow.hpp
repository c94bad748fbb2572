// The flow of a system and its symmetries, pointwise. For steady.cpp, not installed.
//
//   Z(g, xi) = (xi, a(g, xi)):  I a = ad*_xi I xi + force - (dI/dt) xi + A^T lambda,
//                               A a = db/dt - (dA/dt) xi.
// A pair (zeta, eta) of the algebra moves g to exp(e zeta) g exp(e eta), so that xi becomes
// Ad_exp(-e eta) xi:
//   X_(zeta, eta)(g, xi) = (Ad_g^-1 zeta + eta, -ad_eta xi),
// and is a symmetry where inertia, ker A, drift, force and phi go with it. The left factor is the
// symmetry of the space around (a level ground), the right one that of the body (a disk and its
// axis). Derivatives are exact where the system has formulas (recorded_motion.hpp). Those of a
// system that is known by its values are those of central_differences.hpp: along angles, and
// lengths of a system that has a radius of gyration, in steps of that scale, along others in steps
// of any.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/analysis/central_differences.hpp>
#include <hamel/framework/analysis/recorded_motion.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel::reduced {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// sum of weight * f(shift) is f'(0), by order 10 in steps of h/64, f smooth over h: for iterations
/// that need no error. Calls add(shift, weight).
template <class Add>
void differentiate(double h, Add&& add) {
  constexpr double weights[] = {5.0 / 6, -5.0 / 21, 5.0 / 84, -5.0 / 504, 1.0 / 1260};
  for (int k = 1; k <= 5; ++k) {
    for (const double step : {h / 64, -h / 64}) add(k * step, weights[k - 1] / step);
  }
}

class Flow {
 public:
  /// scales: own_scales() of the system (natural_units.hpp). recorded: null where the system is
  /// known by its values only.
  Flow(std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Mechanics> mechanics,
       Vector scales, std::shared_ptr<const RecordedMotion> recorded)
      : geometry_(std::move(geometry)),
        mechanics_(std::move(mechanics)),
        recorded_(std::move(recorded)),
        scales_(std::move(scales)),
        units_(scales_.unaryExpr([](double scale) { return scale > 0 ? scale : 1; })) {}

  /// The formulas of the system, or null.
  const std::shared_ptr<const RecordedMotion>& recorded() const { return recorded_; }
  int dim() const { return mechanics_->dim(); }
  int constraint_count() const { return mechanics_->constraint_count(); }
  int holonomic_rows() const { return mechanics_->holonomic_rows(); }
  const Vector& scales() const { return scales_; }
  /// Scales, with other lengths for the components that have none, 1 where none is set.
  const Vector& units() const { return units_; }
  void set_units(Vector units) { units_ = std::move(units); }
  /// Free of rows, and of forces beside a potential.
  bool is_conservative() const {
    return constraint_count() == 0 && !mechanics_->has_force() && !mechanics_->has_drift();
  }
  /// a(g, xi) = a(g, -xi) by the kind of its forces: time may run backwards.
  bool is_reversible() const {
    return !mechanics_->has_drift() &&
           (!mechanics_->has_force() || !mechanics_->force_depends_on_velocity());
  }
  /// By displacement, the length over which inertia and rows are smooth at g.
  Vector extents(const Vector& g) const;
  /// Steps of differences along a displacement at g, and along a component of the velocity.
  StepRange steps(const Vector& g, const Vector& eta) const;
  StepRange velocity_steps(const Vector& xi, int component) const;
  /// g tau(eta).
  Vector moved(const Vector& g, const Vector& eta) const;
  /// The eta with g tau(eta) = h; 0 where h is out of reach.
  Vector difference(const Vector& g, const Vector& h) const;
  /// a(g, xi). extents: of g, or of a place nearby.
  Vector acceleration(const Vector& g, const Vector& xi, const Vector& extents) const;
  /// By (delta, nu), of formulas: a, phi, A xi - b, one below the other.
  Matrix slopes(const Vector& g, const Vector& xi) const;
  /// I(g) xi.
  Vector momentum(const Vector& g, const Vector& xi) const;
  /// phi(g), and A xi - b.
  Vector holonomic(const Vector& g) const;
  Vector slip(const Vector& g, const Vector& xi) const;
  /// ad_xi as a matrix; Ad_g^-1.
  Matrix ad(const Vector& xi) const;
  Matrix Ad_inverse(const Vector& g) const;

  /// A basis of the symmetries that move something, columns (zeta, eta), found at places beside g
  /// within the reach of the equations there (n displacements, then n velocities). Symmetries that
  /// move nothing, as (zeta, -zeta) of a commutative factor, are left out.
  Matrix symmetries(const Vector& g, const Vector& xi, const Vector& reach) const;
  /// The columns X_s(g, xi) of these symmetries.
  Matrix orbit(const Matrix& symmetries, const Vector& g, const Vector& xi) const;
  /// X_s(g, xi) of one of them.
  Vector carrier(const Vector& generator, const Vector& g, const Vector& xi) const;

 private:
  void find_rates(const Vector& g, const Vector& xi, const Vector& extents, Vector& momentum,
                  Vector& rows) const;
  // Rows of changes divided by the sizes of their blocks of kept().
  void scale_blocks(const Vector& value, const Vector& velocity, Matrix& change) const;
  // The quantities a symmetry keeps, at (g exp(e eta), Ad xi), seen from before the move.
  Vector kept(const Vector& g, const Vector& xi, const Vector& eta, double e) const;
  // Their derivatives by the 2n generators (zeta, eta), by differences and of formulas; back:
  // Ad_g^-1. value: the quantities.
  Matrix changes_by_differences(const Vector& g, const Vector& xi, const Matrix& back,
                                const Vector& speeds) const;
  Matrix changes_of_formulas(const Vector& g, const Vector& xi, const Matrix& back,
                             Vector& value) const;

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> mechanics_;
  std::shared_ptr<const RecordedMotion> recorded_;
  Vector scales_, units_;
};

/// Orthonormal bases of the range and of the kernel. Singular values below `least` of the largest
/// are none; those of a matrix that is all round-off beside `scale` all are.
Matrix range_of(const Matrix& m, double least, double scale = 0);
Matrix kernel_of(const Matrix& m, double least, double scale = 0);

}  // namespace hamel::reduced
