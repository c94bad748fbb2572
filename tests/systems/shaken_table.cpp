// A ball that bounces on a table A sin(W t), a wall that moves: it strikes once a period from
// G = A W^2/g = pi (1 - e)/(1 + e) on, at the phase with G cos = that, until at
// G^2 = (pi (1 - e)/(1 + e))^2 + (2 (1 + e^2)/(1 + e)^2)^2 the period doubles.
// Source: Holmes, The dynamics of repeated impacts with a sinusoidally vibrating table, J. Sound
// Vib. 84 (1982).
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

constexpr double kGravity = 9.81, kRate = 10, kRestitution = 0.8;
const double kLeast = M_PI * (1 - kRestitution) / (1 + kRestitution);

// In flight at t = 0, next to the motion that strikes once a period.
Mechanism ball(double shake) {
  const double phase = std::acos(kLeast / shake), a = shake * kGravity / (kRate * kRate);
  const double flies = (2 * M_PI - phase) / kRate, leaves = kGravity * M_PI / kRate;
  Mechanism m("ball");
  m.body("ball", {.mass = 0.1, .at = {0, 0, 0}, .sphere = 0.02});
  m.slider("up", kWorld, "ball", {.axis = {0, 0, 1}});
  m.wall("table", {.distance = "up.position - a*sin(w*t)",
                   .restitution = kRestitution,
                   .constants = {{"a", {a}}, {"w", {kRate}}}});
  m.start(
      {{"up.position", a * std::sin(phase) + leaves * flies - kGravity / 2 * flies * flies + 1e-4},
       {"up.rate", leaves - kGravity * flies}});
  return m;
}

// Times between strikes in periods of the table.
std::vector<double> strikes(double shake, double until, std::vector<double>& times) {
  const Result r = simulate(ball(shake)).tolerance({.relative = 1e-11}).slip().until(until).run();
  EXPECT_TRUE(r.status.ok) << r.status.reason;
  times.clear();
  for (const EventMet& e : r.events)
    if (e.name == "table.strikes") times.push_back(e.time);
  std::vector<double> out;
  for (size_t i = 1; i < times.size(); ++i)
    out.push_back((times[i] - times[i - 1]) * kRate / (2 * M_PI));
  return out;
}

TEST(ShakenTable, TheBallStrikesOnceAPeriod) {
  std::vector<double> times;
  const std::vector<double> between = strikes(0.6, 60, times);
  ASSERT_GT(between.size(), 80u);
  EXPECT_NEAR(between.back(), 1, 1e-8);
  EXPECT_NEAR(std::remainder(kRate * times.back() - std::acos(kLeast / 0.6), 2 * M_PI), 0, 1e-8);
}

TEST(ShakenTable, ThePeriodDoubles) {
  const double e = kRestitution;
  const double doubles = std::hypot(kLeast, 2 * (1 + e * e) / ((1 + e) * (1 + e)));
  EXPECT_NEAR(kLeast, 0.349065850399, 1e-12);
  EXPECT_NEAR(doubles, 1.070836468248, 1e-12);
  std::vector<double> times;
  const auto uneven = [&](double shake) {
    const std::vector<double> between = strikes(shake, 100, times);
    EXPECT_GT(between.size(), 100u);
    return std::abs(between.back() - between[between.size() - 2]);
  };
  EXPECT_LT(uneven(0.97 * doubles), 1e-4);
  EXPECT_GT(uneven(1.03 * doubles), 1e-2);
}

// The floor is at 1 + (t - 2) and rises at 1 m/s; a ball falls on it from 2 at t = 2.
Mechanism over_rising_floor() {
  Mechanism m("ball");
  m.body("ball", {.mass = 0.1, .at = {0, 0, 0}, .sphere = 0.02});
  m.slider("up", kWorld, "ball", {.axis = {0, 0, 1}});
  m.wall("floor", {.distance = "up.position - 1 - (t - 2)", .restitution = 1});
  m.start({{"up.position", 2}});
  return m;
}

TEST(RisingFloor, IsWhereItIsAtTheTimeOfTheStart) {
  const Result r =
      simulate(over_rising_floor()).from(2).until(2.6).tolerance({.relative = 1e-11}).slip().run();
  EXPECT_TRUE(r.status.ok) << r.status.reason;
  const double fell = (std::sqrt(1 + 2 * kGravity) - 1) / kGravity, rose = 0.6 - fell;
  ASSERT_EQ(r.events.size(), 1u);
  EXPECT_NEAR(r.events[0].time, 2 + fell, 1e-9);
  EXPECT_NEAR(r.trajectory.column("up.position").back(),
              1 + fell + (2 + kGravity * fell) * rose - kGravity / 2 * rose * rose, 1e-9);
  EXPECT_NEAR(r.trajectory.column("clock").back(), 2.6, 1e-12);
}

TEST(RisingFloor, AClockThatShowsAnotherTimeIsRefused) {
  try {
    simulate(over_rising_floor()).from(2).start({.configuration = {2, 0}}).until(3).slip().run();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("clock is prescribed as 2 at t = 2, but 0"),
              std::string::npos)
        << error.what();
  }
}

// A coupling with t holds a joint as [[prescribed]] does, and a state integrates a function of t.
TEST(RisingFloor, CouplingsAndStatesMayHaveTheTime) {
  const auto swing = [](bool by_coupling) {
    Mechanism m("arm");
    m.body("arm", {.mass = 1, .at = {0.3, 0, 0}, .inertia = {0.01, 0.02, 0.03}});
    m.body("bob", {.mass = 0.5, .at = {0.7, 0, 0}, .inertia = {0.001, 0.002, 0.003}});
    m.hinge("shoulder", kWorld, "arm", {.axis = {0, 1, 0}});
    m.hinge("elbow", "arm", "bob", {.at = {0.6, 0, 0}, .axis = {0, 1, 0}});
    if (by_coupling) m.coupling("driven", {.formula = "shoulder.angle - 0.4*sin(3*t)"});
    else
      m.prescribe(
          "shoulder", [](double t) { return 1.2 * std::cos(3 * t); },
          [](double t) { return 0.4 * std::sin(3 * t); });
    m.state("sum", {.rate = "t^2"});
    m.start({{"elbow.angle", 0.5}});
    return simulate(m).until(2).tolerance({.relative = 1e-11}).run();
  };
  const Result coupled = swing(true), prescribed = swing(false);
  EXPECT_TRUE(coupled.status.ok) << coupled.status.reason;
  EXPECT_NEAR(coupled.trajectory.column("elbow.angle").back(),
              prescribed.trajectory.column("elbow.angle").back(), 1e-8);
  EXPECT_NEAR(coupled.trajectory.column("shoulder.angle").back(), 0.4 * std::sin(6.0), 1e-9);
  EXPECT_NEAR(coupled.trajectory.column("sum").back(), 8.0 / 3, 1e-9);
}

}  // namespace
}  // namespace hamel
