// Random chains of hinges and sliders with dry friction, stops, springs and motors: each run
// against that in steps of one size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "slipping.hpp"

namespace hamel {
namespace {

using namespace test;

// One to three links, planar or in space; some joints have no friction.
Mechanism random_chain(unsigned seed) {
  std::mt19937 engine(seed);
  const auto random = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  Mechanism m("chain");
  const int links = 1 + static_cast<int>(random(0, 3));
  const bool space = random(0, 1) < 0.4, stops = random(0, 1) < 0.5;
  std::string parent = kWorld;
  Point at = {0, 0, 2};
  for (int i = 0; i < links; ++i) {
    const std::string name = fmt::format("link{}", i + 1), joint = fmt::format("joint{}", i + 1);
    const double length = random(0.3, 0.6), mass = random(0.5, 3), angle = random(-1.5, 1.5);
    const Point end = {at[0] + length * std::sin(angle), at[1] + (space ? random(-0.2, 0.2) : 0),
                       at[2] - length * std::cos(angle)};
    const double moment = mass * length * length;
    m.body(name, {.mass = mass,
                  .at = {(at[0] + end[0]) / 2, (at[1] + end[1]) / 2, (at[2] + end[2]) / 2},
                  .inertia = {moment / 10, moment / 12, moment / 20}});
    JointOptions options = {.at = at, .axis = {0, 1, 0}};
    if (space && random(0, 1) < 0.5) options.axis = {random(-1, 1), random(0.5, 1), random(-1, 1)};
    if (i == 0 || random(0, 1) < 0.8) options.friction = random(0.05, 3);
    if (stops && random(0, 1) < 0.6) {
      options.stop = {-random(0.05, 1.5), random(0.05, 1.5)};
      options.restitution = random(0, 1) < 0.5 ? 0 : random(0.1, 0.7);
    }
    if (random(0, 1) < 0.3) options.stiffness = random(1, 30);
    if (random(0, 1) < 0.25) {
      options.axis = {random(-1, 1), space ? random(-1, 1) : 0, random(-0.5, 0.5)};
      m.slider(joint, parent, name, options);
    } else {
      m.hinge(joint, parent, name, options);
    }
    if (random(0, 1) < 0.6) {
      const double size = random(0.5, 8), rate = random(1, 8), phase = random(0, 6);
      m.motor(joint, [=](const SignalInput& now) { return size * std::sin(rate * now.t + phase); });
    }
    if (random(0, 1) < 0.6) m.start(joint + ".rate", random(-3, 3));
    parent = name;
    at = end;
  }
  return m;
}

TEST(StickingChains, MoveAsInStepsOfOneSize) {
  int compared = 0, switches = 0, ended = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const Mechanism m = random_chain(seed);
    const double until = 1.5;
    const Result exact = slipping(m).until(until).run();
    const Result steps = simulate(m).slip().scheme("nonsmooth").step(2e-4).until(until).run();
    ASSERT_TRUE(steps.status.ok) << steps.status.reason;  // a problem with a solution always
    if (!exact.status.ok) {
      EXPECT_THAT(exact.status.reason, testing::AnyOf(testing::StartsWith("simultaneous_impacts"),
                                                      testing::StartsWith("sticks_and_slips")));
      ++ended;
      continue;
    }
    EXPECT_LT(exact.energy_error_max, 1e-7);
    ++compared;
    switches += static_cast<int>(exact.events.size());
    double size = 0.1;
    for (const double v : exact.last.velocity) size = std::max(size, std::abs(v));
    for (size_t j = 0; j < exact.last.velocity.size(); ++j)
      EXPECT_NEAR(exact.last.velocity[j], steps.last.velocity[j], 2e-2 * size) << j;
  }
  EXPECT_LE(ended, 4);
  EXPECT_GE(compared, 36);
  EXPECT_GE(switches, 200);
}

}  // namespace
}  // namespace hamel
