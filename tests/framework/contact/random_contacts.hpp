// Random matrices and contacts for the tests of the contact problem.
#pragma once

#include <random>

#include <Eigen/Core>

#include <hamel/framework/contact/contact_problem.hpp>

namespace hamel::test {

// Round-off of a 3 x 3 system with random entries.
inline constexpr double kRoundOff = 1e-13;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double normal() { return normal_(engine_); }
  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine_);
  }
  Eigen::MatrixXd matrix(int rows, int columns) {
    Eigen::MatrixXd out(rows, columns);
    for (double& x : out.reshaped()) x = normal();
    return out;
  }
  Eigen::MatrixXd definite(int n) {
    const Eigen::MatrixXd b = matrix(n, n + 1);
    return b * b.transpose();
  }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

inline ContactBlock block_of(int tangential, double mu) {
  return {.first = 0, .normal = true, .tangential = tangential, .friction = mu};
}

}  // namespace hamel::test
