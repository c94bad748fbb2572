// A run ends, or says why not: rows that become dependent, forces that jump, tolerances below
// round-off, and numbers next to the limits of double.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>

#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Simulation of(const std::string& text) {
  return {registry(), "file", OwnSystem{data_system_maker(registry(), "file", text)}};
}

std::string pushed(double velocity, const std::string& force) {
  return fmt::format(
      "group = \"r1\"\ninertia = [1]\nforce = [\"{}\"]\nconfiguration = [0]\n"
      "velocity = [{}]\n",
      force, velocity);
}

/// A body at rest with a smooth push has an error estimate of 1e-200 before it: e^2 is no number.
TEST(TinyRates, DoNotDivideZeroByZero) {
  for (const char* scheme : {"dop853", "tsit5", "dopri5"}) {
    const Result r = of(pushed(0, "exp(-((t-5)/0.2)^2)"))
                         .scheme(scheme)
                         .until(10)
                         .with(&Config::rtol, std::optional<double>(1e-9))
                         .run();
    ASSERT_TRUE(r.status.ok) << scheme << ": " << r.status.reason;
    EXPECT_NEAR(r.last.velocity[0], 0.2 * std::sqrt(std::acos(-1)), 1e-8) << scheme;
  }
  const Result damped = of("group = \"r1\"\ninertia = [1]\npotential = \"0.5*x1^2\"\n"
                           "force = [\"-x1'\"]\nconfiguration = [1]\nvelocity = [0]\n")
                            .until(2000)
                            .run();
  EXPECT_TRUE(damped.status.ok) << damped.status.time << " " << damped.status.reason;
}

/// Rates from 1e-300 to 1e150, whose energy is a number, with every pair and both controls.
TEST(TinyRates, AndHugeOnesAreTakenByEveryPairAndControl) {
  // A reversible control measures no rate whose square is no number: steps of one size, order 2.
  for (const double rate : {1e-300, 1e-250, 1e-200, 1e-160, 1e-150, 1e-100, 1e100, 1e150}) {
    for (const auto& [scheme, off] : {std::pair{"dop853", 1e-6},
                                      {"tsit5", 1e-6},
                                      {"dopri5", 1e-6},
                                      {"lift", 3e-3},
                                      {"balance", 3e-3}}) {
      SCOPED_TRACE(fmt::format("{} at {}", scheme, rate));
      const double fast = std::max(1.0, rate);  // a metre is passed in so much less time
      const Result r = of(pushed(rate, fmt::format("-{}*x1'", 0.1 * fast)))
                           .scheme(scheme)
                           .until(3 / fast)
                           .with(&Config::rtol, std::optional<double>(1e-8))
                           .run();
      ASSERT_TRUE(r.status.ok) << r.status.reason;
      EXPECT_NEAR(r.last.velocity[0] / rate, std::exp(-0.3), off);
    }
  }
}

/// Energies beyond double end the run at once, with the reason.
TEST(TinyRates, BeyondDoubleAreAFailure) {
  for (const char* scheme : {"dop853", "tsit5", "dopri5", "lift"}) {
    const Result r = of(pushed(1e300, "-0.1*x1'")).scheme(scheme).until(3).run();
    EXPECT_FALSE(r.status.ok) << scheme;
    EXPECT_THAT(r.status.reason, HasSubstr("not finite")) << scheme;
  }
}

// A snake of `links` bodies with a blade each; all joints but the last links - 3 are prescribed, so
// that nothing but these rows decides the motion.
std::string snake(int links, double phase, double amplitude) {
  std::string body, joint, blade, prescribed;
  for (int i = 0; i < links; ++i) {
    const double x = -0.4 * i;
    body += fmt::format(
        "{{ name = \"b{}\", mass = 1, at = [{}, 0, 0.05], box = [0.3, 0.06, 0.05] }},", i, x);
    blade += fmt::format("{{ name = \"k{0}\", body = \"b{0}\", at = [{1}, 0, 0] }},", i, x);
    if (i == 0) continue;
    joint += fmt::format(
        "{{ name = \"j{0}\", kind = \"hinge\", parent = \"b{1}\", child = \"b{0}\", at = [{2}, 0, "
        "0.05] }},",
        i, i - 1, x + 0.2);
    if (i <= 2)
      prescribed += fmt::format("{{ joint = \"j{}\", angle = \"{}+{}*sin(2*t - {})\" }},", i,
                                i == 1 ? 0.2 : 0.0, amplitude, i == 1 ? 0.0 : phase);
  }
  return fmt::format(
      "body = [{}]\njoint = [{{ name = \"floor\", kind = \"planar\", child = \"b0\" }}, {}]\n"
      "blade = [{}]\nprescribed = [{}]\n",
      body, joint, blade, prescribed);
}

