// The method of Levenberg and Marquardt for residuals with equations. Not installed.
//
//   least  |r(p)|^2/2  subject  c(p) = 0
// Linearised in scaled increments x, with Z an orthonormal basis of ker C by QR of C^T:
//   x = x_p + Z y,  x_p = -C^+ c,  least  |r + J x_p + J Z y|^2 + damping |y|^2
// so that nothing squares the growth along a chain of equations, as the normal equations of a
// Riccati sweep would. Merit: |r|^2/2 + penalty |c|_1. Without equations Z is the identity.
// Sources: More, The Levenberg-Marquardt algorithm (1978); Nocedal and Wright, Numerical
// Optimization, 15.3, 18.5.
#pragma once

#include <functional>

#include <Eigen/Core>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace hamel {

/// Residuals and equations at a point, and their derivatives by increments.
struct FitLinear {
  Eigen::VectorXd r, c;
  Eigen::MatrixXd J, C;
  Eigen::VectorXd sizes;  // of increments: what columns of different units are compared by
};

/// Columns that are scaled so that J has columns of length 1, as far as they have a length.
Eigen::VectorXd scales_of_columns(const FitLinear& at);

/// The linear problem of one iteration.
class FitStep {
 public:
  FitStep(const FitLinear& at, const Eigen::VectorXd& scales);
  /// An increment, and |r + J x|^2/2 there.
  double solve(double damping, Eigen::VectorXd& x) const;
  /// Largest multiplier of the equations, as they are scaled.
  double largest_multiplier(const Eigen::VectorXd& x) const;
  /// |c|_1, rows scaled.
  double infeasible(const Eigen::VectorXd& c) const;
  /// The same in the largest norm: what closes the gaps moves residuals by about so much.
  double largest_gap(const Eigen::VectorXd& c) const;
  double largest_singular() const { return singular_.size() == 0 ? 0 : singular_[0]; }
  /// Singular values of J Z, and their increments (columns), not scaled.
  const Eigen::VectorXd& singular() const { return singular_; }
  Eigen::MatrixXd directions() const;

 private:
  const FitLinear& at_;
  Eigen::VectorXd scales_, rows_, singular_, particular_, pulled_;
  Eigen::MatrixXd scaled_, null_, directions_;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors_;
};

/// What is fitted: a point with its residuals.
class FitDescent {
 public:
  virtual ~FitDescent() = default;
  /// At the point so far.
  virtual bool linearise(FitLinear& out) = 0;
  /// At the point moved by an increment: residuals and equations alone.
  virtual bool try_increment(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::VectorXd& c) = 0;
  /// The point tried last is the point.
  virtual void accept() = 0;
  virtual bool stopped() const { return false; }
  /// The numbers that are fitted, the first of an increment; their size decides what is round-off.
  virtual Eigen::VectorXd numbers() const { return Eigen::VectorXd(); }
  /// |data / sigma|: residuals are nothing beside it; of use where there are equations.
  virtual double size_of_data() const { return 0; }

  enum class End { converged, too_many, no_derivative, no_descent, stopped };
  End descend(int iterations);
  long iterations() const { return iterations_; }

 protected:
  long iterations_ = 0;

 private:
  bool is_small(const FitLinear& at, const Eigen::VectorXd& x) const;
  bool takes(double actual, double fall);
  bool search(const FitStep& step, const FitLinear& at, bool& settled);
  double damping_ = 1e-6, penalty_ = 0;
};

}  // namespace hamel
