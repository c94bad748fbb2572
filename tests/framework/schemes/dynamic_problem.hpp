// A left-invariant system on the erased problem, for comparison with the kernels compiled for it.
#pragma once

#include <hamel/framework/mechanics/system.hpp>

namespace hamel::test {

/// Left-invariant, but it does not say so.
class Unsaid final : public LeftInvariantMechanics {
 public:
  using LeftInvariantMechanics::LeftInvariantMechanics;
  bool left_invariant() const override { return false; }
};

inline Eigen::MatrixXd inertia_of(const Mechanics& mechanics) {
  Eigen::MatrixXd inertia(mechanics.dim(), mechanics.dim());
  mechanics.inertia(nullptr, inertia);
  return inertia;
}
inline Eigen::MatrixXd rows_of(const Mechanics& mechanics) {
  Eigen::MatrixXd rows(mechanics.constraint_count(), mechanics.dim());
  Eigen::VectorXd none(mechanics.constraint_count());
  mechanics.constraints(0, nullptr, rows, none);
  return rows;
}
inline SystemModel erased(SystemModel model) {
  model.mechanics =
      std::make_shared<Unsaid>(inertia_of(*model.mechanics), rows_of(*model.mechanics));
  return model;
}

}  // namespace hamel::test