/// The first three axles meet in one point, or are parallel, where the rows of a snake are
/// dependent: with axles at x_i, y_i in the directions theta_i
///   det [cos(theta_i), sin(theta_i), l_i] = 0
/// over the three blades, found here by bisection from the prescribed angles.
double singular_time(double phase, double amplitude, double until) {
  const auto determinant = [&](double t) {
    const double a = 0.2 + amplitude * std::sin(2 * t), b = amplitude * std::sin(2 * t - phase);
    const double theta[] = {0, a, a + b};
    double x = 0, y = 0, rows[3][3];
    for (int i = 0; i < 3; ++i) {
      if (i > 0) {
        x -= 0.2 * (std::cos(theta[i - 1]) + std::cos(theta[i]));
        y -= 0.2 * (std::sin(theta[i - 1]) + std::sin(theta[i]));
      }
      // -sin v_x + cos v_y of the blade's centre: (x, y) turns with omega.
      rows[i][0] = -std::sin(theta[i]);
      rows[i][1] = std::cos(theta[i]);
      rows[i][2] = x * std::cos(theta[i]) + y * std::sin(theta[i]);
    }
    return rows[0][0] * (rows[1][1] * rows[2][2] - rows[1][2] * rows[2][1]) -
           rows[0][1] * (rows[1][0] * rows[2][2] - rows[1][2] * rows[2][0]) +
           rows[0][2] * (rows[1][0] * rows[2][1] - rows[1][1] * rows[2][0]);
  };
  const double step = 1e-3;
  for (double t = 0; t < until; t += step) {
    if (determinant(t) * determinant(t + step) > 0) continue;
    double low = t, high = t + step;
    for (int k = 0; k < 60; ++k) {
      const double middle = (low + high) / 2;
      (determinant(low) * determinant(middle) <= 0 ? high : low) = middle;
    }
    return low;
  }
  return until;
}

TEST(RunEnds, WhereTheRowsOfASnakeBecomeDependent) {
  const std::string file = snake(3, 1.5, 0.6);
  const double at = singular_time(1.5, 0.6, 3);
  ASSERT_LT(at, 3);
  const Result chosen = of(file).until(3).run();
  EXPECT_FALSE(chosen.status.ok);
  EXPECT_THAT(chosen.status.reason, AllOf(HasSubstr("dependent"), HasSubstr("k1")));
  EXPECT_NEAR(chosen.status.time, at, 0.01);
  EXPECT_LT(chosen.steps, 20000);
  const Result fixed = of(file).scheme("lift").step(0.001).until(3).run();
  EXPECT_FALSE(fixed.status.ok);
  EXPECT_THAT(fixed.status.reason, HasSubstr("the rows become dependent between"));
  EXPECT_NEAR(fixed.status.time, at, 0.0011);
  EXPECT_LE(fixed.last.time, at);
  EXPECT_GT(fixed.trajectory.rows(), 0.9 * at / 0.001);
}

/// Snakes of three to six links at random phases: every run by either method ends at the singular
/// shape of its first three links, or where there is none, at its end.
TEST(RunEnds, SnakesThroughTheirSingularShapes) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> phase(0.3, 3), amplitude(0.2, 0.6);
  int singular = 0;
  for (int trial = 0; trial < 8; ++trial) {
    const int links = 3 + trial % 4;
    const double p = phase(random), a = amplitude(random);
    const std::string file = snake(links, p, a);
    const double at = singular_time(p, a, 2);
    for (const bool chosen : {true, false}) {
      SCOPED_TRACE(fmt::format("{} links, phase {}, amplitude {}, {}", links, p, a, at));
      Simulation run = of(file);
      if (!chosen) run.scheme("lift").step(0.001);
      const Result r = run.until(2).run();
      if (at < 2) {
        EXPECT_FALSE(r.status.ok);
        EXPECT_THAT(r.status.reason, HasSubstr("dependent"));
        EXPECT_LE(r.last.time, at + 1e-9);
        singular += chosen ? 1 : 0;
      } else {
        EXPECT_TRUE(r.status.ok) << r.status.reason;
      }
    }
  }
  EXPECT_GE(singular, 3);
}

