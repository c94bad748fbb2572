// A plan is the same in every unit of length, mass, time and cost: rescaled numbers, as many
// iterations.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <hamel/framework/inverse/motion_plan.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "random_units.hpp"

namespace hamel {
namespace {

using namespace test;

PlanRequest file(const std::string& name) {
  const char* root = std::getenv("HAMEL_SOURCE");
  EXPECT_NE(root, nullptr) << "set HAMEL_SOURCE to the source tree (ctest does)";
  return read_plan(std::string(root == nullptr ? "." : root) + "/tests/examples/" + name + ".toml");
}

void scale(std::pair<double, double>& range, double by) {
  range.first *= by;
  range.second *= by;
}

/// Parked in a free time, with bounds on inputs and a velocity.
PlanRequest parking(const Units& in) {
  PlanRequest out = file("parking");
  out.steps = 20;
  out.run.parameters = {{"m", {2 * in.mass}}, {"J", {0.7 * in.of(2, 1, 0)}}};
  out.free_time = FreeTime{in.time, 9 * in.time};
  out.time_weight = 0.5 * in.cost / in.time;
  out.to_configuration[2] = 1.5 * in.length;
  out.input_weights = {{"torque", in.weight(in.torque())}, {"force", 2 * in.weight(in.force())}};
  out.bounds["torque"] = {-1, 1};
  out.bounds["v1"] = {-0.9, 0.9};
  scale(out.bounds["torque"], in.torque());
  scale(out.bounds["v1"], in.of(1, 0, -1));
  return out;
}

/// The same by a scheme whose step is differentiated by differences.
PlanRequest parking_by_differences(const Units& in) {
  PlanRequest out = parking(in);
  out.run.scheme = "rkmk4";
  out.run.s = Config{}.s;
  return out;
}

/// Gravity, parameters that are lists, a formula as constraint and one as cost.
PlanRequest segway(const Units& in) {
  PlanRequest out = file("segway_to_rest");
  const double moment = in.of(2, 1, 0);
  out.steps = 15;
  out.run.until *= in.time;
  out.run.parameters = {{"mass", {60 * in.mass}},
                        {"height", {0.9 * in.length}},
                        {"inertia", {8 * moment, 7 * moment, 2 * moment}},
                        {"wheel_mass", {5 * in.mass}},
                        {"wheel_radius", {0.25 * in.length}},
                        {"half_track", {0.3 * in.length}},
                        {"wheel_inertia", {0.15 * moment}},
                        {"wheel_diameter_inertia", {0.08 * moment}},
                        {"gravity", {9.81 * in.of(1, 0, -2)}}};
  out.run.start.configuration = {0, 0, 0, 0, 0, 0.02};
  out.run.start.velocity = {0, 0, 0, 0, 0, 0};
  out.to_configuration[1] = in.length;
  for (const char* input : {"right_torque", "left_torque"}) {
    scale(out.bounds[input], in.torque());
    out.input_weights[input] = in.weight(in.torque());
  }
  out.running = fmt::format("{:.17g}*pitch^2", in.cost / in.time);
  return out;
}

/// No angles: sizes are those of the way and of the start's velocity.
PlanRequest cart(const Units& in) {
  PlanRequest out;
  out.run.system = cart_file("plan_units_cart");
  out.run.parameters = {{"m", {1.3 * in.mass}}, {"k", {0.8 * in.of(0, 1, -2)}}, {"l", {in.length}}};
  out.run.start.velocity = {0.4 * in.of(1, 0, -1), -0.2 * in.of(1, 0, -1)};
  out.run.until = 3 * in.time;
  out.steps = 20;
  out.inputs = {"force"};
  out.input_weights = {{"force", in.weight(in.force())}};
  out.to_configuration = {in.length, 0.2 * in.length};
  out.bounds["force"] = {-3 * in.force(), 3 * in.force()};
  return out;
}

/// Quantities of a state by the unit of their coordinate or rate, those of the new units beside
/// those of the old.
void expect_same(const Plan& plan, const Plan& old, const Units& in) {
  EXPECT_EQ(plan.iterations, old.iterations);
  EXPECT_NEAR(plan.objective, in.cost * old.objective, 1e-8 * in.cost * old.objective);
  EXPECT_NEAR(plan.until, in.time * old.until, 1e-6 * in.time * old.until);
  for (std::size_t i = 0; i < plan.inputs.size(); ++i) {
    const bool torque = plan.inputs[i].first != "force";
    const double unit = torque ? in.torque() : in.force();
    double largest = 0, off = 0;
    for (std::size_t k = 0; k < plan.inputs[i].second.size(); ++k) {
      largest = std::max(largest, std::abs(old.inputs[i].second[k]));
      off = std::max(off, std::abs(plan.inputs[i].second[k] / unit - old.inputs[i].second[k]));
    }
    EXPECT_LT(off, 1e-5 * largest) << plan.inputs[i].first;
  }
}

class UnitsOfAPlan : public testing::TestWithParam<PlanRequest (*)(const Units&)> {};

TEST_P(UnitsOfAPlan, MakeNoDifference) {
  const Plan old = make_plan(registry(), GetParam()(Units{}));
  ASSERT_TRUE(old) << old.reason;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Units in = random_units(seed);
    SCOPED_TRACE(testing::Message() << in.length << " lengths, " << in.mass << " masses, "
                                    << in.time << " times, " << in.cost << " costs");
    const Plan plan = make_plan(registry(), GetParam()(in));
    ASSERT_TRUE(plan) << plan.reason;
    expect_same(plan, old, in);
  }
}

INSTANTIATE_TEST_SUITE_P(Plans, UnitsOfAPlan,
                         testing::Values(parking, parking_by_differences, segway, cart));

}  // namespace
}  // namespace hamel
