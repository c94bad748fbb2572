// Sensors of mechanisms, against positions by hand and differences along a motion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

// An arm of length l on a hinge that turns at a rate, by a motor: centripetal acceleration.
TEST(Sensors, PointOfAnArm) {
  const double l = 0.8, rate = 1.7, until = 2;
  Mechanism m("arm");
  m.gravity({0, 0, 0});
  m.body("arm", {.mass = 2, .at = {0.3, 0, 0.5}, .inertia = {1, 1, 1}});
  m.hinge("turn", kWorld, "arm", {});
  m.sensor("tip", "arm", {l, 0, 0.5});
  m.sensor("post", kWorld, {1, 2, 3});
  m.start("turn.rate", rate);
  const Result run = simulate(m).tolerance({.relative = 1e-12}).until(until).run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  const auto last = [&](const std::string& name) { return run.trajectory.column(name).back(); };
  const double angle = rate * until;
  EXPECT_NEAR(last("tip.x"), l * std::cos(angle), 1e-11);
  EXPECT_NEAR(last("tip.y"), l * std::sin(angle), 1e-11);
  EXPECT_NEAR(last("tip.z"), 0.5, 1e-13);
  EXPECT_NEAR(last("tip.vx"), -l * rate * std::sin(angle), 1e-11);
  EXPECT_NEAR(last("tip.vy"), l * rate * std::cos(angle), 1e-11);
  EXPECT_NEAR(last("tip.ax"), -l * rate * rate * std::cos(angle), 1e-10);
  EXPECT_NEAR(last("tip.ay"), -l * rate * rate * std::sin(angle), 1e-10);
  EXPECT_NEAR(last("tip.yaw"), std::remainder(angle, 2 * std::acos(-1)), 1e-11);
  for (const auto& [name, value] : {std::pair("x", 1.0), std::pair("y", 2.0), std::pair("z", 3.0)})
    EXPECT_EQ(last(fmt::format("post.{}", name)), value);
  EXPECT_EQ(last("post.ax"), 0);
}

// Velocities and accelerations are the derivatives of places along a motion in space with rows and
// forces, on a frame, on a wheel that turns (a rotor), and on the fork between them.
TEST(Sensors, RatesAreThoseOfDifferences) {
  Mechanism m("scooter in space");
  m.body("deck", {.mass = 5, .at = {0.3, 0, 0.4}, .inertia = {0.3, 0.4, 0.5}});
  m.body("fork", {.mass = 1, .at = {0.7, 0.05, 0.5}, .inertia = {0.05, 0.04, 0.02}});
  m.body("wheel", {.mass = 1, .at = {0.8, 0, 0.3}, .cylinder = {0.3, 0.05}, .axis = {0, 1, 0}});
  m.free("root", "deck", {});
  m.hinge("steer", "deck", "fork", {.at = {0.7, 0, 0.5}, .axis = {-0.3, 0, 1}});
  m.hinge("axle", "fork", "wheel", {.at = {0.8, 0, 0.3}, .axis = {0, 1, 0}});
  m.wheel("wheel", "wheel", {.at = {0.8, 0, 0.3}, .radius = 0.3});
  m.motor("steer", [](const SignalInput& now) { return 0.4 * std::sin(3 * now.t); });
  m.sensor("a", "deck", {0.1, 0.2, 0.9});
  m.sensor("b", "fork", {0.6, -0.3, 0.8});
  m.sensor("c", "wheel", {0.9, 0.1, 0.5});
  m.start({{"v1", 1.2}, {"w1", 0.3}, {"w2", -0.2}, {"steer.rate", 0.5}});
  const double h = 1e-3, t = 0.25;
  const Result run = simulate(m)
                         .tolerance({.relative = 1e-13})
                         .until(t + 3 * h)
                         .with(&Config::output_times, {t - 2 * h, t - h, t, t + h, t + 2 * h})
                         .run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  for (const char* sensor : {"a", "b", "c"}) {
    for (const char* axis : {"x", "y", "z"}) {
      SCOPED_TRACE(std::string(sensor) + "." + axis);
      const auto column = [&](const char* kind) {
        return run.trajectory.column(fmt::format("{}.{}{}", sensor, kind, axis));
      };
      // Differences of order 4 of the five rows: 1e-12 h^-1 of round-off, h^4 of truncation.
      const auto slope = [&](const std::vector<double>& f) {
        return (f[0] - 8 * f[1] + 8 * f[3] - f[4]) / (12 * h);
      };
      const auto place = column(""), velocity = column("v"), acceleration = column("a");
      EXPECT_NEAR(velocity[2], slope(place), 1e-8 * (1 + std::abs(velocity[2])));
      EXPECT_NEAR(acceleration[2], slope(velocity), 1e-7 * (1 + std::abs(acceleration[2])));
    }
  }
}

TEST(Sensors, MistakesAreNamed) {
  Mechanism m("arm");
  m.body("arm", {.mass = 2, .inertia = {1, 1, 1}});
  m.hinge("turn", kWorld, "arm", {});
  m.sensor("tip", "arn", {1, 0, 0});
  m.sensor("tip", "arm", {2, 0, 0});
  try {
    m.model();
    FAIL() << "a sensor on no body";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("sensor 'tip': this name is taken"));
  }
  Mechanism other("arm");
  other.body("arm", {.mass = 2, .inertia = {1, 1, 1}});
  other.hinge("turn", kWorld, "arm", {});
  other.sensor("tip", "arn", {1, 0, 0});
  try {
    other.model();
    FAIL() << "a sensor on no body";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'arm'"));
  }
}

TEST(Starts, CoordinatesAndVelocitiesByName) {
  const Result scooter =
      simulate("kick_scooter").speed(1.5).start("steer.angle", 0.1).until(0.1).run();
  EXPECT_NEAR(scooter.trajectory.column("steer.angle").front(), 0.1, 1e-14);
  EXPECT_NEAR(scooter.trajectory.column("v1").front(), 1.5, 1e-12);
  EXPECT_NEAR(
      simulate("kick_scooter").start("v1", 1.5).until(0.1).run().trajectory.column("v1").front(),
      1.5, 1e-12);
  const Result sleigh =
      simulate("chaplygin_sleigh").start("omega", 0.7).start("theta", 0.3).until(0.1).run();
  EXPECT_NEAR(sleigh.trajectory.column("omega").front(), 0.7, 1e-14);
  EXPECT_NEAR(sleigh.trajectory.column("theta").front(), 0.3, 1e-14);
  EXPECT_THAT(simulate("kick_scooter").start("steer.angel", 0.1).mistakes(),
              testing::ElementsAre(testing::HasSubstr("did you mean 'steer.angle'")));
  EXPECT_THAT(simulate("kick_scooter").start("v1", 1).start("xi2", 1).mistakes(),
              testing::ElementsAre(testing::HasSubstr("is given twice")));
}

}  // namespace
}  // namespace hamel
