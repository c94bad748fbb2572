// The scheme `nonsmooth` against closed motions and runs that locate their switches.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

Simulation ball(double step, double mu = 0.2, double e = 0) {
  auto out = simulate("rolling_ball");
  out.set("radius", 0.03).set("inertia", 0.4 * 0.03 * 0.03).set("friction", mu);
  out.set("restitution", e).slip().scheme("nonsmooth").step(step);
  return out;
}
Start at_height(double z, std::vector<double> velocity) {
  return {.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, z}, .velocity = std::move(velocity)};
}
double apart(const Result& a, const Result& b) {
  double out = 0;
  for (size_t i = 0; i < a.last.coordinates.size(); ++i)
    out = std::max(out, std::abs(a.last.coordinates[i] - b.last.coordinates[i]));
  return out;
}

// The mean order of errors whose steps halve: where a switch lies in its step changes each of them.
double mean_order(const std::vector<double>& errors) {
  return std::log2(errors.front() / errors.back()) / static_cast<double>(errors.size() - 1);
}

// It slides along a parabola and ends with v0 - k/(1 + k) s0, whatever the step.
TEST(Nonsmooth, ABallSlidesAndRolls) {
  const double mu = 0.2, g = 9.81, slip = std::hypot(2 + 0.03 * 60, 0.03 * 40);
  const double ends = 2.0 / 7 * slip / (mu * g), c = (2 + 0.03 * 60) / slip;
  const double v = 2 - 2.0 / 7 * slip * c;
  const double x = 2 * ends - mu * g * c * ends * ends / 2 + v * (1 - ends);
  std::vector<double> errors;
  for (const double h : {0.04, 0.02, 0.01, 0.005, 0.0025, 0.00125}) {
    const Result r = ball(h).start(at_height(0.03, {40, -60, 7, 2, 0, 0})).until(1).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    EXPECT_NEAR(r.last.velocity[3], v, 1e-12);
    EXPECT_NEAR(r.last.coordinates[11], 0.03, 1e-14);
    // Rotation of the last step, 2 atan(a/2) of a next to the rate times h, by cayley.
    const double a = h * Eigen::Map<const Vec<3>>(r.last.velocity.data()).norm();
    EXPECT_NEAR(r.last.rotation, a - a * a * a / 12, std::pow(a, 5) / 40);
    ASSERT_EQ(r.events.size(), 1U);
    EXPECT_EQ(r.events[0].name, "contact.rolls");
    EXPECT_NEAR(r.events[0].time, ends, h);
    errors.push_back(std::abs(r.last.coordinates[9] - x));
  }
  EXPECT_GT(mean_order(errors), 1.75) << testing::PrintToString(errors);
  EXPECT_LT(errors.back(), 1e-5);
}

// A disk in space, sliding and then rolling, of three moments: nonlinear, and no closed motion.
TEST(Nonsmooth, IsOfOrderTwoThroughSlidingAndRolling) {
  const auto disk = [] {
    auto out = simulate("falling_disk");
    out.set("friction", 0.3).set("restitution", 0).slip();
    return out;
  };
  Start start = FallingDisk{}.start();
  start.velocity[2] += 4;
  for (const double until : {0.2, 0.8}) {  // without an event, and with contact.rolls
    const Result exact = disk().start(start).tolerance({.relative = 1e-11}).until(until).run();
    ASSERT_TRUE(exact.status.ok) << exact.status.reason;
    ASSERT_EQ(exact.events.size(), until < 0.5 ? 0U : 1U);
    std::vector<double> errors;
    for (const double h : {0.01, 0.005, 0.0025, 0.00125}) {
      const Result r = disk().start(start).scheme("nonsmooth").step(h).until(until).run();
      ASSERT_TRUE(r.status.ok) << r.status.reason;
      errors.push_back(apart(r, exact));
    }
    EXPECT_GT(mean_order(errors), 1.75) << testing::PrintToString(errors);
  }
}

