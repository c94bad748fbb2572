// Linearisations for control: against eigenvalues, and the nonlinear motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Dense>

#include <hamel/framework/analysis/equations.hpp>
#include <hamel/framework/analysis/linearisation.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/systems/by_name.hpp>

namespace hamel {
namespace {

Eigen::MatrixXd matrix_of(const NumberMatrix& m) {
  Eigen::MatrixXd out(m.rows, m.columns);
  for (int i = 0; i < m.rows; ++i)
    for (int j = 0; j < m.columns; ++j) out(i, j) = m(i, j);
  return out;
}

// A has the eigenvalues of the motion, and the zeros of its family.
TEST(Linearisation, HasTheEigenvalues) {
  for (const char* system : {"bicycle", "segway"}) {
    const Linearisation linear = linearisation(registry(), simulate(system).speed(3));
    const Eigen::VectorXcd values = dense::eigenvalues(matrix_of(linear.a));
    ASSERT_EQ(static_cast<size_t>(values.size()),
              linear.motion.eigenvalues.size() + static_cast<size_t>(linear.motion.family));
    for (const auto& expected : linear.motion.eigenvalues) {
      double least = 1e9;
      for (const auto& value : values) least = std::min(least, std::abs(value - expected));
      EXPECT_LT(least, 1e-9) << system;
    }
    const std::set<std::string> names(linear.states.begin(), linear.states.end());
    EXPECT_EQ(names.size(), linear.states.size());
    EXPECT_EQ(linear.c.columns, linear.a.rows);
    EXPECT_EQ(linear.embedding.columns, linear.a.rows);
  }
}

/// What a small torque does within h is that of the nonlinear motion, to the second order.
TEST(Linearisation, SampledPairIsTheMotion) {
  constexpr double h = 0.1;
  for (const auto& [system, input, speed] :
       {std::tuple{"segway", "left_torque", 1.0}, {"bicycle", "steer.torque", 4.5}}) {
    const Linearisation linear = linearisation(registry(), simulate(system).speed(speed));
    const auto at = std::find(linear.inputs.begin(), linear.inputs.end(), input);
    ASSERT_NE(at, linear.inputs.end()) << system;
    const auto column = static_cast<int>(at - linear.inputs.begin());
    const DiscretePair pair = linear.sampled(h);
    const Start start = {.configuration = linear.motion.element,
                         .velocity = linear.motion.velocity};  // without the push of the file
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const double torque = 1e-2 / (1 + k);
      const Result run = simulate(system)
                             .start(start)
                             .input(input, torque)
                             .scheme("dop853")
                             .tolerance({.relative = 1e-12})
                             .until(h)
                             .run();
      ASSERT_TRUE(run.status.ok);
      const std::vector<double> x = linear.state(run.last.coordinates, run.last.velocity);
      double size = 0;
      error[k] = 0;
      for (int i = 0; i < pair.b.rows; ++i) {
        const double expected = pair.b(i, column) * torque;
        size = std::max(size, std::abs(expected));
        error[k] = std::max(error[k], std::abs(x[static_cast<size_t>(i)] - expected));
      }
      EXPECT_LT(error[k], 0.01 * size) << system;
    }
    EXPECT_LT(error[1], error[0] / 3 + 1e-12) << system;
  }
}

/// An input of a rate is none: it changes what the states may be.
TEST(Linearisation, NamesWhatItLeavesOut) {
  Mechanism m("cart");
  const auto cart = m.body("cart", {.mass = 2, .at = {0, 0, 0.1}, .box = {0.4, 0.2, 0.1}});
  const auto arm = m.body("arm", {.mass = 1, .at = {0, 0, 0.5}, .inertia = {0.1, 0.1, 0.01}});
  m.planar("road", cart);
  m.hinge("pivot", cart, arm, {.at = {0, 0, 0.2}, .axis = {0, 1, 0}});
  m.blade("keel", cart, {});
  m.prescribe("pivot");
  const Linearisation linear = linearisation(registry(), simulate(m).speed(1));
  ASSERT_EQ(linear.unused.size(), 1u);
  EXPECT_EQ(linear.unused[0], "pivot.rate");
  EXPECT_TRUE(linear.inputs.empty());
}

// A torque of 1 N m changes the rates of joints as the accelerations do,
// which go through another frame; no symmetry changes these. Differences of any scale gave 0.29 for
// 0.0079.
TEST(Linearisation, InputsAccelerateJoints) {
  for (const char* system : {"car", "kick_scooter"}) {
    const Simulation run = simulate(system);
    const Linearisation linear = linearisation(registry(), run);
    const Equations equations(run);
    const std::vector<std::string>& names = equations.velocities();
    const Start at{linear.motion.element, linear.motion.velocity, {}};
    int compared = 0;
    for (size_t input = 0; input < linear.inputs.size(); ++input) {
      const NumberMatrix slopes = equations.jacobian("rate", linear.inputs[input], at).values;
      for (size_t i = 0; i < linear.states.size(); ++i) {
        const auto place = std::ranges::find(names, linear.states[i]) - names.begin();
        if (place == std::ssize(names) || linear.states[i].find(".rate") == std::string::npos)
          continue;
        const double expected = slopes(static_cast<int>(place), 0);
        EXPECT_NEAR(linear.b(static_cast<int>(i), static_cast<int>(input)), expected,
                    1e-11 * (1e-3 + std::abs(expected)))
            << system << ", " << linear.states[i] << " by " << linear.inputs[input];
        ++compared;
      }
    }
    EXPECT_GT(compared, 0) << system;
  }
}

}  // namespace
}  // namespace hamel
