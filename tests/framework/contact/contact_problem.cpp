// The contact problem: every solution satisfies its law (1) to round-off, and there are as many as
// an enumeration of all directions finds.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <hamel/framework/contact/contact_problem.hpp>

#include "random_contacts.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;
using Answer = ContactAnswer;
using Outcome = ContactProblem::Outcome;

// Solutions by enumeration: open, sticking by Cramer's rule, and the changes of sign over a fine
// grid of directions. Empty where a solution is too near to another, or to a limit, to be counted.
int enumerate(const Eigen::MatrixXd& g, const Eigen::VectorXd& c, double mu, bool& near) {
  constexpr double close = 1e-6;
  const auto d = static_cast<int>(c.size()) - 1;
  near = std::abs(c[0]) < close;
  int out = c[0] >= 0 ? 1 : 0;
  if (std::abs(g.determinant()) > 1e-12) {
    const Eigen::VectorXd p = -g.inverse() * c;
    const double room = mu * p[0] - p.tail(d).norm();
    near = near || std::abs(room) < close || std::abs(p[0]) < close;
    if (p[0] > 0 && room >= 0) ++out;
  }
  const auto left_along = [&](const Eigen::VectorXd& way, double& across) {
    const double held = g(0, 0) - mu * g.row(0).tail(d).dot(way), pn = -c[0] / held;
    Eigen::VectorXd p(d + 1);
    p << pn, -mu * pn * way;
    const Eigen::VectorXd left = (g * p + c).tail(d);
    near = near || std::abs(held) < close;
    across = d == 2 ? held * (way[0] * left[1] - way[1] * left[0]) : 0;
    return pn > 0 ? left.dot(way) : -1;
  };
  double across = 0;
  if (d == 1) {
    for (const double sign : {1.0, -1.0}) {
      const double left = left_along(Eigen::VectorXd::Constant(1, sign), across);
      near = near || std::abs(left) < close;
      if (left > 0) ++out;
    }
    return out;
  }
  constexpr int steps = 4096;
  double before = 0, slope = 0;
  for (int i = 0; i <= steps; ++i) {
    const double angle = 2 * M_PI * (i + 0.31) / steps;
    const double left = left_along(Eigen::Vector2d(std::cos(angle), std::sin(angle)), across);
    // Two roots next to each other lie between two points of the grid.
    if (i > 0 && before * across > 0 && std::abs(across) < 1e-4) near = true;
    if (i > 0 && before * across < 0) {
      slope = std::abs(across - before);
      near = near || slope < 1e-5 || std::abs(left) < 1e-2;
      if (left > 0) ++out;
    }
    before = across;
  }
  return out;
}

enum class Kind { definite, unsymmetric, singular };

Eigen::MatrixXd random_matrix(Random& random, int n, Kind kind) {
  if (kind == Kind::definite) return random.definite(n);
  if (kind == Kind::unsymmetric) return random.definite(n) + 0.5 * random.matrix(n, n);
  const Eigen::MatrixXd b = random.matrix(n, n - 1);
  return b * b.transpose();
}

TEST(ContactProblem, EverySolutionOfOneContactSatisfiesTheLaw) {
  Random random(1);
  ContactSolutions all;
  double worst = 0;
  long counted = 0;
  for (int k = 0; k < 1000000; ++k) {
    const int d = 1 + k % 2, n = d + 1;
    const Eigen::MatrixXd g = random_matrix(random, n, static_cast<Kind>(k % 3));
    const Eigen::VectorXd c = random.matrix(n, 1);
    Eigen::Matrix3d g3 = Eigen::Matrix3d::Zero();
    Eigen::Vector3d c3 = Eigen::Vector3d::Zero();
    g3.topLeftCorner(n, n) = g;
    c3.head(n) = c;
    const ContactBlock block = block_of(d, std::exp(random.uniform(-2.5, 2)));
    solve_contact(g3, c3, block, all);
    for (int i = 0; i < all.count(); ++i) {
      worst = std::max(worst, contact_residual(g, c, {block}, all[i].p.head(n)));
      ++counted;
    }
  }
  EXPECT_GT(counted, 700000);
  EXPECT_LT(worst, kRoundOff);
}

TEST(ContactProblem, AllSolutionsAreCounted) {
  Random random(2);
  ContactSolutions all;
  int compared = 0, wrong = 0, several = 0, none = 0;
  for (int k = 0; k < 3000; ++k) {
    const int d = 1 + k % 2, n = d + 1;
    const Eigen::MatrixXd g = random_matrix(random, n, static_cast<Kind>(k % 3));
    const Eigen::VectorXd c = random.matrix(n, 1);
    const double mu = std::exp(random.uniform(-2.5, 1.5));
    bool near = false;
    const int expected = enumerate(g, c, mu, near);
    if (near) continue;
    ++compared;
    Eigen::Matrix3d g3 = Eigen::Matrix3d::Zero();
    Eigen::Vector3d c3 = Eigen::Vector3d::Zero();
    g3.topLeftCorner(n, n) = g;
    c3.head(n) = c;
    solve_contact(g3, c3, block_of(d, mu), all);
    if (all.count() != expected) ++wrong;
    several += expected > 1;
    none += expected == 0;
  }
  EXPECT_GT(compared, 2000);
  EXPECT_GT(several, 50);
  EXPECT_GT(none, 5);
  EXPECT_EQ(wrong, 0);
}

