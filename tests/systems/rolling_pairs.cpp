// Balls that roll on, or inside, the sphere or cylinder of another body.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <hamel/hamel.hpp>

#include "../framework/run/refusal.hpp"

namespace hamel {
namespace {

using testing::HasSubstr;

constexpr double kGravity = 9.81, kBall = 0.1, kMass = 0.3;

std::vector<double> column(const Result& run, const std::string& name) {
  return run.trajectory.column(name);
}

// A ball of radius kBall at a place, in space, and a body that is welded to the world.
Mechanism ball_and_fixed(const Point& at, const BodyOptions& fixed, bool inside) {
  Mechanism m("pair");
  m.body("fixed", fixed);
  m.weld("mount", kWorld, "fixed");
  m.body("ball", {.mass = kMass, .at = at, .sphere = kBall});
  m.free("root", "ball", {.at = at});
  WheelOptions o{.at = at, .radius = kBall};
  (inside ? o.inside : o.on) = "fixed";
  m.ball("contact", "ball", o);
  return m;
}

Result exactly(const Mechanism& m, double until, const std::string& stop = "") {
  Config config;
  config.scheme = "dop853";
  config.rtol = 1e-12;
  config.until = until;
  config.output_step = until / 40;
  if (!stop.empty()) config.stop_at = {stop};
  return simulate(m).config(config).run();
}

// In a vertical cylinder the height is that of a harmonic motion: with I = k m r^2 and the ball's
// centre turning at w about the axis, z'''' = -k/(1 + k) w^2 z''; without spin about the normal at
// the start, z'' = -g/(1 + k) there. Source: Neimark and Fufaev (1972), ch. III; Routh, Advanced
// Rigid Dynamics (1905), art. 208.
TEST(RollingPairs, BallInACylinder) {
  const double radius = 0.5, apart = radius - kBall, w = 6, k = 0.4;
  Mechanism m =
      ball_and_fixed({apart, 0, 2}, {.mass = 0, .at = {0, 0, 1}, .cylinder = {radius, 4}}, true);
  m.start({{"v2", apart * w}, {"w3", -apart * w / kBall}});
  const Result run = exactly(m, 3);
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  const double rate = std::sqrt(k / (1 + k)) * w, size = kGravity / (1 + k) / (rate * rate);
  for (size_t i = 0; i < run.trajectory.rows(); ++i) {
    const double t = column(run, "t")[i];
    EXPECT_NEAR(column(run, "z")[i], 2 - size * (1 - std::cos(rate * t)), 1e-8);
    EXPECT_NEAR(column(run, "x")[i], apart * std::cos(w * t), 1e-8);
    EXPECT_NEAR(column(run, "y")[i], apart * std::sin(w * t), 1e-8);
    // The wall bears the weight of turning alone.
    EXPECT_NEAR(column(run, "contact.reaction3")[i], kMass * apart * w * w, 1e-7);
  }
}

// On a sphere, from an angle a0 at rest: a'^2 = 2 g/((1 + k) L) (cos a0 - cos a), L the distance of
// the centres, until N = m (g cos a - L a'^2) = 0, cos a = 2 cos a0/(3 + k).
TEST(RollingPairs, BallOnASphere) {
  const double radius = 0.7, apart = radius + kBall, k = 0.4, a0 = 0.3;
  for (const double heading : {0.0, 1.1}) {  // of its way down
    SCOPED_TRACE(heading);
    const Mechanism m =
        ball_and_fixed({apart * std::sin(a0) * std::cos(heading),
                        apart * std::sin(a0) * std::sin(heading), apart * std::cos(a0) + 1},
                       {.mass = 0, .at = {0, 0, 1}, .sphere = radius}, false);
    const Result run = exactly(m, 5, "contact.contact_lost");
    ASSERT_TRUE(run.status.ok) << run.status.reason;
    ASSERT_TRUE(run.stopped_by_event);
    EXPECT_NEAR((run.last.coordinates[11] - 1) / apart, 2 * std::cos(a0) / (3 + k), 1e-8);
    for (size_t i = 0; i < run.trajectory.rows(); ++i) {
      const double x = column(run, "x")[i], y = column(run, "y")[i], z = column(run, "z")[i] - 1;
      EXPECT_NEAR(x * x + y * y + z * z, apart * apart, 1e-10);
      EXPECT_NEAR(std::atan2(y, x), heading, 1e-8);
    }
  }
}

// In a bowl as on ground of that height, which is another formula.
TEST(RollingPairs, BallInABowlIsThatOnSuchGround) {
  const double radius = 0.8, apart = radius - kBall, a = 0.6;
  const Point at = {apart * std::sin(a), 0, radius - apart * std::cos(a)};
  const auto begin = [](Mechanism& m) { m.start({{"v2", 1.1}, {"w2", 2}, {"w3", -1.5}}); };
  Mechanism pair = ball_and_fixed(at, {.mass = 0, .at = {0, 0, radius}, .sphere = radius}, true);
  Mechanism ground("bowl");
  ground.body("ball", {.mass = kMass, .at = at, .sphere = kBall});
  ground.free("root", "ball", {.at = at});
  ground.ball("contact", "ball", {.at = at, .radius = kBall});
  ground.ground_height("R - sqrt(R^2 - x^2 - y^2)", {{"R", {radius}}});
  begin(pair);
  begin(ground);
  const Result one = exactly(pair, 2), other = exactly(ground, 2);
  ASSERT_TRUE(one.status.ok) << one.status.reason;
  ASSERT_TRUE(other.status.ok) << other.status.reason;
  for (const char* name : {"x", "y", "z", "v1", "v2", "v3", "w1", "w2", "w3", "contact.reaction3"})
    EXPECT_NEAR(column(one, name).back(), column(other, name).back(), 1e-7) << name;
}

// A loop through the top of a sphere, in the plane of the drawing: where directions of the contact
// would turn round if m0 lay in it.
TEST(RollingPairs, LoopsThroughTheTop) {
  const double radius = 0.5, apart = radius - kBall, k = 0.4, v = 6;
  Mechanism m =
      ball_and_fixed({0, 0, kBall}, {.mass = 0, .at = {0, 0, radius}, .sphere = radius}, true);
  m.start({{"v1", v}, {"w2", v / kBall}});
  const Result run = exactly(m, 2);
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  double highest = 0;
  for (size_t i = 0; i < run.trajectory.rows(); ++i) {
    highest = std::max(highest, column(run, "z")[i]);
    const double speed = std::hypot(column(run, "v1")[i], column(run, "v3")[i]);
    EXPECT_NEAR((1 + k) / 2 * (speed * speed - v * v) + kGravity * (column(run, "z")[i] - kBall), 0,
                1e-7);
    EXPECT_NEAR(column(run, "y")[i], 0, 1e-9);
  }
  EXPECT_GT(highest, 2 * apart);
}

// A ball in a shell that rolls on the ground: by every way to step it, with the work of no force.
TEST(RollingPairs, BallInARollingShell) {
  Mechanism m("shell");
  const double radius = 0.6;
  m.body("shell", {.mass = 2, .at = {0, 0, radius}, .inertia = {0.5, 0.5, 0.5}, .sphere = radius});
  m.body("ball", {.mass = kMass, .at = {0.3, 0, radius - 0.4}, .sphere = kBall});
  m.free("root", "shell", {.at = {0, 0, radius}});
  m.free("rolling", "ball", {.at = {0.3, 0, radius - 0.4}});
  m.ball("floor", "shell", {.at = {0, 0, radius}, .radius = radius});
  m.ball("inside", "ball", {.at = {0.3, 0, radius - 0.4}, .radius = kBall, .inside = "shell"});
  m.start({{"root.v1", 0.5}, {"rolling.v2", 0.7}});
  const Result reference = exactly(m, 2);
  ASSERT_TRUE(reference.status.ok) << reference.status.reason;
  EXPECT_LT(reference.energy_error_max, 1e-10);
  EXPECT_LT(reference.holonomic_max, 1e-9);
  for (const char* scheme : {"lift", "balance", "rkmk4"}) {
    SCOPED_TRACE(scheme);
    const auto by = [&](double h) { return simulate(m).scheme(scheme).step(h).until(2).run(); };
    const Result coarse = by(2e-3), fine = by(1e-3);
    ASSERT_TRUE(coarse.status.ok) << coarse.status.reason;
    ASSERT_TRUE(fine.status.ok) << fine.status.reason;
    const auto error = [&](const Result& run) {
      double out = 0;
      for (const char* name : {"root.x", "root.y", "rolling.x", "rolling.y", "rolling.z"})
        out = std::max(out, std::abs(column(run, name).back() - column(reference, name).back()));
      return out;
    };
    const double order = std::log2(error(coarse) / error(fine));
    EXPECT_GT(order, std::string(scheme) == "rkmk4" ? 3.7 : 1.9);
    EXPECT_LT(error(fine), 1e-4);
  }
}

TEST(RollingPairs, RefusesWhatDoesNotFit) {
  const auto said = [](const Point& at, const BodyOptions& fixed, const WheelOptions& ball,
                       const char* kind = "ball") {
    Mechanism m("pair");
    m.body("fixed", fixed);
    m.weld("mount", kWorld, "fixed");
    m.body("it", {.mass = kMass, .at = at, .sphere = kBall});
    m.free("root", "it", {.at = at});
    if (std::string(kind) == "ball") m.ball("contact", "it", ball);
    else m.wheel("contact", "it", ball);
    return refusal([&] { (void)m.model(); });
  };
  const BodyOptions sphere{.mass = 0, .at = {0, 0, 1}, .sphere = 0.5};
  const Point on = {0, 0, 1.6};
  EXPECT_THAT(said(on, sphere, {.at = on, .radius = kBall, .on = "fixt"}),
              HasSubstr("ball 'contact': unknown body 'fixt'"));
  EXPECT_THAT(said(on, {.mass = 0, .box = {1, 1, 1}}, {.at = on, .radius = kBall, .on = "fixed"}),
              HasSubstr("ball 'contact': on: expected a body with a sphere or a cylinder, got "
                        "'fixed'"));
  EXPECT_THAT(said({0, 0, 1.65}, sphere, {.at = {0, 0, 1.65}, .radius = kBall, .on = "fixed"}),
              HasSubstr("ball 'contact': does not touch 'fixed' as drawn: its gap is 0.05 m"));
  EXPECT_THAT(said(on, sphere, {.at = on, .radius = 0.6, .inside = "fixed"}),
              HasSubstr("inside: a ball of radius 0.6 m has no room in 'fixed', of radius 0.5 m"));
  EXPECT_THAT(said(on, sphere, {.at = on, .radius = kBall, .on = "fixed", .inside = "fixed"}),
              HasSubstr("expected one of on and inside"));
  EXPECT_THAT(said(on, sphere, {.at = on, .on = "fixed"}),
              HasSubstr("ball 'contact': radius: got 0, expected above 0"));
  EXPECT_THAT(said(on, sphere, {.at = on, .radius = kBall, .on = "it"}),
              HasSubstr("'it' and 'it' are one body"));
}

}  // namespace
}  // namespace hamel
