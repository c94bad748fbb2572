// Eigen at work, memory and large products included, in a unit without hamel.
#include <cmath>

#include <Eigen/Dense>

double second_unit(int n) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(n, n) + n * Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd product = a * a.inverse();
  const Eigen::Matrix4d small = Eigen::Matrix4d::Identity() * 2;
  product.conservativeResize(n + 1, n + 1);
  product.row(n).setZero();
  product.col(n).setZero();
  return std::round(product.trace() + (small * small.inverse()).trace() - 4);
}