// Impacts are of order 1; the gap is never below 0, and the ball comes to rest on the plane.
TEST(Nonsmooth, ABallBounces) {
  std::vector<double> errors;
  const double fall = std::sqrt(2 * 0.5 / 9.81), e = 0.6;
  const double first = 2 * e * fall;
  for (const double h : {0.01, 0.005, 0.0025, 0.00125, 0.000625}) {
    const Result r =
        ball(h, 0.2, e).start(at_height(0.53, {0, 0, 0, 0.3, 0, 0})).until(4).every(1).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    double least = 1, highest = 0;
    const auto& times = r.trajectory.column("t");
    const auto& z = r.trajectory.column("z");
    for (size_t i = 0; i < z.size(); ++i) {
      least = std::min(least, z[i] - 0.03);
      if (times[i] > fall + h && times[i] < fall + first) highest = std::max(highest, z[i] - 0.03);
    }
    EXPECT_GE(least, -1e-14);
    EXPECT_NEAR(r.last.coordinates[11], 0.03, 1e-14);
    EXPECT_EQ(r.last.velocity[5], 0);
    errors.push_back(std::abs(highest - e * e * 0.5));
    EXPECT_LT(errors.back(), 4 * h);  // 2 e v h, v = 3.1 m/s
  }
  EXPECT_GT(mean_order(errors), 0.8) << testing::PrintToString(errors);
}

// The motion does not know the axes: a start that is turned turns it.
TEST(Nonsmooth, IsIsotropic) {
  const double a = 0.7, c = std::cos(a), s = std::sin(a);
  const Result r =
      ball(0.01, 0.2, 0.5).start(at_height(0.1, {40, -60, 7, 2, 0.5, 0})).until(1).run();
  const Start turned{.configuration = {c, -s, 0, s, c, 0, 0, 0, 1, 0, 0, 0.1},
                     .velocity = {40, -60, 7, c * 2 - s * 0.5, s * 2 + c * 0.5, 0}};
  const Result t = ball(0.01, 0.2, 0.5).start(turned).until(1).run();
  ASSERT_TRUE(r.status.ok && t.status.ok);
  EXPECT_NEAR(t.last.coordinates[9], c * r.last.coordinates[9] - s * r.last.coordinates[10], 1e-12);
  EXPECT_NEAR(t.last.coordinates[10], s * r.last.coordinates[9] + c * r.last.coordinates[10],
              1e-12);
  EXPECT_EQ(t.events.size(), r.events.size());
}

// Without contacts it is lift.
TEST(Nonsmooth, IsLiftWhereNothingSlides) {
  const Result lift = simulate("bicycle").scheme("lift").step(0.01).until(1).run();
  const Result r = simulate("bicycle").scheme("nonsmooth").step(0.01).until(1).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_EQ(lift.last.coordinates, r.last.coordinates);
}

// Three legs slide, turn and rest, where places are known to 1e-13 m alone: at each step size.
TEST(Nonsmooth, RestsFarFromTheOrigin) {
  Mechanism m("table");
  m.body("top", {.mass = 2, .at = {0, 0, 0.4}, .inertia = {0.1, 0.12, 0.2}});
  m.free("root", "top", {.at = {0, 0, 0.4}});
  int leg = 0;
  for (const Point& at : {Point{0.3, 0, 0}, Point{-0.2, 0.25, 0}, Point{-0.2, -0.3, 0}})
    m.point("leg" + std::to_string(++leg), "top", {.at = at, .friction = 0.3});
  for (const double step : {5e-4, 1e-3, 5e-3}) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    const Result r = simulate(m)
                         .slip()
                         .scheme("nonsmooth")
                         .step(step)
                         .start({.configuration = {c, -s, 0, s, c, 0, 0, 0, 1, 300, -200, 0.4},
                                 .velocity = {0, 0, 3, 1, 0, 0}})
                         .until(0.7)
                         .run();
    ASSERT_TRUE(r.status.ok) << step << ": " << r.status.reason;
    for (const double v : r.last.velocity) EXPECT_LT(std::abs(v), 1e-9) << step;
  }
}

// Counts of a step are over all its secants.
TEST(Nonsmooth, ItsLargestCountIsNoneBelowTheMean) {
  const Result r =
      simulate("falling_disk").set("friction", 20).scheme("nonsmooth").step(0.01).until(0.5).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_GE(r.stats.iterations_max,
            static_cast<double>(r.stats.iterations) / static_cast<double>(r.steps));
}

TEST(Nonsmooth, RefusesCompositions) {
  try {
    ball(0.01).compose("yoshida4").until(1).run();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("nonsmooth has no compositions"), std::string::npos);
  }
}

}  // namespace
}  // namespace hamel
