// Random robots that steer by skidding: each run against that in steps of one size, which decides
// modes by impulses, and its balance of energy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <random>
#include <string>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "slipping.hpp"

namespace hamel {
namespace {

using namespace test;

// Three to six wheels, of which some have torques that grow, some are locked; on the floor or in
// space, where the loads of more than three are shared.
Mechanism random_robot(unsigned seed) {
  std::mt19937 engine(seed);
  const auto random = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  Mechanism m("robot");
  const double mass = random(5, 40);
  m.body("base", {.mass = mass,
                  .at = {random(-0.05, 0.05), random(-0.05, 0.05), random(0.12, 0.2)},
                  .box = {0.6, 0.4, 0.1}});
  if (random(0, 1) < 0.5) m.planar("floor", "base");
  else m.free("root", "base");
  const int wheels = 3 + static_cast<int>(random(0, 4));
  const double mu = random(0.3, 0.8), r = 0.1;
  for (int i = 0; i < wheels; ++i) {
    const std::string name = fmt::format("wheel{}", i + 1);
    const double x = 0.25 * (i / 2 - (wheels - 1) / 4.0) + random(-0.02, 0.02),
                 y = (i % 2 == 0 ? 0.2 : -0.2) + random(-0.02, 0.02);
    const bool locked = random(0, 1) < 0.15;
    std::string carrier = "base";
    if (!locked) {
      m.body(name, {.mass = random(0.5, 2), .at = {x, y, r}, .inertia = {0.003, 0.005, 0.003}});
      m.hinge(name, "base", name, {.at = {x, y, r}, .axis = {0, 1, 0}});
      const double slope = random(-0.6, 0.6) * mu * mass * kGravity * r / wheels;
      m.motor(name, [slope](const SignalInput& at) { return slope * at.t; });
      carrier = name;
    }
    m.wheel(name, carrier, {.at = {x, y, r}, .radius = r, .friction = mu});
  }
  return m;
}

// Contacts push, none pulls: where a row has a normal reaction, which is the third of its contact.
void expect_no_pull(const Result& run) {
  for (const std::string& name : run.trajectory.columns()) {
    if (!name.ends_with(".reaction3")) continue;
    const std::vector<double> pushes = run.trajectory.column(name);
    const auto [least, most] = std::ranges::minmax(pushes);
    EXPECT_GE(least, -1e-6 * most) << name;
  }
}

// Some end with their reason: those that tip by statics or land on several wheels at once, a slip
// that is slow for long (one in twenty).
TEST(SkiddingRobots, MoveAsInStepsOfOneSize) {
  int compared = 0, ended = 0;
  for (unsigned seed = 1; seed <= 16; ++seed) {
    SCOPED_TRACE(seed);
    const Mechanism m = random_robot(seed);
    const double until = 3;
    Result exact;
    try {
      exact = slipping(m).until(until).run();
    } catch (const std::exception& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("it would tip"));
      continue;
    }
    expect_no_pull(exact);
    if (exact.status.reason.starts_with("simultaneous_impacts")) continue;
    if (!exact.status.ok) {
      ++ended;
      continue;
    }
    EXPECT_LT(exact.energy_error_max, 1e-7);
    const Result steps = simulate(m).slip().scheme("nonsmooth").step(1e-3).until(until).run();
    ASSERT_TRUE(steps.status.ok) << steps.status.reason;  // rows that repeat each other do not jam
    ++compared;
    double size = 1e-6;
    for (const double v : exact.last.velocity) size = std::max(size, std::abs(v));
    for (size_t j = 0; j < exact.last.velocity.size(); ++j)
      EXPECT_NEAR(exact.last.velocity[j], steps.last.velocity[j], 1e-4 * size) << j;
  }
  EXPECT_LE(ended, 3);
  EXPECT_GE(compared, 10);
}

// Two slips that begin together, of which one ends before it has grown: its friction's direction is
// left to the error of the run, which is said. From rest: what a contact's speeds are is no matter
// of the steps that the rest takes (a scale of 147 m/s for one of 0.01 made it 6e-4).
TEST(SkiddingRobots, ASlowSlipIsSaid) {
  const Mechanism m = random_robot(84);
  const Result exact = slipping(m).until(3).run();
  ASSERT_TRUE(exact.status.ok) << exact.status.reason;
  EXPECT_THAT(
      exact.notes,
      testing::Contains(testing::StartsWith("slow slip: contact 'wheel4' slides from t = 2.8438")));
  const Result steps = simulate(m).slip().scheme("nonsmooth").step(5e-4).until(3).run();
  ASSERT_TRUE(steps.status.ok) << steps.status.reason;
  EXPECT_NEAR(time_of(exact, "wheel4.rolls"), time_of(steps, "wheel4.rolls"), 0.01);
  double size = 0, apart = 0;
  for (size_t j = 0; j < exact.last.velocity.size(); ++j) {
    size = std::max(size, std::abs(exact.last.velocity[j]));
    apart = std::max(apart, std::abs(exact.last.velocity[j] - steps.last.velocity[j]));
  }
  EXPECT_LT(apart, 5e-5 * size);
}

}  // namespace
}  // namespace hamel
