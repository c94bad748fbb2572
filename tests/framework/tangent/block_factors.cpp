// Factors by blocks against the dense ones of Eigen.
#include <hamel/framework/tangent/block_factors.hpp>

#include <gtest/gtest.h>

#include <random>

#include <Eigen/Core>
#include <Eigen/LU>

namespace hamel {
namespace {

/// M^-1 and M^-T times one and several right sides, with pivots that are zero at first.
TEST(BlockFactors, SolveAsDenseFactorsDo) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto draw = [&](Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd out(rows, columns);
    for (double& x : out.reshaped()) x = normal(random);
    return out;
  };
  for (const auto& [size, count] : {std::pair{1, 1}, {4, 2}, {5, 3}, {7, 1}}) {
    SCOPED_TRACE(testing::Message() << count << " blocks of " << size);
    const Eigen::Index n = size * count;
    Eigen::MatrixXd M = draw(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = (i / size + 1) * size; j < n; ++j) M(i, j) = 0;
    if (size > 1) M(0, 0) = 0;
    const Eigen::PartialPivLU<Eigen::MatrixXd> dense(M);
    BlockFactors blocks;
    blocks.compute(M, size);
    const Eigen::VectorXd b = draw(n, 1);
    Eigen::VectorXd x = b;
    blocks.solve(x);
    EXPECT_LT((x - dense.solve(b)).norm(), 1e-11 * x.norm());  // round-off times a condition of 1e4
    x = b;
    blocks.solve_transposed(x);
    EXPECT_LT((M.transpose() * x - b).norm(), 1e-11 * (1 + x.norm()));
    const Eigen::MatrixXd right = draw(n, 3);
    Eigen::MatrixXd rows = right.transpose();
    blocks.solve_rows(rows);
    EXPECT_LT((M * rows.transpose() - right).norm(), 1e-11 * (1 + rows.norm()));
  }
}

TEST(BlockFactors, OfASingularBlockHaveNoSolution) {
  BlockFactors blocks;
  blocks.compute(Eigen::MatrixXd::Zero(2, 2), 2);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(2);
  blocks.solve(x);
  EXPECT_FALSE(x.allFinite());
}

}  // namespace
}  // namespace hamel
