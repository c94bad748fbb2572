// The velocity of a mechanism at its start, from the velocities that are given and the rows.
//
// Of all xi with A xi = b and the given numbers the one that moves as little as possible, decided
// in this order, each by least squares among what those before leave free:
//   1. rates of joints that carry no contact and no end of a loop: arms, pendulums;
//   2. rates of the other joints but the axles of wheels: steering axes, hitches;
//   3. angular velocities of the roots: planar and free joints;
//   4. the kinetic energy.
// So a joint moves unasked only where the rows require it. Velocities are measured in units of
// 1/sqrt(I_ii), of the kinetic energy that each has alone: no result depends on units. Not
// installed.
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

#include <hamel/systems/mechanisms/multibody.hpp>

namespace hamel::mechanisms {

class StartVelocity {
 public:
  /// At an element.
  StartVelocity(const Multibody& system, const std::vector<double>& g);

  /// some: one velocity with a some = b; the one described above.
  Eigen::VectorXd operator()(const Eigen::MatrixXd& a, const Eigen::VectorXd& some) const;

  /// Velocities of the joints of 1 and 2, and of 3.
  const std::vector<int>& of_joints() const { return joints_; }
  const std::vector<int>& of_turning_roots() const { return turning_; }
  /// The size of a velocity, by the square root of the energy that it has alone.
  double size(int velocity, double rate) const { return std::abs(rate) / units_[velocity]; }

 private:
  Eigen::MatrixXd inertia_;
  Eigen::VectorXd units_;
  std::vector<int> limbs_, joints_, turning_;
};

}  // namespace hamel::mechanisms
