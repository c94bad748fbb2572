// The factor by which contacts whose rows repeat each other's can hold, against its dual.
#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/SVD>

#include <hamel/framework/contact/limit_load.hpp>

#include "random_contacts.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;

struct Contacts {
  std::vector<int> sizes, firsts;
  Eigen::VectorXd u;
  Eigen::MatrixXd v;

  Contacts(Random& random, int contacts, int unknowns) {
    int rows = 0;
    for (int i = 0; i < contacts; ++i) {
      firsts.push_back(rows);
      sizes.push_back(random.uniform(0, 1) < 0.4 ? 1 : 2);
      rows += sizes.back();
    }
    u = random.matrix(rows, 1) * std::exp(random.uniform(-6, 6));
    v = random.matrix(rows, unknowns);
    for (int j = 0; j < unknowns; ++j) v.col(j) *= std::exp(random.uniform(-6, 6));
  }
  double largest(const Eigen::VectorXd& w) const {
    double out = 0;
    for (size_t i = 0; i < sizes.size(); ++i)
      out = std::max(out, w.segment(firsts[i], sizes[i]).norm());
    return out;
  }
  void solve(LimitLoad& load) const {
    load.begin(static_cast<int>(v.cols()));
    for (size_t i = 0; i < sizes.size(); ++i) load.add(static_cast<int>(i), sizes[i]);
    for (int i = 0; i < u.size(); ++i) {
      load.u(i) = u[i];
      for (int j = 0; j < v.cols(); ++j) load.v(i, j) = v(i, j);
    }
    load.solve();
  }
};

// No other c has a smaller one: steps from it along random directions, and y^T u of multipliers
// with y^T V = 0 and sum |y_i| = 1, which are below every value.
TEST(LimitLoad, IsTheLeastOfTheLargest) {
  Random random(11);
  LimitLoad load(12, 6);
  int several = 0;
  for (int k = 0; k < 3000; ++k) {
    SCOPED_TRACE(k);
    const int contacts = 2 + k % 5;
    const Contacts of(random, contacts, 1 + k % 3);
    if (of.v.cols() >= of.v.rows()) continue;
    of.solve(load);
    const double rho = load.factor(), size = of.largest(of.u);
    ASSERT_LE(rho, size * (1 + 1e-11));
    // At the factor itself: u/rho lies on the limit, and those that yield hold no more.
    Contacts at = of;
    at.u /= rho;
    at.solve(load);
    EXPECT_NEAR(load.factor(), 1, 1e-10 * std::max(1.0, size / rho));
    Eigen::VectorXd w(of.u.size()), y = Eigen::VectorXd::Zero(of.u.size());
    int yielding = 0;
    for (int i = 0; i < contacts; ++i) {
      const auto n = static_cast<size_t>(i);
      w.segment(of.firsts[n], of.sizes[n]) = load.reaction(i).head(of.sizes[n]);
      if (!load.yields(i)) continue;
      ++yielding;
      EXPECT_NEAR(load.reaction(i).norm(), 1, 1e-6);
    }
    ASSERT_GE(yielding, 1);
    several += yielding > 1;
    // Slips k_i along the reactions of those that yield that are a motion: y^T V = 0.
    Eigen::MatrixXd motions(of.v.cols(), yielding);
    int column = 0;
    for (int i = 0; i < contacts; ++i) {
      const auto n = static_cast<size_t>(i);
      if (!load.yields(i)) continue;
      motions.col(column++) = of.v.middleRows(of.firsts[n], of.sizes[n]).transpose() *
                              w.segment(of.firsts[n], of.sizes[n]);
    }
    for (int j = 0; j < motions.rows(); ++j) motions.row(j) /= of.v.col(j).norm();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(motions, Eigen::ComputeFullV);
    const Eigen::VectorXd slips = svd.matrixV().col(yielding - 1);
    EXPECT_LT((motions * slips).norm(), 1e-5);
    EXPECT_GT(slips.minCoeff() * slips.maxCoeff(), -1e-6) << slips.transpose();  // of one sign
  }
  EXPECT_GT(several, 1000);
}

// Two wheels on an axle with a push across and a torque at the first: u = ((a, 1), (0, 1)), what
// the one does not hold across the other may. At a = 0.8, the sum across 1.6, the first holds 0.6
// of it.
TEST(LimitLoad, OfAnAxle) {
  LimitLoad load(4, 2);
  const auto solve = [&](double ahead, double across) {
    load.begin(1);
    load.add(0, 2);
    load.add(1, 2);
    for (const auto& [row, u, v] :
         {std::tuple(0, ahead, 0.), {1, across / 2, 1.}, {2, 0., 0.}, {3, across / 2, -1.}}) {
      load.u(row) = u;
      load.v(row, 0) = v;
    }
    load.solve();
  };
  solve(0.8, 1.6);
  EXPECT_NEAR(load.factor(), 1, 1e-12);
  EXPECT_TRUE(load.yields(0));
  EXPECT_TRUE(load.yields(1));
  EXPECT_NEAR(load.reaction(0)[1], 0.6, 1e-6);
  EXPECT_NEAR(load.reaction(1)[1], 1, 1e-6);
  solve(0.8, 1.4);  // half of it each is too much of the first, which holds 0.6
  EXPECT_LT(load.factor(), 0.95);
  EXPECT_FALSE(load.yields(0));
  EXPECT_NEAR(load.reaction(0)[1], 0.6, 1e-12);
  EXPECT_NEAR(load.reaction(1)[1], 0.8, 1e-12);
  solve(0.3, 1.0);  // as it is shared
  EXPECT_EQ(load.reaction(0)[1], 0.5);
}

}  // namespace
