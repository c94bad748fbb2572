// The continuous equations: accelerations and reactions at a state.
//
// Lagrange-d'Alembert with multipliers, (M4) of framework/schemes/README.md, d/dt along the motion:
//   I xi' = ad*_xi I xi + force - (dI/dt) xi + A^T lambda
//   A xi' = db/dt - (dA/dt) xi
// dI/dt, dA/dt, db/dt are differences along g tau(e xi), t + e (differences.hpp).
#pragma once

#include <memory>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/place.hpp>

namespace hamel {

class Motion {
 public:
  Motion(std::shared_ptr<const Geometry> geometry, std::shared_ptr<const Mechanics> mechanics);
  /// xi' and lambda (k entries, N or N m as the rows have it) at an admissible (t, g, xi).
  void operator()(double t, const double* g, const Eigen::VectorXd& xi);
  const Eigen::VectorXd& acceleration() const { return acceleration_; }
  const Eigen::VectorXd& reaction() const { return reaction_; }

 private:
  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> system_;
  Place<> place_;
  Eigen::VectorXd acceleration_, reaction_, momentum_, change_, step_, b_, b_rate_, moved_;
  Eigen::MatrixXd a_, a_rate_, inertia_, inertia_rate_;
};

/// xi with tau_s(xi) = delta, (M41), for an erased group (recover_step.hpp); false where there is none.
bool recover_step(const Geometry& geometry, const double* delta, double s, Eigen::VectorXd& xi);

}  // namespace hamel
