// Derivatives of runs through impacts, and of runs that an event ends: closed forms, differences of
// whole runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <hamel/framework/tangent/sensitivities.hpp>
#include <hamel/systems/by_text.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace {

constexpr double kBack = 0.8;  // of the speed, after an impact

/// A ball of radius r that falls from z0 = 1 with z0' = 0.3.
hamel::Simulation ball() {
  return hamel::simulate_text(R"(
name = "ball"
group = "r1"
coordinates = ["z"]
inertia = ["m"]
potential = "m*g*z"
configuration = [1]
velocity = [0.3]
[parameters]
m = { value = 2, unit = "kg", meaning = "mass" }
g = { value = 9.81, unit = "m/s^2", meaning = "gravity" }
r = { value = 0.1, unit = "m", meaning = "radius" }
)",
                              "ball.toml")
      .tolerance({.relative = 1e-12})
      .until(1.6);
}

hamel::Simulation bouncing_ball() {
  return ball().on_event("z=r", [](hamel::EventState& at) { at.velocity[0] *= -kBack; });
}

/// Height and velocity at t, behind the second impact: it arrives with V = (v0^2 + 2 g (z0 -
/// r))^1/2 at t1 = (v0 + V)/g, leaves with e V and arrives again at t2 = t1 + 2 e V/g.
template <class T>
std::pair<T, T> exact_ball(T z0, T v0, T g, T r, double t) {
  const T speed = std::sqrt(v0 * v0 + 2.0 * g * (z0 - r)), first = (v0 + speed) / g,
          second = first + 2 * kBack * speed / g, flight = t - second, up = kBack * kBack * speed;
  return {r + up * flight - 0.5 * g * flight * flight, up - g * flight};
}

std::vector<std::pair<double, double>> slopes_of_ball(double t) {
  using C = std::complex<double>;
  const double tiny = 1e-30;
  std::vector<std::pair<double, double>> out;
  for (int p = 0; p < 4; ++p) {
    C x[4] = {1.0, 0.3, 9.81, 0.1};
    x[p] += C(0, tiny);
    const auto [z, v] = exact_ball<C>(x[0], x[1], x[2], x[3], t);
    out.emplace_back(z.imag() / tiny, v.imag() / tiny);
  }
  return out;
}

/// Two impacts: the derivatives jump at each, and grow by the start.
TEST(TangentEvents, OfABouncingBallAreClosed) {
  const std::vector<std::string> by = {"start.z", "start.z'", "g", "r"};
  const hamel::Simulation bouncing = bouncing_ball();
  ASSERT_EQ(bouncing.run().events.size(), 2u);
  const auto exact = slopes_of_ball(1.6);
  for (size_t i = 0; i < 2; ++i) {
    const hamel::Gradient found = bouncing.gradient(i == 0 ? "z" : "z'", by);
    ASSERT_TRUE(found.status.ok) << found.status.reason;
    for (size_t p = 0; p < by.size(); ++p) {
      const double expected = i == 0 ? exact[p].first : exact[p].second;
      EXPECT_NEAR(found.by[p], expected, 1e-8 * (1 + std::abs(expected))) << by[p];
    }
  }
  hamel::Run run = bouncing.build();
  ASSERT_TRUE(run.complete().ok);
  const hamel::RunTangent tangent = run.tangent();
  ASSERT_TRUE(tangent.status.ok) << tangent.status.reason;
  EXPECT_NEAR(tangent.matrix(0, 0), exact[0].first, 1e-8);
  EXPECT_NEAR(tangent.matrix(0, 1), exact[1].first, 1e-8);
  EXPECT_NEAR(tangent.matrix(1, 0), exact[0].second, 1e-7);
  EXPECT_NEAR(tangent.matrix(1, 1), exact[1].second, 1e-7);
}

