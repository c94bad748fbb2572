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
  m.state("clock", {.rate = "1", .unit = "s"});
  m.wall("table", {.distance = "up.position - a*sin(w*clock)",
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

}  // namespace
}  // namespace hamel
