// Several contacts with given loads: there is always a solution, the least of the convex problem.
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

// Contacts with given bounds and stops, of a system with `freedoms` degrees of freedom, so that
// rows depend on each other; now and then they repeat those of the contact before, or a bound is 0.
struct GivenLoads {
  Eigen::MatrixXd g;
  Eigen::VectorXd c;
  std::vector<ContactBlock> blocks;

  GivenLoads(Random& random, int contacts, int freedoms, bool stops, double least = -3,
             double most = 2) {
    int n = 0;
    for (int i = 0; i < contacts; ++i) {
      const bool stop = stops && i == 0;
      const double bound = random.uniform(0, 1) < 0.05 ? 0 : std::exp(random.uniform(least, most));
      blocks.push_back({.first = n,
                        .normal = stop,
                        .tangential = stop                         ? 0
                                      : random.uniform(0, 1) < 0.5 ? 1
                                                                   : 2,
                        .bound = stop ? 0 : bound});
      n += blocks.back().size();
    }
    Eigen::MatrixXd w = random.matrix(n, freedoms);
    for (int i = 1; i < n; ++i)
      if (random.uniform(0, 1) < 0.3)
        w.row(i) = (random.uniform(0, 1) < 0.5 ? 1 : -1) * w.row(i - 1);
    w *= std::exp(random.uniform(-3, 3));
    g = w * w.transpose();
    c = w * random.matrix(freedoms, 1) * std::exp(random.uniform(-3, 3));
  }
  double value(const Eigen::VectorXd& p) const { return p.dot(g * p) / 2 + c.dot(p); }
  Eigen::VectorXd within(Eigen::VectorXd p) const {
    for (const ContactBlock& block : blocks) {
      auto of = p.segment(block.first, block.size());
      if (block.normal) of[0] = std::max(of[0], 0.0);
      else if (of.norm() > block.bound) of *= block.bound / of.norm();
    }
    return p;
  }
  // The least value by steps along the gradient, with Nesterov's momentum.
  double least() const {
    const double step = 1 / g.trace();
    Eigen::VectorXd p = Eigen::VectorXd::Zero(c.size()), ahead = p;
    double momentum = 1, best = 0;
    for (int k = 0; k < 4000; ++k) {
      const Eigen::VectorXd next = within(ahead - step * (g * ahead + c));
      if ((ahead - next).dot(next - p) > 0) momentum = 1;
      const double now = (1 + std::sqrt(1 + 4 * momentum * momentum)) / 2;
      ahead = next + (momentum - 1) / now * (next - p);
      momentum = now;
      p = next;
      best = std::min(best, value(p));
    }
    return best;
  }
};

TEST(GivenLoadsOfSeveralContacts, AlwaysHaveASolution) {
  Random random(6);
  ContactProblem problem(12, 5);
  int failed = 0, slides = 0, sticks = 0, singular = 0;
  double worst = 0;
  constexpr int most = 100000;
  for (int k = 0; k < most; ++k) {
    const int contacts = 2 + k % 4, freedoms = 1 + k % 5;
    const bool wide = k % 3 == 0;  // bounds from a thousandth to a thousand times the next
    const GivenLoads of(random, contacts, freedoms, k % 7 == 0, wide ? -6 : -3, wide ? 3 : 2);
    singular += freedoms < of.c.size();
    if (problem.solve(of.g, of.c, of.blocks) != Outcome::one) {
      ++failed;
      continue;
    }
    worst = std::max(worst, contact_residual(of.g, of.c, of.blocks, problem.p()));
    for (const Answer answer : problem.answers()) {
      slides += answer == Answer::slides;
      sticks += answer == Answer::sticks;
    }
  }
  EXPECT_EQ(failed, 0);
  EXPECT_LT(worst, kRoundOff);
  EXPECT_GT(singular, most / 4);
  EXPECT_GT(slides, most / 2);
  EXPECT_GT(sticks, most / 2);
}

// The least value of (6) of convex_contacts.hpp, by a method that shares nothing with it.
TEST(GivenLoadsOfSeveralContacts, AreTheLeastOfTheConvexProblem) {
  Random random(7);
  ContactProblem problem(12, 5);
  for (int k = 0; k < 1000; ++k) {
    const GivenLoads of(random, 2 + k % 4, 1 + k % 5, k % 7 == 0);
    ASSERT_EQ(problem.solve(of.g, of.c, of.blocks), Outcome::one);
    const Eigen::VectorXd p = problem.p();
    const double size = p.cwiseAbs().dot((of.g * p).cwiseAbs()) + p.cwiseAbs().dot(of.c.cwiseAbs());
    EXPECT_LT((of.within(p) - p).norm(), 1e-12 * (1 + p.norm()));
    EXPECT_LE(of.value(p), of.least() + 1e-13 * size) << k;
  }
}