// With a symmetric G there are 1 or 3 solutions; with friction in the column of the normal
// reaction, one unknown, there are 0, 1 or 2.
TEST(ContactProblem, NumbersOfSolutions) {
  Random random(3);
  ContactSolutions all;
  for (int k = 0; k < 20000; ++k) {
    const Eigen::Matrix3d g = random.definite(3);
    const Eigen::Vector3d c = random.matrix(3, 1);
    solve_contact(g, c, block_of(2, std::exp(random.uniform(-2, 1.5))), all);
    EXPECT_TRUE(all.count() == 1 || all.count() == 3) << all.count();
  }
  const ContactBlock slides = {.first = 0, .normal = true, .tangential = 0};
  const auto count = [&](double g, double c) {
    Eigen::Matrix3d g3 = Eigen::Matrix3d::Zero();
    g3(0, 0) = g;
    solve_contact(g3, Eigen::Vector3d(c, 0, 0), slides, all);
    return all.count();
  };
  EXPECT_EQ(count(1, -1), 1);
  EXPECT_EQ(count(1, 1), 1);
  EXPECT_EQ(count(-1, 1), 2);
  EXPECT_EQ(count(-1, -1), 0);
}

TEST(ContactProblem, AGivenBoundInPlaceOfANormalReaction) {
  Random random(4);
  ContactSolutions all;
  for (int k = 0; k < 5000; ++k) {
    const int d = 1 + k % 2;
    const ContactBlock block = {
        .first = 0, .normal = false, .tangential = d, .bound = std::exp(random.uniform(-2, 1))};
    const Eigen::MatrixXd g = random.definite(d);
    const Eigen::VectorXd c = random.matrix(d, 1);
    Eigen::Matrix3d g3 = Eigen::Matrix3d::Zero();
    Eigen::Vector3d c3 = Eigen::Vector3d::Zero();
    g3.topLeftCorner(d, d) = g;
    c3.head(d) = c;
    solve_contact(g3, c3, block, all);
    ASSERT_EQ(all.count(), 1);  // a convex problem
    EXPECT_LT(contact_residual(g, c, {block}, all[0].p.head(d)), kRoundOff);
    const double free = (g.inverse() * c).norm();
    EXPECT_EQ(all[0].answer == Answer::sticks, free <= block.bound);
  }
}

// Sweeps and active sets together, of contacts that are coupled, from 6 unknowns on with rows that
// repeat each other's.
TEST(ContactProblem, SeveralContacts) {
  Random random(5);
  ContactProblem problem(12, 4);
  int solved = 0, slides = 0;
  constexpr int most = 400;
  for (int k = 0; k < most; ++k) {
    const int d = 1 + k % 2, contacts = 2 + k % 3, n = contacts * (d + 1);
    const Eigen::MatrixXd b = random.matrix(n, 6), g = b * b.transpose() / 6;
    const Eigen::VectorXd c = b * random.matrix(6, 1);  // what a motion can have
    std::vector<ContactBlock> blocks;
    for (int i = 0; i < contacts; ++i) {
      blocks.push_back(block_of(d, 0.3));
      blocks.back().first = i * (d + 1);
    }
    if (problem.solve(g, c, blocks) != Outcome::one) continue;
    ++solved;
    EXPECT_LT(contact_residual(g, c, blocks, problem.p()), kRoundOff);
    for (const Answer answer : problem.answers()) slides += answer == Answer::slides;
  }
  EXPECT_EQ(solved, most);
  EXPECT_GT(slides, most / 4);
}

// A ball thrown on a plane: P_n stops the fall, and P_t the slip where it is in the cone.
// G = diag(1/m, 7/(2m), 7/(2m)) of a homogeneous ball.
TEST(ContactProblem, ABallStrikesAPlane) {
  ContactSolutions all;
  const Eigen::Matrix3d g = Eigen::Vector3d(1, 3.5, 3.5).asDiagonal();
  solve_contact(g, {-2, 0.7, 0}, block_of(2, 0.2), all);
  ASSERT_EQ(all.count(), 1);
  EXPECT_EQ(all[0].answer, Answer::sticks);
  EXPECT_NEAR(all[0].p[1], -0.2, 1e-15);
  solve_contact(g, {-2, 3, 4}, block_of(2, 0.2), all);
  ASSERT_EQ(all.count(), 1);
  EXPECT_EQ(all[0].answer, Answer::slides);
  EXPECT_NEAR(all[0].p[0], 2, 1e-15);
  EXPECT_NEAR(all[0].p[1], -0.24, 1e-15);
  EXPECT_NEAR(all[0].p[2], -0.32, 1e-15);
}

}  // namespace
