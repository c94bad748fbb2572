// Elimination of equations that depend on each other: rank, a solution, null vectors.
#include <cstdlib>

#include <gtest/gtest.h>
#include <Eigen/Core>

#include <hamel/framework/contact/pivots.hpp>

namespace {

using Eigen::MatrixXd;

TEST(Pivots, RankSolutionAndNullVectors) {
  std::srand(7);
  hamel::Pivots pivots(9);
  for (int m = 1; m <= 9; ++m)
    for (int rank = 0; rank <= m; ++rank)
      for (const double units : {1e-9, 1.0, 1e9}) {
        const MatrixXd k = units * (MatrixXd::Random(m, rank) * MatrixXd::Random(rank, m));
        MatrixXd u = k;
        const MatrixXd b = k * MatrixXd::Random(m, 2);
        MatrixXd x = b;
        ASSERT_EQ(pivots.eliminate(u, x), rank) << m;
        EXPECT_LT((k * x - b).lpNorm<Eigen::Infinity>(), 1e-9 * units);
        MatrixXd null = MatrixXd::Zero(m, m);
        pivots.find_null(u, rank, null);
        const auto z = null.leftCols(m - rank);
        for (int c = 0; c < m - rank; ++c) {
          EXPECT_EQ(z(pivots.of(rank + c), c), 1);  // so they are independent
          EXPECT_EQ(x(pivots.of(rank + c), 0), 0);
          EXPECT_LT((k * z.col(c)).lpNorm<Eigen::Infinity>(),
                    1e-9 * units * z.col(c).lpNorm<Eigen::Infinity>());
        }
      }
}

}  // namespace
