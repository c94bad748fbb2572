// An input that jumps or bends between the nodes of steps of one size: the steps go there and on,
// so that every scheme keeps its order, and a step that is constant in the torque is exact.
//
// The cart of differential_drive under equal torques u on both wheels: M v' = 2 u / R (inputs.cpp).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

using testing::HasSubstr;
constexpr double kGain = 2 / 0.1 / (5.0 + 2 * 0.01 / 0.01);
constexpr double kSeen = 1e-12;

Simulation cart(const InputSignal& torque, double h) {
  return simulate("differential_drive")
      .start({.velocity = {0, 0.5, 0, 5, 5}})
      .input("right_torque", torque)
      .input("left_torque", torque)
      .step(h)
      .until(1);
}

const InputTable kHeld = {{0, 0.37, 0.635, 1}, {0.2, -0.1, 0.3, 0.3}, true};
constexpr double kImpulse = 0.37 * 0.2 - 0.265 * 0.1 + 0.365 * 0.3;

struct Method {
  const char *scheme, *compose;
};
constexpr Method kMethods[] = {{"lift", "none"},  {"lift", "suzuki4"}, {"balance", "none"},
                               {"gni", "none"},   {"rkmk4", "none"},   {"rk4_projected", "none"},
                               {"tsit5", "none"}, {"dop853", "none"},  {"reversible", "none"}};

TEST(InputJumps, AreNodesOfStepsOfOneSize) {
  for (const Method& method : kMethods) {
    SCOPED_TRACE(std::string(method.scheme) + ", " + method.compose);
    const Result r = cart(kHeld, 0.1).scheme(method.scheme).compose(method.compose).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    EXPECT_NEAR(r.last.velocity[1], 0.5 + kGain * kImpulse, kSeen);
    EXPECT_EQ(r.last.time, 1);
    EXPECT_EQ(r.steps, 12);
    EXPECT_LT(r.energy_balance_error_max, 1e-3);
    const std::vector<double> t = r.trajectory.column("t");
    for (const double jump : {0.37, 0.635})
      EXPECT_NE(std::find(t.begin(), t.end(), jump), t.end()) << jump;
    EXPECT_NE(std::find(t.begin(), t.end(), 0.7 > 7 * 0.1 ? 0.7 : 7 * 0.1), t.end());
  }
}

/// A jump at a node of the grid: the step before takes the force of its side, the step behind the
/// force of the other, also where a scheme remembers the force of the node.
TEST(InputJumps, AtANodeHaveTwoSides) {
  const InputTable held = {{0, 0.25, 0.5, 1}, {0.2, -0.1, 0.3, 0.3}, true};
  const double impulse = 0.25 * 0.2 - 0.25 * 0.1 + 0.5 * 0.3;
  for (const Method& method : kMethods) {
    const Result r = cart(held, 0.125).scheme(method.scheme).compose(method.compose).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    EXPECT_NEAR(r.last.velocity[1], 0.5 + kGain * impulse, kSeen)
        << method.scheme << ", " << method.compose;
    EXPECT_EQ(r.steps, 8);
  }
}

/// Next to a node the jump replaces it; the end of the run stays.
TEST(InputJumps, NextToANodeStandForIt) {
  const InputTable held = {{0, 0.30001, 0.69999, 0.99999, 1}, {0.2, -0.1, 0.3, 0.1, 0.1}, true};
  const double impulse = 0.30001 * 0.2 - 0.39998 * 0.1 + 0.3 * 0.3 + 0.00001 * 0.1;
  const Result r = cart(held, 0.1).scheme("lift").run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_NEAR(r.last.velocity[1], 0.5 + kGain * impulse, 1e-11);
  EXPECT_EQ(r.last.time, 1);
  EXPECT_EQ(r.steps, 11);
  EXPECT_LT(r.constraint_max, 1e-9);
}

/// Backwards, by hand, and after a piece of a file: the same nodes.
TEST(InputJumps, AreNodesHoweverARunIsTaken) {
  const Result there = cart(kHeld, 0.1).scheme("lift").run();
  const Result back =
      cart(kHeld, -0.1)
          .start({.configuration = there.last.coordinates, .velocity = there.last.velocity})
          .from(1)
          .until(0)
          .scheme("lift")
          .run();
  ASSERT_TRUE(back.status.ok) << back.status.reason;
  EXPECT_NEAR(back.last.velocity[1], 0.5, kSeen);
  EXPECT_NEAR(back.last.time, 0, 1e-15);
  hamel::Run run = cart(kHeld, 0.1).scheme("lift").build();
  ASSERT_TRUE(run.step(4).ok);
  EXPECT_NEAR(run.state().time, 0.4, 1e-15);
  ASSERT_TRUE(run.advance_to(1).ok);
  EXPECT_NEAR(run.state().time, 1, 1e-15);
  EXPECT_NEAR(run.state().velocity[1], there.last.velocity[1], kSeen);
}

/// A kink of a line: rkmk4 is exact where the torque is linear within each step.
TEST(InputJumps, AndKinksAreNodes) {
  const InputTable bent = {{0, 0.37, 1}, {0, 0.6, 0.1}, false};
  const double impulse = 0.5 * 0.37 * 0.6 + 0.63 * 0.35;
  for (const char* scheme : {"rkmk4", "lift"}) {
    const Result r = cart(bent, 0.1).scheme(scheme).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    EXPECT_NEAR(r.last.velocity[1], 0.5 + kGain * impulse, kSeen) << scheme;
  }
}

/// The estimate of --check is that of the error: with a friction-like force the runs differ by
/// their order.
TEST(InputJumps, AreSeenByACheck) {
  const InputTable right = {{0, 0.37, 1}, {0.3, -0.3, -0.3}, true};
  const auto end = [&](double h) {
    Simulation run = simulate("segway").input("right_torque", right).step(h).until(1);
    return run.scheme("lift").with(&Config::check, true).run();
  };
  const Result coarse = end(0.1), fine = end(0.00125);
  ASSERT_TRUE(coarse.status.ok && fine.status.ok);
  EXPECT_NEAR(coarse.observed_order, 2, 0.2);
  double error = 0;
  for (size_t i = 0; i < coarse.last.coordinates.size(); ++i)
    error += std::pow(coarse.last.coordinates[i] - fine.last.coordinates[i], 2);
  EXPECT_NEAR(coarse.estimated_error / std::sqrt(error), 1, 0.2);
}

TEST(InputJumps, OfAPrescribedRateAreRefused) {
  const InputTable held = {{0, 0.37, 1}, {0.3, -0.3, -0.3}, true};
  const std::vector<std::string> mistakes =
      simulate("snakeboard").input("rotor_rate", held).until(1).mistakes();
  ASSERT_EQ(mistakes.size(), 1u);
  EXPECT_THAT(mistakes[0], HasSubstr("input 'rotor_rate': a held table jumps at t = 0.37"));
  EXPECT_THAT(mistakes[0], HasSubstr("a jump of a rate is an impulse"));
  EXPECT_TRUE(simulate("snakeboard").input("rotor_rate", held).until(0.3).mistakes().empty());
  EXPECT_TRUE(
      simulate("differential_drive").input("left_torque", held).until(1).mistakes().empty());
}

}  // namespace
}  // namespace hamel
