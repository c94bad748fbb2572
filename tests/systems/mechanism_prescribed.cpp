// Joints whose motion is prescribed: where runs start, what decides the motion alone, where it is
// singular.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/mechanisms/mechanism_file.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

TEST(MechanismMotions, StartWhereTheyArePrescribed) {
  Mechanism m("arm");
  m.body("arm", {.mass = 1, .at = {1, 0, 0}, .inertia = {1, 1, 1}});
  m.body("tip", {.mass = 1, .at = {2, 0, 0}, .inertia = {1, 1, 1}});
  m.hinge("turn", kWorld, "arm", {});
  m.slider("reach", "arm", "tip", {.at = {2, 0, 0}, .axis = {1, 0, 0}});
  m.hinge("free", kWorld, m.body("wheel", {.mass = 1, .inertia = {1, 1, 1}}), {});
  m.prescribe(
      "turn", [](double t) { return std::cos(t); }, [](double t) { return 0.5 + std::sin(t); });
  m.prescribe(
      "reach", [](double) { return 0.25; }, [](double t) { return 0.25 * t; });
  m.start({{"free.rate", 2}});
  for (const double from : {0.0, 3.0}) {
    const double until = from + 1;
    const Result out = simulate(m).compose("kahan_li6").step(0.02).from(from).until(until).run();
    ASSERT_TRUE(out.status.ok) << out.status.reason;
    const auto& first = out.config.start;
    EXPECT_NEAR(first.configuration[0], 0.5 + std::sin(from), 1e-14);
    EXPECT_NEAR(first.configuration[1], 0.25 * from, 1e-14);
    EXPECT_NEAR(first.velocity[0], std::cos(from), 1e-14);
    EXPECT_NEAR(first.velocity[2], 2, 1e-14);
    EXPECT_NEAR(out.last.coordinates[0], 0.5 + std::sin(until), 1e-10);
    EXPECT_NEAR(out.last.coordinates[1], 0.25 * until, 1e-10);
  }
  EXPECT_THAT(simulate(m).start({.configuration = {0.4, 0, 0}, .velocity = {1, 0, 0}}).mistakes(),
              testing::Contains(testing::HasSubstr(
                  "prescribed 'turn': turn.angle is prescribed as 0.5 at t = 0, but 0.4")));
  const double turns = 0.5 - 2 * std::numbers::pi;
  EXPECT_TRUE(simulate(m)
                  .start({.configuration = {turns, 0, 0}, .velocity = {1, 0, 0}})
                  .mistakes()
                  .empty());
  m.start({{"turn.angle", 0.4}});
  EXPECT_THROW(m.model(), ConfigError);
}

// Two wheels on one axle, both rates prescribed: what is prescribed decides the motion alone, g' =
// g (A^-1 b)^.
//   v = r (w_left + w_right)/2, omega = r (w_right - w_left)/(2 d)
struct TwoWheels {
  double radius = 0.1, half = 0.2;  // m
  static double left(double t) { return 3 + std::sin(t); }
  static double right(double) { return 2; }
  double omega(double t) const { return radius * (right(t) - left(t)) / (2 * half); }
  double speed(double t) const { return radius * (right(t) + left(t)) / 2; }
  double theta(double t) const { return radius * (2 * t - (3 * t + 1 - std::cos(t))) / (2 * half); }

  Mechanism by_parts() const {
    Mechanism m("two wheels");
    m.body("chassis", {.mass = 5, .at = {0.05, 0, 0.1}, .inertia = {0.2, 0.3, 0.4}});
    m.planar("floor", "chassis");
    for (const auto& [name, y] : {std::pair("left", half), std::pair("right", -half)}) {
      const Point at = {0, y, radius}, axis = {0, 1, 0};
      m.body(name, {.mass = 0.4, .at = at, .cylinder = {radius, 0.03}, .axis = axis});
      m.hinge(name, "chassis", name, {.at = at, .axis = axis});
      m.wheel(name, name, {.at = at, .axle = axis, .radius = radius});
    }
    m.prescribe("left", left);
    m.prescribe("right", right);
    m.redundant("drop");
    return m;
  }
  double kinetic(double t) const {
    const double v = speed(t), w = omega(t), along = left(t), other = right(t);
    const double spin = 0.5 * 0.4 * radius * radius;
    const double across = 0.4 * (3 * radius * radius + 0.03 * 0.03) / 12;
    return 0.5 * (5 * (v * v + 0.05 * 0.05 * w * w) + 0.4 * w * w) +
           0.4 * (v * v + half * half * w * w) + across * w * w +
           0.5 * spin * (along * along + other * other);
  }
  // x and y by Simpson's rule.
  std::array<double, 2> place(double until) const {
    std::array<double, 2> out{};
    const int n = 2000;
    const double h = until / n;
    for (int i = 0; i <= n; ++i) {
      const double t = i * h, weight = (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) * h / 3;
      out[0] += weight * speed(t) * std::cos(theta(t));
      out[1] += weight * speed(t) * std::sin(theta(t));
    }
    return out;
  }
};

