// Rows c >= 0 of one stage in an interior point method: slacks s > 0 with c = s, multipliers y > 0
// with s y = mu.
//
// Elastic rows, weight w: c = s - e with the cost w/2 e^2, hence y = w e. Newton's step of
//   c + J dx - s - ds + (y + dy)/w = 0,  s y + s dy + y ds = mu
// without s and y is  dy = D (mu/y - c - y/w - J dx),  D = 1/(s/y + 1/w),  which adds
//   J^T D J  to the Hessian and  -J^T (y + D (mu/y - c - y/w))  to the gradient
// of a stage. Source: Waechter and Biegler, Math. Program. 106 (2006), section 2.
#pragma once

#include <Eigen/Core>

namespace hamel {

class InteriorRows {
 public:
  /// s = max(c, least), y = mu/s.
  void start(const Eigen::VectorXd& c, double least, double mu);
  void resize(int rows);

  /// Adds to the upper left of H and the head of g, of J's columns.
  void condense(const Eigen::VectorXd& c, const Eigen::MatrixXd& J, double mu, double softness,
                Eigen::MatrixXd& H, Eigen::VectorXd& g);
  /// ds and dy of a step dx.
  void step(const Eigen::VectorXd& c, const Eigen::MatrixXd& J, const Eigen::VectorXd& dx,
            double mu, double softness);
  /// Largest factors <= 1 of ds and dy that keep 1/200 of s and y.
  double longest_primal() const { return longest(s, ds); }
  double longest_dual() const { return longest(y, dy); }
  void move(double primal, double dual, double mu);

  /// max |s y - mu|.
  double complement(double mu) const;

  Eigen::VectorXd s, y, ds, dy;

 private:
  static double longest(const Eigen::VectorXd& x, const Eigen::VectorXd& dx);
  Eigen::VectorXd weight_, pull_;
  Eigen::MatrixXd weighted_;
};

}  // namespace hamel