// In any order of contacts the same reactions, though others would leave the same motion.
TEST(GivenLoadsOfSeveralContacts, HaveNoOrder) {
  Random random(8);
  ContactProblem problem(12, 5);
  int spread = 0;
  for (int k = 0; k < 5000; ++k) {
    const GivenLoads of(random, 3 + k % 3, 1 + k % 3, false, -0.5, 0.5);
    GivenLoads turned = of;
    const auto n = static_cast<int>(of.c.size());
    std::vector<int> order;
    std::reverse(turned.blocks.begin(), turned.blocks.end());
    for (ContactBlock& block : turned.blocks) {
      const int first = block.first;
      block.first = static_cast<int>(order.size());
      for (int i = 0; i < block.size(); ++i) order.push_back(first + i);
    }
    turned.g = of.g(order, order);
    turned.c = of.c(order);
    ASSERT_EQ(problem.solve(of.g, of.c, of.blocks), Outcome::one);
    const Eigen::VectorXd p = problem.p()(order);
    ASSERT_EQ(problem.solve(turned.g, turned.c, turned.blocks), Outcome::one);
    const Eigen::VectorXd q = problem.p();
    const double bounds = [&] {
      double out = 0;
      for (const ContactBlock& block : of.blocks) out = std::max(out, block.bound);
      return out;
    }();
    for (int i = 0; i < n; ++i) spread += std::abs(p[i] - q[i]) > 1e-2 * bounds;
  }
  EXPECT_EQ(spread, 0);
}

// Two wheels on one axle, as a skid-steered robot had them at the end of a slip: of the forces
// along the axle only the sum is known, and sweeps ended on the rim of the second one's disk.
TEST(GivenLoadsOfSeveralContacts, TwoWheelsOnOneAxle) {
  Eigen::Matrix4d g;
  g << 4.0949135414327387, -0.056141926790927457, 0.0050864585672580273, -0.056141926790927457,
      -0.056141926790927457, 0.12017740848865932, 0.056141926790927457, 0.12017740848865932,
      0.0050864585672580273, 0.056141926790927457, 4.0949135414327387, 0.056141926790927457,
      -0.056141926790927457, 0.12017740848865932, 0.056141926790927457, 0.12017740848865932;
  const Eigen::Vector4d c(99.370726780273188, -1.0689272978359556, 111.31149726580858,
                          -1.0689272978359556);
  std::vector<ContactBlock> blocks(2);
  for (int i = 0; i < 2; ++i)
    blocks[static_cast<size_t>(i)] = {
        .first = 2 * i, .normal = false, .tangential = 2, .bound = 29.43};
  ContactProblem problem(4, 2);
  ASSERT_EQ(problem.solve(g, c, blocks), Outcome::one);
  EXPECT_LT(contact_residual(g, c, blocks, problem.p()), kRoundOff);
  EXPECT_LT((g * problem.p() + c).norm(), 1e-11);  // both roll
  EXPECT_NEAR(problem.p()[1], problem.p()[3], 1e-2);
}

// A stop of a joint that has dry friction too: their rows are the same, and the stop gives way by
// 1e-9, so that friction slips by that, beside what holds it at its rim.
TEST(GivenLoadsOfSeveralContacts, AStopBesideFriction) {
  Random random(9);
  ContactProblem problem(12, 5);
  int failed = 0, pressed = 0;
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    const int joints = 2 + k % 3;
    const Eigen::MatrixXd w = random.matrix(joints, joints);
    std::vector<int> rows(static_cast<size_t>(joints));
    for (int i = 0; i < joints; ++i) rows[static_cast<size_t>(i)] = i;
    const int stopped = k % joints;
    rows.push_back(stopped);
    const Eigen::MatrixXd all = w * w.transpose();
    Eigen::MatrixXd g = all(rows, rows);
    const Eigen::VectorXd moved = w * random.matrix(joints, 1), c = moved(rows);
    std::vector<ContactBlock> blocks;
    for (int i = 0; i < joints; ++i)
      blocks.push_back(
          {.first = i, .normal = false, .tangential = 1, .bound = std::exp(random.uniform(-9, 0))});
    blocks.push_back({.first = joints, .normal = true, .tangential = 0});
    g(joints, joints) *= 1 + 1e-9;
    if (problem.solve(g, c, blocks) != Outcome::one) {
      ++failed;
      continue;
    }
    worst = std::max(worst, contact_residual(g, c, blocks, problem.p()));
    pressed += problem.p()[joints] > 0;
  }
  EXPECT_EQ(failed, 0);
  EXPECT_LT(worst, kRoundOff);
  EXPECT_GT(pressed, 5000);
}

}  // namespace
