// Feedback along a plan: a start beside the planned one comes back.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <hamel/framework/inverse/motion_plan.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

std::string plan_file(const std::string& name) {
  const char* root = std::getenv("HAMEL_SOURCE");
  EXPECT_NE(root, nullptr) << "set HAMEL_SOURCE to the source tree (ctest does)";
  return std::string(root == nullptr ? "." : root) + "/tests/examples/" + name;
}

/// Distance from the goal at the end, of a start that is moved aside by e.
double miss(const Plan& plan, double e, bool corrected) {
  Config config = plan.run;
  config.inputs.clear();
  config.start.configuration = {0.6 * e, -e, 0.8 * e};
  config.start.velocity = {0.3 * e, 0.5 * e, 0};
  Simulation simulation(registry(), config.system);
  for (const auto& [name, values] : plan.inputs) config.inputs[name] = 0.0;
  Run run = simulation.config(config).build();
  for (long k = 0; k < plan.steps; ++k) {
    const Snapshot now = run.state();
    const std::vector<double> u = plan.feedback(k, now.coordinates, now.velocity);
    for (std::size_t i = 0; i < plan.inputs.size(); ++i)
      run.input(plan.inputs[i].first,
                corrected ? u[i] : plan.inputs[i].second[static_cast<std::size_t>(k)]);
    EXPECT_TRUE(run.step().ok);
  }
  const Snapshot end = run.state();
  return std::hypot(end.coordinates[0], end.coordinates[1], end.coordinates[2] - 1) +
         std::hypot(end.velocity[0], end.velocity[1]);
}

/// Gains are those of the plan from the state on to first order: the miss is of second order.
TEST(PlanFeedback, ADisturbedStartOfTheParkedSleighComesBack) {
  const Plan plan = make_plan(registry(), read_plan(plan_file("parking.toml")));
  ASSERT_TRUE(plan) << plan.reason;
  EXPECT_GT(miss(plan, 0.04, false), 0.03);
  const double far = miss(plan, 0.04, true), near = miss(plan, 0.02, true);
  EXPECT_LT(far, 4e-3);
  EXPECT_LT(near, 0.35 * far);
  EXPECT_NEAR(miss(plan, 0, true), 0, 1e-9);
}

TEST(PlanFeedback, RefusesWhatIsNoStateOfThePlan) {
  const Plan plan = make_plan(registry(), read_plan(plan_file("parking.toml")));
  const std::vector<double> zero(3, 0.0), two(2, 0.0);
  EXPECT_THROW(plan.feedback(100, zero, zero), std::invalid_argument);
  EXPECT_THROW(plan.feedback(0, two, zero), std::invalid_argument);
  EXPECT_EQ(plan.feedback(0, zero, zero).size(), 2u);
}

}  // namespace
}  // namespace hamel