TEST(RunEnds, WhereAForceJumps) {
  const Result r = of("group = \"r1\"\ninertia = [1]\nforce = [\"-2*sign(x1')\"]\nvelocity = [1]\n")
                       .until(10)
                       .run();
  EXPECT_FALSE(r.status.ok);
  EXPECT_THAT(r.status.reason, AllOf(HasSubstr("force"), HasSubstr("jumps by 4"),
                                     HasSubstr("-2*sign(x1')"), HasSubstr("t = 0.5")));
  EXPECT_NEAR(r.status.time, 0.5, 0.01);
  EXPECT_LT(r.steps, 20000);
}

std::string chain(int links) {
  std::string body, joint;
  for (int i = 0; i < links; ++i) {
    body += fmt::format(
        "{{ name = \"b{}\", mass = 1, at = [{}, 0, 0], inertia = [1e-3, 1e-3, 1e-3] }},", i,
        0.05 + 0.1 * i);
    joint += fmt::format(
        "{{ name = \"j{0}\", kind = \"hinge\", {1}child = \"b{0}\", at = [{2}, 0, 0], "
        "axis = [0, 1, 0] }},",
        i, i > 0 ? fmt::format("parent = \"b{}\", ", i - 1) : "", 0.1 * i);
  }
  return fmt::format("body = [{}]\njoint = [{}]\n", body, joint);
}

/// A chain that falls: its equations are known to 1e-9, and with a tolerance below that steps
/// shrink to a thousandth, of a second as of a minute. Its energy, 0, is no measure of its error.
TEST(RunEnds, WhereTheToleranceIsBelowTheRoundOffOfAChain) {
  const auto falls = [](double rtol, double until) {
    return of(chain(100)).with(&Config::rtol, std::optional<double>(rtol)).until(until).run();
  };
  for (const double until : {1.0, 60.0}) {
    const Result r = falls(1e-10, until);
    EXPECT_FALSE(r.status.ok);
    EXPECT_LT(r.steps, 3000);
    EXPECT_THAT(r.status.reason, HasSubstr("rtol = 1e-10 is below the round-off"));
    for (const std::string& note : r.notes) EXPECT_THAT(note, Not(HasSubstr("energy changes")));
  }
  EXPECT_TRUE(falls(1e-8, 0.1).status.ok);
}

/// Long or stiff runs, whose steps are small from their start, go to their ends; so do those that
/// become stiff.
TEST(RunEnds, NotWhereStepsAreSmallFromTheStart) {
  const Result stiff = of("group = \"r1\"\ninertia = [1]\nforce = [\"-1e5*x1'\"]\nvelocity = [1]\n")
                           .scheme("dopri5")
                           .with(&Config::rtol, std::optional<double>(1e-6))
                           .until(1)
                           .run();
  EXPECT_TRUE(stiff.status.ok) << stiff.status.reason;
  const Result spring = of("group = \"r1\"\ninertia = [1]\npotential = \"0.5*x1^2\"\nconfiguration "
                           "= [1]\nvelocity = [0]\n")
                            .scheme("dopri5")
                            .with(&Config::rtol, std::optional<double>(1e-10))
                            .every(1000000)
                            .until(1e5)
                            .run();
  EXPECT_TRUE(spring.status.ok) << spring.status.reason;
  const Result relaxes =
      of("group = \"r1\"\ninertia = [1]\nforce = [\"1000*(1 - x1^2)*x1' - x1\"]\n"
         "configuration = [1e-6]\nvelocity = [0]\n")
          .scheme("dopri5")
          .with(&Config::rtol, std::optional<double>(1e-10))
          .every(1000000)
          .until(30)
          .run();
  EXPECT_TRUE(relaxes.status.ok) << relaxes.status.reason;
  EXPECT_GT(spring.steps, 1000000);
}

TEST(RunEnds, AtTheMostSteps) {
  for (const bool chosen : {true, false}) {
    Simulation run = simulate("suslov");
    if (!chosen) run.scheme("lift").step(0.01);
    const Result r = run.with(&Config::steps_max, 20L).until(100).run();
    EXPECT_FALSE(r.status.ok);
    EXPECT_EQ(r.status.reason, "steps_max = 20 steps are taken");
    EXPECT_EQ(r.steps, 20);
  }
  hamel::Run by_hand =
      simulate("suslov").scheme("lift").step(0.01).with(&Config::steps_max, 20L).build();
  EXPECT_TRUE(by_hand.step(19).ok);
  EXPECT_FALSE(by_hand.step(5).ok);
  EXPECT_NEAR(by_hand.time(), 0.2, 1e-12);
}

}  // namespace
}  // namespace hamel
