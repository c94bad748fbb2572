// The factors of equations of motion whose sizes are known at run time only: of trees, of which
// nothing may fill in, of full matrices, and of rows that end at one link or at any.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/metric/branched_factors.hpp>

namespace hamel {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

struct Samples {
  std::mt19937 engine{1};
  std::normal_distribution<double> normal;
  double number() { return normal(engine); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine); }
  Vector vector(int n) {
    return Vector::NullaryExpr(n, [&] { return number(); });
  }
  /// I of a tree, each link on any before it, or of a chain.
  Matrix inertia(int n, bool chain) {
    Matrix root = Matrix::Zero(n, n);
    std::vector<int> parents(static_cast<size_t>(n), -1);
    for (int i = 0; i < n; ++i) {
      if (i > 0) parents[static_cast<size_t>(i)] = chain ? i - 1 : below(i + 1) - 1;
      root(i, i) = 1 + std::abs(number());
      for (int j = parents[static_cast<size_t>(i)]; j >= 0; j = parents[static_cast<size_t>(j)])
        root(i, j) = 0.5 * number();
    }
    return root.transpose() * root;
  }
  /// Rows with entries at the velocities on which their last one hangs, or at any.
  Matrix rows(int k, const Matrix& inertia, bool along) {
    const auto n = static_cast<int>(inertia.rows());
    Matrix out = Matrix::Zero(k, n);
    for (int i = 0; i < k; ++i) {
      const int last = n - 1 - i;
      for (int j = 0; j <= (along ? last : n - 1); ++j)
        if (!along || inertia(last, j) != 0) out(i, j) = j == last ? 2 : 0.3 * number();
    }
    return out;
  }
};

TEST(BranchedFactors, SolveTheEquationsOfMotion) {
  Samples samples;
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 1 + samples.below(14), k = samples.below(n + 1);
    SCOPED_TRACE(std::to_string(n) + " velocities, " + std::to_string(k) + " rows");
    const Matrix inertia = samples.inertia(n, trial % 4 == 0);
    const Matrix a = samples.rows(k, inertia, trial % 3 != 0);
    const Vector change = samples.vector(n), c = samples.vector(k);
    BranchedFactors factors(n, k);
    ASSERT_TRUE(factors.find_root(inertia));
    factors.find_rows(a);
    Vector work(n), lambda(k), rate(n), reaction(n);
    factors.apply_root(change, work);
    factors.subtract_rows(c, work, lambda);
    factors.solve_gram(lambda);
    factors.add_reaction(lambda, work);
    factors.apply_root_transpose(work, rate);
    Matrix whole = Matrix::Zero(n + k, n + k);
    whole.topLeftCorner(n, n) = inertia;
    whole.topRightCorner(n, k) = -a.transpose();
    whole.bottomLeftCorner(k, n) = a;
    Vector right(n + k);
    right << change, c;
    const Matrix expected = dense::solve_pivoted(whole, right);
    const double near = 1e-13 * whole.norm() * (1 + expected.norm()) *
                        (1 + dense::inverse(whole).norm() * whole.norm());
    EXPECT_LE((rate - expected.topRows(n)).norm(), near);
    EXPECT_LE((lambda - expected.bottomRows(k)).norm(), near);
    factors.find_reaction(lambda, reaction);  // W A^T lambda
    factors.apply_root_transpose(reaction, rate);
    EXPECT_LE((inertia * rate - a.transpose() * lambda).norm(), near);
  }
}

TEST(BranchedFactors, TellWhatIsNotDefinite) {
  BranchedFactors factors(3, 2);
  EXPECT_FALSE(factors.find_root(Matrix(Eigen::Vector3d(1, 0, 2).asDiagonal())));
  Matrix inertia{{2, 1, 0}, {1, 0.5, 0}, {0, 0, 1}};
  EXPECT_FALSE(factors.find_root(inertia));
  inertia(0, 0) = 3;
  EXPECT_TRUE(factors.find_root(inertia));
  factors.find_rows(Matrix{{1, 2, 0}, {2, 4, 0}});  // one implied by the other
  Vector c(2);
  c << 1, 2;
  factors.solve_gram(c);
  EXPECT_FALSE(c.allFinite());
}

}  // namespace
}  // namespace hamel