/// Rows on both sides of the impacts, of steps of one size too: at nodes.
TEST(TangentEvents, OfRowsBetweenImpactsAreThoseOfNeighbours) {
  const hamel::Simulation bouncing =
      bouncing_ball().tolerance({}).scheme("dop853").step(0.05).until(1.6);
  const hamel::Sensitivities along = bouncing.sensitivities({"start.z"});
  ASSERT_TRUE(along.status.ok) << along.status.reason;
  const auto& t = std::get<std::vector<double>>(along.rows.column("t").values);
  const auto& slope = std::get<std::vector<double>>(along.rows.column("d(z)/d(start.z)").values);
  const double first = (0.3 + std::sqrt(0.09 + 2 * 9.81 * 0.9)) / 9.81;
  EXPECT_EQ(slope.front(), 1);
  for (size_t i = 0; i < t.size(); ++i) EXPECT_NEAR(t[i] < first ? slope[i] : 1, 1, 1e-9);
  // By the motion behind both: the last row is a node beside t = 1.6.
  EXPECT_NEAR(slope.back(), slopes_of_ball(t.back())[0].first, 1e-8);
}

/// A stop happens at another time: t = (v0 + V)/g, z = r, z' = -V.
TEST(TangentEvents, OfARunThatAnEventEndsAreThoseAtItsOwnTime) {
  const hamel::Sensitivities along = ball().stop_at({"z=r"}).sensitivities({"start.z", "g", "r"});
  ASSERT_TRUE(along.status.ok) << along.status.reason;
  const double g = 9.81, speed = std::sqrt(0.09 + 2 * g * 0.9);
  const double by_speed[] = {g / speed, 0.9 / speed, -g / speed};
  const double height[] = {0, 0, 1};
  ASSERT_EQ(along.end_time.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    const auto last = [&](const std::string& of) {
      return std::get<std::vector<double>>(
                 along.rows.column("d(" + of + ")/d(" + along.names[i] + ")").values)
          .back();
    };
    EXPECT_NEAR(along.end_time[i], by_speed[i] / g - (i == 1 ? (0.3 + speed) / (g * g) : 0), 1e-9);
    EXPECT_NEAR(last("z"), height[i], 1e-9);
    EXPECT_NEAR(last("z'"), -by_speed[i], 1e-8);
  }
  // The time itself, as a number at the end.
  const hamel::Gradient time = ball().stop_at({"z=r"}).gradient("t", {"start.z"});
  ASSERT_TRUE(time.status.ok) << time.status.reason;
  EXPECT_NEAR(time.by[0], 1 / speed, 1e-9);
}

/// A sleigh in a lane, turned round at each wall: differences of whole runs.
TEST(TangentEvents, OfASleighInALaneAreThoseOfWholeRuns) {
  const auto lane = [](double offset, double omega) {
    const auto turn = [](hamel::EventState& at) { at.velocity[1] *= -1; };
    return hamel::simulate("chaplygin_sleigh")
        .set("offset", offset)
        .start({.velocity = {omega, 0.5, 0}})
        .scheme("dop853")
        .tolerance({.relative = 1e-12})
        .on_event("y=0.4", turn)
        .on_event("y=-0.4", turn)
        .until(6);
  };
  const auto end = [&](double offset, double omega) {
    const hamel::Result result = lane(offset, omega).run();
    EXPECT_GE(result.events.size(), 2u);
    return result.trajectory.column("x").back();
  };
  const hamel::Gradient found = lane(0.2, 1.5).gradient("x", {"offset", "start.omega"});
  ASSERT_TRUE(found.status.ok) << found.status.reason;
  const auto slope = [](const auto& f, double e) {
    return (64 * (f(e / 4) - f(-e / 4)) / (e / 2) - 20 * (f(e / 2) - f(-e / 2)) / e +
            (f(e) - f(-e)) / (2 * e)) /
           45;
  };
  const double by_offset = slope([&](double x) { return end(0.2 + x, 1.5); }, 1e-4),
               by_omega = slope([&](double x) { return end(0.2, 1.5 + x); }, 1e-4);
  EXPECT_NEAR(found.by[0], by_offset, 1e-6 * (1 + std::abs(by_offset)));
  EXPECT_NEAR(found.by[1], by_omega, 1e-6 * (1 + std::abs(by_omega)));
}

/// Within a longer step of one size no shorter one is taken through an impact.
TEST(TangentEvents, WithinAStepOfOneSizeAreRefused) {
  const hamel::Gradient within =
      bouncing_ball().tolerance({}).scheme("lift").step(0.2).until(1.2).gradient("z", {"start.z"});
  EXPECT_FALSE(within.status.ok);
  EXPECT_THAT(within.status.reason, testing::HasSubstr("an event within it changes the state"));
}

}  // namespace
