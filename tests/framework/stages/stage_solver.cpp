// The stage solver against closed facts.
#include <numbers>

#include <gtest/gtest.h>

#include "stage_problems.hpp"

namespace {

using Eigen::VectorXd;
using hamel::solve_stages;
using hamel::StageSolution;
using hamel::StageStatus;
using namespace stages_test;

VectorXd vec(std::initializer_list<double> x) {
  VectorXd out(static_cast<Eigen::Index>(x.size()));
  std::copy(x.begin(), x.end(), out.data());
  return out;
}

FormulaProblem<Cart> cart(int count, double mass, double distance) {
  FormulaProblem<Cart> problem({.mass = mass, .time = 0}, count);
  problem.target = vec({distance, 0});
  return problem;
}

// J = 6 M^2 d^2/T^3/(1 - 1/N^2), from the moments of a force that is constant over each step.
TEST(Stages, RestToRestIsTheClosedValueInOneIteration) {
  for (const int count : {2, 5, 40}) {
    const double mass = 1.7, distance = 0.6, until = 2.5;
    auto problem = cart(count, mass, distance);
    const StageSolution out =
        solve_stages(problem, straight_guess(problem, vec({0, 0, until / count})));
    ASSERT_EQ(out.status, StageStatus::ok) << out.reason;
    const double exact =
        6 * mass * mass * distance * distance / std::pow(until, 3) / (1 - 1.0 / (count * count));
    EXPECT_NEAR(out.objective, exact, 1e-10 * exact) << count;
    EXPECT_LE(out.iterations, 3);
    EXPECT_LE(out.defect, 1e-10);
  }
}

// Free time with cost T + J: T^4 = 18 M^2 d^2/(1 - 1/N^2), cost 4T/3, exact for every N.
TEST(Stages, FreeTimeIsTheClosedValue) {
  const int count = 20;
  FormulaProblem<TimedCart> problem({{.mass = 1, .time = 1}}, count);
  problem.target = vec({1, 0});
  problem.free_start = Eigen::MatrixXd::Zero(3, 1);
  problem.free_start(2, 0) = 1;
  const StageSolution out =
      solve_stages(problem, straight_guess(problem, vec({0, 0, 2.0 / count})));
  ASSERT_EQ(out.status, StageStatus::ok) << out.reason;
  const double exact = std::pow(18 / (1 - 1.0 / (count * count)), 0.25);
  EXPECT_NEAR(4 * exact / 3, 2.748075351524, 1e-11);  // of the cost, printed in the design
  EXPECT_NEAR(count * out.point.states[0][2], exact, 1e-9);
  EXPECT_NEAR(out.objective, 4 * exact / 3, 1e-9);
}

// |F| <= b: r^2 = 3 (L^2 - M d/b), L = T/2, J = b^2 (L - 2r/3); order 2 in the step.
TEST(Stages, BoundedForceConvergesToTheClosedValueWithOrderTwo) {
  const double bound = 1.2, half = 1, r = std::sqrt(3 * (half * half - 1 / bound));
  const double exact = bound * bound * (half - 2 * r / 3);
  EXPECT_NEAR(exact, 0.7611774900609, 1e-12);
  double before = 0;
  for (const int count : {40, 80, 160}) {
    auto problem = cart(count, 1, 1);
    problem.bound = bound;
    const StageSolution out =
        solve_stages(problem, straight_guess(problem, vec({0, 0, 2.0 / count})));
    ASSERT_EQ(out.status, StageStatus::ok) << out.reason;
    double most = 0;
    for (int k = 0; k < count; ++k) most = std::max(most, std::abs(out.point.inputs[size_t(k)][0]));
    EXPECT_LE(most, bound);
    EXPECT_GE(most, bound - 1e-8);  // touched
    const double error = out.objective - exact;
    EXPECT_LT(std::abs(error), 3.0 / (count * count));
    if (before != 0) {
      EXPECT_NEAR(std::log2(before / error), 2, 0.4) << count;
    }
    before = error;
  }
}

// J = 2 N tan(pi/N) |z|/T: the loop is a regular polygon.
TEST(Stages, HeisenbergIsTheRegularPolygon) {
  const double until = 2;
  for (const int count : {8, 50}) {
    FormulaProblem<Heisenberg> problem({.h = until / count}, count);
    problem.target = vec({0, 0, 0.7});
    hamel::StagePoint guess = straight_guess(problem, vec({0, 0, 0}));
    for (int k = 0; k < count; ++k)  // never the zero input, where the linearisation is singular
      guess.inputs[size_t(k)] = vec({0.1, 0.05 + 0.01 * k});
    const StageSolution out = solve_stages(problem, guess);
    ASSERT_EQ(out.status, StageStatus::ok) << out.reason;
    EXPECT_NEAR(out.objective, 2 * count * std::tan(std::numbers::pi / count) * 0.7 / until, 1e-9);
    EXPECT_GT(out.sweeps, out.iterations);  // its inertia was corrected
  }
}

// lambda_0 is the derivative of the least cost by the start; lambda_k satisfy the adjoint equation.
TEST(Stages, MultipliersAreTheDiscreteAdjoint) {
  const int count = 25;
  FormulaProblem<Heisenberg> problem({.h = 0.1}, count);
  problem.target = vec({0.3, 0.1, 0.7});
  const auto solve = [&](const VectorXd& start) {
    hamel::StagePoint guess = straight_guess(problem, start);
    for (int k = 0; k < count; ++k) guess.inputs[size_t(k)] = vec({0.1, 0.05 + 0.01 * k});
    return solve_stages(problem, guess, {.tolerance = 1e-13});  // differences multiply it
  };
  const VectorXd start = vec({0.1, -0.2, 0.05});
  const StageSolution out = solve(start);
  ASSERT_EQ(out.status, StageStatus::ok) << out.reason;
  for (int i = 0; i < 3; ++i) {
    const auto difference = [&](double e) {
      VectorXd shifted = start;
      shifted[i] += e;
      const double high = solve(shifted).objective;
      shifted[i] -= 2 * e;
      return (high - solve(shifted).objective) / (2 * e);
    };
    const double slope = (4 * difference(2e-3) - difference(4e-3)) / 3;
    EXPECT_NEAR(out.multipliers[0][i], slope, 1e-8) << i;
  }
  // u_k = -lambda . dS/du/h, from stationarity, with lambda by the adjoint from the end.
  VectorXd lambda = out.goal_multipliers;
  for (int k = count - 1; k >= 0; --k) {
    EXPECT_LT((out.multipliers[size_t(k + 1)] - lambda).norm(), 1e-9);
    const VectorXd& z = out.point.states[size_t(k)];
    const VectorXd& u = out.point.inputs[size_t(k)];
    EXPECT_NEAR(u[0], -(lambda[0] - 0.5 * z[1] * lambda[2]), 1e-9);
    EXPECT_NEAR(u[1], -(lambda[1] + 0.5 * z[0] * lambda[2]), 1e-9);
    lambda =
        vec({lambda[0] + 0.05 * u[1] * lambda[2], lambda[1] - 0.05 * u[0] * lambda[2], lambda[2]});
  }
}

// |u| <= 0.8: from rest to rest over T = 2 the mass reaches b L^2 = 0.8 at most, with the force at
// its bounds; as the goal cannot be met, what is missed is the least.
TEST(Stages, AGoalOutOfReachIsMissedLeast) {
  const int count = 40;
  auto problem = cart(count, 1, 1);
  problem.bound = 0.8;
  const StageSolution out =
      solve_stages(problem, straight_guess(problem, vec({0, 0, 2.0 / count})));
  ASSERT_EQ(out.status, StageStatus::out_of_reach) << out.reason;
  EXPECT_FALSE(out.reason.empty());
  EXPECT_LE(out.defect, 1e-9);  // dynamics hold
  // Least of (q - 1)^2 + v^2 with q = int (T - t) u, v = int u: a switch at t1, by hand.
  double least = 1e9;
  for (double t1 = 0; t1 <= 2; t1 += 1e-5) {
    const double q = 0.8 * (2 * t1 - t1 * t1 / 2) - 0.8 * (2 - t1) * (2 - t1) / 2;
    const double v = 0.8 * (2 * t1 - 2);
    least = std::min(least, (q - 1) * (q - 1) + v * v);
  }
  EXPECT_NEAR(out.missed.norm(), std::sqrt(least), 1e-3);
}

// A cart whose goal has the row of its place twice, at 1 and at another place.
StageSolution solve_with_two_places(double other) {
  struct Twice : FormulaProblem<Cart> {
    using FormulaProblem::FormulaProblem;
    double other = 0;
    int goals() const override { return 3; }
    void goal(const VectorXd& last, VectorXd& value) override {
      value = vec({last[0] - 1, last[0] - other, last[1]});
    }
    void goal_derivatives(const VectorXd&, const VectorXd&, Eigen::MatrixXd& jacobian,
                          Eigen::MatrixXd&) override {
      jacobian(0, 0) = jacobian(1, 0) = jacobian(2, 1) = 1;
    }
  };
  Twice problem({}, 10);
  problem.other = other;
  hamel::StagePoint guess;
  for (int k = 0; k <= 10; ++k) {
    guess.states.push_back(vec({0, 0, 0.2}));
    guess.inputs.push_back(VectorXd::Zero(k < 10 ? 1 : 0));
  }
  return solve_stages(problem, guess);
}

// Two rows at odds with each other cannot be met: the end is in the middle.
TEST(Stages, RowsThatContradictAreOutOfReach) {
  const StageSolution out = solve_with_two_places(2);
  ASSERT_EQ(out.status, StageStatus::out_of_reach) << out.reason;
  EXPECT_NEAR(out.missed[0], 0.5, 1e-4);
  EXPECT_NEAR(out.missed[1], -0.5, 1e-4);
}

// Rows twice: multipliers are not unique, the solution is.
TEST(Stages, GoalRowsMayDependOnEachOther) {
  const StageSolution out = solve_with_two_places(1);
  ASSERT_EQ(out.status, StageStatus::ok) << out.reason;
  EXPECT_NEAR(out.objective, 6.0 / 8 / (1 - 0.01), 1e-9);
}

// Around a disk of radius r from (-1, e) to (1, e): tangents and an arc, length
// 2 sqrt(1 - r^2) + r (pi - 2 acos r) for e = 0, and J = length^2/(2T) as N grows.
TEST(Stages, APathFormulaKeepsAwayFromAnObstacle) {
  const double r = 0.5, until = 2;
  const double arc = std::numbers::pi - 2 * std::acos(r);
  const double exact = std::pow(2 * std::sqrt(1 - r * r) + r * arc, 2) / (2 * until);
  double before = 0;
  for (const int count : {50, 100}) {
    FormulaProblem<Round> problem({.h = until / count, .radius = r}, count);
    problem.target = vec({1, 0});
    hamel::StagePoint guess = straight_guess(problem, vec({-1, 0}));
    for (int k = 0; k < count; ++k)
      guess.states[size_t(k)][1] = 0.3 * std::sin(std::numbers::pi * k / count);
    const StageSolution out = solve_stages(problem, guess);
    ASSERT_EQ(out.status, StageStatus::ok) << out.reason;
    for (int k = 0; k < count; ++k) EXPECT_GE(out.point.states[size_t(k)].norm(), r - 1e-9);
    EXPECT_LT(std::abs(out.objective - exact), 0.02);
    if (before != 0) {
      EXPECT_LT(std::abs(out.objective - exact), 0.7 * before);
    }
    before = std::abs(out.objective - exact);
  }
}

// The obstacle covers the goal.
TEST(Stages, AnObstacleOverTheGoalIsOutOfReach) {
  FormulaProblem<Round> problem({.h = 0.1, .radius = 1.5}, 20);
  problem.target = vec({1, 0});
  hamel::StagePoint guess = straight_guess(problem, vec({-1, 0.1}));
  const StageSolution out = solve_stages(problem, guess);  // its start lies in the obstacle
  EXPECT_EQ(out.status, StageStatus::out_of_reach) << out.reason;
  EXPECT_EQ(out.path_missed_at, 0);
  EXPECT_NEAR(out.path_missed, 2.25 - 1.01, 1e-3);
}

}  // namespace
