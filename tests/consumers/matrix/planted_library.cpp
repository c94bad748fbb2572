#include <Eigen/Core>

Eigen::VectorXd planted(int n) { return Eigen::VectorXd::Ones(n); }
