// Linear-quadratic problem over stages, by one Riccati sweep.
//
//   least sum_k (1/2 [dz; du]^T H [dz; du] + g . [dz; du]),  dz_{k+1} = F dz_k + B du_k + d,
//   dz_0 = J w, w free
//
// Value of the rest from stage k on: 1/2 dz^T P dz + p . dz. The last stage has H and g alone; the
// goal is in them. Source: Bertsekas, Dynamic Programming and Optimal Control I, 4.1.
#pragma once

#include <vector>

#include <Eigen/Core>

namespace hamel {

struct LinearStage {
  // Given.
  Eigen::MatrixXd F, B, H;
  Eigen::VectorXd d, g;
  // Found by sweep(): du = K dz + k, and the value.
  Eigen::MatrixXd K, P;
  Eigen::VectorXd k, p;
  // Found by roll(): the solution.
  Eigen::VectorXd dz, du;

  // Work.
  Eigen::MatrixXd FB, PF, M;
  Eigen::VectorXd q, m;
  void resize(int state, int inputs, int next);
};

class LinearStages {
 public:
  std::vector<LinearStage> stages;  // N + 1
  Eigen::MatrixXd start;            // J

  /// Backwards with H + delta I. False where the problem has no least value: a Hessian of inputs,
  /// or of w, is not positive.
  bool sweep(double delta);
  /// Forwards: dz and du of all stages.
  void roll();
  /// lambda_k = P dz + p.
  void multiplier(int k, Eigen::VectorXd& out) const;
  /// Hessian of the least value by w.
  Eigen::MatrixXd start_information() const;

 private:
  static bool eliminate(LinearStage& stage, const LinearStage& next, double delta);
  Eigen::VectorXd w_;
};

}  // namespace hamel
