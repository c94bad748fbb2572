// Contacts on ground that is a formula: tilted planes, troughs, hills.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <hamel/hamel.hpp>

#include "../framework/run/refusal.hpp"

namespace hamel {
namespace {

using testing::HasSubstr;

std::vector<double> column(const Result& run, const std::string& name) {
  return run.trajectory.column(name);
}

Config exactly(double until) {
  Config config;
  config.scheme = "dop853";
  config.rtol = 1e-12;
  config.until = until;
  config.output_step = until / 20;
  return config;
}

// A rigid body on one contact, by a free joint at its mass centre.
Mechanism on_ground(const std::string& kind, double radius, const Parameters& values) {
  Mechanism m("body");
  m.body("body", {.mass = 2, .at = {0, 0, radius}, .inertia = {0.05, 0.07, 0.04}});
  m.free("root", "body", {.at = {0, 0, radius}});
  m.contact(kind, "contact", "body", {{0, 0, radius}, values});
  m.sensor("centre", "body", {0, 0, radius});
  return m;
}
Mechanism ball(double radius) {
  Mechanism m("ball");
  m.body("ball", {.mass = 2, .at = {0, 0, radius}, .sphere = radius});
  m.free("root", "ball", {.at = {0, 0, radius}});
  m.ball("contact", "ball", {.at = {0, 0, radius}, .radius = radius});
  m.sensor("centre", "ball", {0, 0, radius});
  return m;
}

// Down a plane that falls by 0.2 along x, as with gravity that is turned: 5/7 g sin(slope).
TEST(UnevenGround, BallOnATiltedPlane) {
  Mechanism m = ball(0.1);
  m.ground_height("1 - 0.2*x + a", {{"a", {0.5}}});
  const Result run = simulate(m).config(exactly(2)).run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  const double slope = std::atan(0.2), a = 5.0 / 7 * 9.81 * std::sin(slope);
  for (size_t i = 0; i < run.trajectory.rows(); ++i) {
    const double t = column(run, "t")[i];
    EXPECT_NEAR(std::hypot(column(run, "centre.vx")[i], column(run, "centre.vz")[i]), a * t, 1e-9);
    EXPECT_NEAR(column(run, "centre.z")[i] - 1.5 + 0.2 * column(run, "centre.x")[i],
                0.1 / std::cos(slope), 1e-11);
  }
}

// Bodies of every kind on the tilted plane against the same bodies on level ground, all that is
// stated turned by the slope.
TEST(UnevenGround, TiltedPlaneIsTurnedGravity) {
  const double slope = 0.15, c = std::cos(slope), s = std::sin(slope);
  const Parameters axle = {{"axle", {0, 1, 0}}, {"radius", {0.3}}};
  Parameters crown = axle;
  crown["crown"] = {0.1};
  const std::vector<std::pair<std::string, Parameters>> kinds = {
      {"wheel", axle}, {"tube", crown}, {"ellipsoid", {{"semi_axes", {0.4, 0.35, 0.3}}}}};
  for (const auto& [kind, values] : kinds) {
    SCOPED_TRACE(kind);
    Mechanism level = on_ground(kind, 0.3, values), tilted = level;
    level.gravity({9.81 * s, 0, -9.81 * c});
    tilted.ground_height("-k*x", {{"k", {std::tan(slope)}}});
    Start start;
    const double lean = 0.2, cl = std::cos(lean), sl = std::sin(lean);
    const auto turned = [&](const Mat<3, 3>& r, const Vec<3>& x) {
      Start out;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) out.configuration.push_back(r(i, j));
      for (int i = 0; i < 3; ++i) out.configuration.push_back(x[i]);
      out.velocity = {0.1, 3, 0.2, 0, 0, 0};
      return out;
    };
    const Mat<3, 3> leaning{{1, 0, 0}, {0, cl, -sl}, {0, sl, cl}},
        down{{c, 0, s}, {0, 1, 0}, {-s, 0, c}};
    // The height of the centre over level ground, which the start finds.
    const Result found =
        simulate(level).config(exactly(1e-3)).start(turned(leaning, {0, 0, 0.3})).run();
    ASSERT_TRUE(found.status.ok) << found.status.reason;
    const auto at = [](const Result& run, size_t row, const std::string& sensor) {
      return Vec<3>(column(run, sensor + "x")[row], column(run, sensor + "y")[row],
                    column(run, sensor + "z")[row]);
    };
    const Vec<3> centre = at(found, 0, "centre.");
    const Result a = simulate(level).config(exactly(0.5)).start(turned(leaning, centre)).run(),
                 b = simulate(tilted)
                         .config(exactly(0.5))
                         .start(turned(down * leaning, down * centre))
                         .run();
    ASSERT_TRUE(a.status.ok && b.status.ok) << a.status.reason << b.status.reason;
    ASSERT_EQ(a.trajectory.rows(), b.trajectory.rows());
    for (size_t row = 0; row < a.trajectory.rows(); ++row) {
      EXPECT_LT((down * at(a, row, "centre.") - at(b, row, "centre.")).norm(), 1e-8);
      EXPECT_LT((down * at(a, row, "centre.v") - at(b, row, "centre.v")).norm(), 1e-8);
      EXPECT_NEAR(column(a, "contact.reaction3")[row], column(b, "contact.reaction3")[row], 1e-6);
    }
  }
}

// In a round trough the centre moves on a circle across it, and the energy is kept.
TEST(UnevenGround, BallInATrough) {
  const double r = 0.1, big = 0.5, along = 0.8;
  Mechanism m = ball(r);
  m.ground_height("R - sqrt(R^2 - y^2)", {{"R", {big}}});
  m.start({{"y", 0.25}, {"z", big - std::sqrt(std::pow(big - r, 2) - 0.25 * 0.25)}, {"v1", along}});
  for (const char* scheme : {"dop853", "lift"}) {
    Config config = exactly(2);
    config.scheme = scheme;
    if (config.scheme == "lift") config.rtol.reset(), config.step = 1e-3;
    const Result run = simulate(m).config(config).run();
    ASSERT_TRUE(run.status.ok) << run.status.reason;
    const double near = config.scheme == "lift" ? 1e-4 : 1e-9;
    bool crossed = false;
    for (size_t i = 0; i < run.trajectory.rows(); ++i) {
      const double y = column(run, "centre.y")[i], z = column(run, "centre.z")[i];
      EXPECT_NEAR(std::hypot(y, big - z), big - r, 1e-10) << scheme;
      crossed |= y < 0;
      EXPECT_NEAR(column(run, "energy")[i], column(run, "energy")[0], near) << scheme;
    }
    EXPECT_TRUE(crossed);
  }
}

// Across the trough alone: 7/5 (R - r) phi'' = -g sin phi, whose speed at phi follows from energy.
TEST(UnevenGround, BallSwingsAcrossATrough) {
  const double r = 0.1, big = 0.5;
  Mechanism m = ball(r);
  m.ground_height("R - sqrt(R^2 - y^2)", {{"R", {big}}});
  m.start({{"y", 0.25}, {"z", big - std::sqrt(std::pow(big - r, 2) - 0.25 * 0.25)}});
  const Result run = simulate(m).config(exactly(2)).run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  const double top = column(run, "centre.z").front();
  for (size_t i = 0; i < run.trajectory.rows(); ++i) {
    const double fall = top - column(run, "centre.z")[i];
    const double square =
        std::pow(column(run, "centre.vy")[i], 2) + std::pow(column(run, "centre.vz")[i], 2);
    EXPECT_NEAR(square, 10.0 / 7 * 9.81 * fall, 1e-8);
    EXPECT_NEAR(column(run, "centre.x")[i], 0, 1e-10);
  }
}

TEST(UnevenGround, MistakesAreNamed) {
  const auto refused = [](const std::string& height, double radius = 0.1) {
    return refusal([&] {
      Mechanism m = ball(radius);
      m.ground_height(height);
      m.model();
    });
  };
  EXPECT_THAT(refused("20*x^2"), HasSubstr("ball 'contact': the ground below"));
  EXPECT_THAT(refused("2*x^2"), HasSubstr("accepted"));
  EXPECT_THAT(refused("sqrt(x - 5)"), HasSubstr("ball 'contact': the ground below"));
  EXPECT_THAT(refused("0.1*z"), HasSubstr("ground '0.1*z': height: "));
  EXPECT_THAT(refused("x > 0 ? 1 : 0"), HasSubstr("cannot jump"));
  Mechanism m = ball(0.1);
  m.ground_height("0.1*x");
  m.ground(0.3);
  EXPECT_THAT(refusal([&] { m.model(); }), HasSubstr("expected a ground at rest"));
}

}  // namespace
}  // namespace hamel