TEST(MechanismMotions, WhatIsPrescribedDecidesAlone) {
  const TwoWheels two;
  const double until = 2;
  const auto [x, y] = two.place(until);
  for (const char* scheme : {"dop853", "dopri5", "tsit5", "rkmk4", "rk4_projected", "lift",
                             "balance", "reversible", "gni"}) {
    const std::string name = scheme;
    const bool second =
        name == "lift" || name == "balance" || name == "reversible" || name == "gni";
    double before = 0;
    for (const double h : {0.02, 0.01}) {
      const Result out = simulate(two.by_parts()).scheme(name).step(h).until(until).run();
      ASSERT_TRUE(out.status.ok) << name << ": " << out.status.reason;
      const auto& g = out.last.coordinates;
      const double error = std::hypot(g[0] - two.theta(until), g[1] - x, g[2] - y);
      if (h == 0.01) {
        EXPECT_LT(error, second ? 3e-5 : 1e-10) << name;
        if (second) {
          EXPECT_NEAR(std::log2(before / error), 2, 0.1) << name;
        }
      }
      before = error;
      // The motors do all work: reactions of wheels that roll do none.
      const double work = two.kinetic(until) - two.kinetic(0);
      EXPECT_NEAR(out.work, work, 1e-12) << name;
      EXPECT_NEAR(out.reaction_work, work, (second ? 0.1 : 0.02) * h) << name;
      EXPECT_LT(out.energy_error_max, 1e-13) << name;
    }
  }
  // At the end the torques of the motors: power is the rate of the energy.
  const Result out = simulate(two.by_parts()).scheme("dop853").step(0.01).until(until).run();
  const double left = out.trajectory.column("left.reaction4").back(),
               right = out.trajectory.column("right.reaction4").back(), e = 1e-5;
  EXPECT_NEAR(left * TwoWheels::left(until) + right * TwoWheels::right(until),
              (two.kinetic(until + e) - two.kinetic(until - e)) / (2 * e), 1e-8);
}

// Trunk and two legs with a blade each, the hips prescribed; drawn straight, where both blades say
// the same. The tree grows from the trunk, or from the left leg.
Mechanism roller_walker(bool from_trunk) {
  Mechanism m("roller walker");
  const std::vector<double> moments = {1, 1, 0.1};
  m.body("trunk", {.mass = 8, .at = {0, 0, 0.2}, .inertia = moments});
  m.body("left", {.mass = 1, .at = {0.1, 0.3, 0.15}, .inertia = moments});
  m.body("right", {.mass = 1, .at = {0.1, -0.3, 0.15}, .inertia = moments});
  m.planar("road", from_trunk ? "trunk" : "left");
  const Point hip = {0.1, 0.15, 0};
  if (from_trunk) m.hinge("left hip", "trunk", "left", {.at = hip});
  else m.hinge("left hip", "left", "trunk", {.at = hip});
  m.hinge("right hip", "trunk", "right", {.at = {0.1, -0.15, 0}});
  m.blade("left", "left", {.at = {0.1, 0.45, 0}});
  m.blade("right", "right", {.at = {0.1, -0.45, 0}});
  const double side = from_trunk ? 1 : -1;
  m.prescribe("left hip", [side](double t) { return side * 1.2 * std::cos(3 * t); });
  m.prescribe("right hip", [](double t) { return -1.2 * std::cos(3 * t); });
  return m;
}

TEST(MechanismMotions, RollerWalkerIsSingularOnlyAsDrawn) {
  const auto at = [](double theta, double x, double y) {
    return Eigen::Translation2d(x, y) * Eigen::Rotation2Dd(theta);
  };
  const double left = 0.3, right = -0.25;
  Mechanism ours = roller_walker(true);
  ours.start({{"left hip.angle", left}, {"right hip.angle", right}, {"v1", 0.3}});
  EXPECT_EQ(ours.model().mechanics->constraint_count(), 4);
  const Eigen::Vector2d hip(0.1, 0.15);
  // The left leg seen from the trunk turns about the hip; as drawn both are at the origin.
  const auto leg = [&](double theta, double x, double y, double angle) {
    return Eigen::Isometry2d(at(theta, x, y) * Eigen::Translation2d(hip) *
                             Eigen::Rotation2Dd(angle) * Eigen::Translation2d(-hip));
  };
  const Result mine = simulate(ours).compose("kahan_li6").step(0.002).until(2).run();
  ASSERT_TRUE(mine.status.ok) << mine.status.reason;
  Mechanism other = roller_walker(false);
  const Eigen::Isometry2d first = leg(0, 0, 0, left);
  const auto& v = mine.config.start.velocity;
  const Eigen::Vector2d shift = first.translation();
  const Eigen::Vector2d velocity =
      first.linear().transpose() *
      (Eigen::Vector2d(v[1], v[2]) + v[0] * Eigen::Vector2d(-shift[1], shift[0]) +
       v[3] * Eigen::Vector2d(-(shift - hip)[1], (shift - hip)[0]));
  const Result hers = simulate(other)
                          .start({.configuration = {left, shift[0], shift[1], -left, right},
                                  .velocity = {v[0] + v[3], velocity[0], velocity[1], -v[3], v[4]}})
                          .compose("kahan_li6")
                          .step(0.002)
                          .until(2)
                          .run();
  ASSERT_TRUE(hers.status.ok) << hers.status.reason;
  const auto& g = mine.last.coordinates;
  const auto& h = hers.last.coordinates;
  const Eigen::Isometry2d last = leg(g[0], g[1], g[2], g[3]);
  EXPECT_NEAR(std::remainder(g[0] + g[3] - h[0], 2 * std::numbers::pi), 0, 1e-9);
  EXPECT_NEAR(last.translation()[0], h[1], 1e-9);
  EXPECT_NEAR(last.translation()[1], h[2], 1e-9);
  EXPECT_NEAR(mine.last.energy, hers.last.energy, 1e-9 * (1 + std::abs(mine.last.energy)));
  for (const char* row : {"left.reaction1", "right.reaction1"})
    EXPECT_NEAR(mine.trajectory.column(row).back(), hers.trajectory.column(row).back(), 1e-7);
}

// A pendulum whose pivot is shaken, 2 mm at 160 Hz: (J + m l^2) angle'' = m (g + a) (x cos + z
// sin), a the acceleration of the pivot; by Runge-Kutta 4 with steps of 5 us, error 1e-11.
TEST(MechanismMotions, FollowWhatIsPrescribedFast) {
  constexpr double mass = 0.2, pivot = 0.1, x = 0.02, z = 0.1, g = 9.81, w = 1000, until = 0.5;
  const auto with = [&](const std::string& rate) {
    return mechanism_info(R"toml(
name = "shaken"
body = [ { name = "pivot", mass = 0.1, at = [0, 0, 0], sphere = 0.01 },
         { name = "bob", mass = 0.2, at = [0.02, 0, 0.1], sphere = 0.01 } ]
joint = [ { name = "shake", kind = "slider", child = "pivot", at = [0, 0, 0], axis = [0, 0, 1] },
  { name = "swing", kind = "hinge", parent = "pivot", child = "bob", at = [0, 0, 0], axis = [0, 1, 0] } ]
prescribed = [ { joint = "shake", )toml" +
                              rate + " } ]",
                          "shaken.toml");
  };
  const double moment = 0.4 * mass * 1e-4 + mass * (x * x + z * z);
  const auto turn = [&](double t, double angle) {
    return mass * (g - 2 * w * std::sin(w * t)) * (x * std::cos(angle) + z * std::sin(angle)) /
           moment;
  };
  double angle = 0, rate = 0;
  constexpr int steps = 100000;
  const double h = until / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * h;
    const double k1 = turn(t, angle), k2 = turn(t + h / 2, angle + h / 2 * rate),
                 k3 = turn(t + h / 2, angle + h / 2 * rate + h * h / 4 * k1),
                 k4 = turn(t + h, angle + h * rate + h * h / 2 * k2);
    angle += h * rate + h * h / 6 * (k1 + k2 + k3);
    rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  const double c = std::cos(angle), s = std::sin(angle), slope = -(x * c + z * s),
               bend = x * s - z * c;  // of the height of the bob
  const double force = (pivot + mass) * (g - 2 * w * std::sin(w * until)) +
                       mass * (slope * turn(until, angle) + bend * rate * rate);
  for (const char* how : {"rate = \"2*cos(1000*t)\"", "angle = \"0.002*sin(1000*t)\""}) {
    SCOPED_TRACE(how);
    Registry mine = registry();
    mine.add(with(how));
    const Result result = Simulation(mine, "shaken")
                              .start({.velocity = {2, 0}})
                              .scheme("dop853")
                              .tolerance({.relative = 1e-12})
                              .until(until)
                              .run();
    ASSERT_TRUE(result.status.ok) << result.status.reason;
    EXPECT_NEAR(result.last.coordinates[0], 0.002 * std::sin(w * until), 1e-10);
    EXPECT_NEAR(result.last.coordinates[1], angle, 1e-8);
    EXPECT_NEAR(result.last.velocity[1], rate, 1e-7);
    EXPECT_NEAR(result.trajectory.column("shake.reaction1").back(), force, 1e-6);
  }
}

}  // namespace
}  // namespace hamel
