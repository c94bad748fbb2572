// Mechanisms with friction at contacts, against closed facts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "../framework/run/refusal.hpp"
#include "slipping.hpp"

namespace hamel {
namespace {

using namespace test;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

// One point below the mass centre: it stops after v0/(mu g) behind v0^2/(2 mu g), and rests.
TEST(SlippingBlock, SlidesAndStops) {
  Mechanism m("block");
  m.body("block", {.mass = 2, .at = {0, 0, 0.1}, .box = {0.2, 0.2, 0.2}});
  m.planar("floor", "block");
  m.point("skid", "block", {.friction = 0.3});
  m.start({{"v1", 3}, {"v2", 4}});
  m.sensor("eye", "block", {0, 0, 0.1});
  const Result r = slipping(m).until(3).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_THAT(r.system->notes, Contains(HasSubstr("point 'skid' 19.62 N")));
  ASSERT_THAT(names(r), ElementsAre("skid.rolls"));
  EXPECT_NEAR(time_of(r, "skid.rolls"), 5 / (0.3 * kGravity), 1e-11);
  const double way = 25 / (2 * 0.3 * kGravity);
  EXPECT_NEAR(last(r, "x"), 0.6 * way, 1e-10);
  EXPECT_NEAR(last(r, "y"), 0.8 * way, 1e-10);
  EXPECT_LT(std::hypot(last(r, "v1"), last(r, "v2")), 1e-14);
  EXPECT_NEAR(r.trajectory.column("eye.ax").front(), -0.6 * 0.3 * kGravity, 1e-12);
  EXPECT_NEAR(r.trajectory.column("eye.ay")[5], -0.8 * 0.3 * kGravity, 1e-12);
  EXPECT_NEAR(last(r, "eye.ax"), 0, 1e-12);
  EXPECT_NEAR(last(r, "eye.path"), way, 1e-9);
  EXPECT_LT(r.steps, 60);
}

// 2 kg on a foot of friction 0.3 and 0.5, pushed along x.
Mechanism pushed_block(const Signal& push, bool time_dependent) {
  const Signal none = [](const SignalInput&) { return 0.0; };
  Mechanism m("block");
  m.body("block", {.mass = 2, .at = {0, 0, 0.1}, .box = {0.2, 0.2, 0.2}});
  m.planar("floor", "block");
  m.point("skid", "block", {.friction = 0.3, .static_friction = 0.5});
  m.force("push", "block",
          {.at = {0, 0, 0.1}, .along = {push, none, none}, .time_dependent = time_dependent});
  return m;
}

// Pushed by F = 10 t it holds up to 0.5 m g, and slides with 0.3: m v' = 10 t - 0.3 m g.
TEST(SlippingBlock, HoldsByStaticFriction) {
  const Mechanism m = pushed_block([](const SignalInput& in) { return 10 * in.t; }, true);
  const Result r = slipping(m).until(2).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  const double begins = 0.5 * 2 * kGravity / 10;
  ASSERT_THAT(names(r), ElementsAre("skid.slides"));
  EXPECT_NEAR(time_of(r, "skid.slides"), begins, 1e-12);
  EXPECT_NEAR(last(r, "v1"), 2.5 * (4 - begins * begins) - 0.3 * kGravity * (2 - begins), 1e-9);
}

// A force between both coefficients holds a block at rest, and does not stop one that slides.
TEST(SlippingBlock, RestsBetweenBothCoefficients) {
  for (const double speed : {0.0, 1.0}) {
    Mechanism m = pushed_block([](const SignalInput&) { return 0.4 * 2 * kGravity; }, false);
    m.start("v1", speed);
    const Result r = slipping(m).until(1).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    EXPECT_TRUE(r.events.empty());
    EXPECT_NEAR(last(r, "v1"), speed > 0 ? speed + 0.1 * kGravity : 0, 1e-9);
  }
}

// Garwin's ball: e = e_t = 1 turns the slip of its contact round, and keeps the energy; with
// k = 2/5 and the slip s the velocity changes by -2 s k/(1 + k).
TEST(SlippingBall, BouncesBackBesides) {
  const double radius = 0.1;
  Mechanism m("ball");
  m.body("ball", {.mass = 1, .at = {0, 0, 1 + radius}, .sphere = radius});
  m.free("space", "ball", {.at = {0, 0, 1 + radius}});
  m.ball("contact", "ball",
         {.at = {0, 0, 1 + radius},
          .radius = radius,
          .friction = 10,
          .restitution = 1,
          .tangential_restitution = 1});
  const Result r = slipping(m).start({.velocity = {0, 0, 0, 0.5, 0, 0}}).until(0.6).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("contact.strikes"));
  EXPECT_NEAR(r.events[0].velocity_after[3], 0.5 - 2 * 0.5 * 0.4 / 1.4, 1e-12);
  EXPECT_LT(r.energy_error_max, 1e-9);
}

// The same ball by parts and by hand.
TEST(SlippingBall, ByPartsAsByHand) {
  const double radius = 0.03;
  Mechanism m("ball");
  m.body("ball", {.mass = 1, .at = {0, 0, radius}, .sphere = radius});
  m.free("space", "ball", {.at = {0, 0, radius}});
  m.ball("contact", "ball",
         {.at = {0, 0, radius}, .radius = radius, .friction = 0.2, .restitution = 0.5});
  const std::vector<double> velocity = {40, -60, 7, 2, 0, 0};
  const Result parts = slipping(m).start({.velocity = velocity}).until(1).run();
  const Result hand =
      simulate("rolling_ball")
          .set("radius", radius)
          .set("inertia", 0.4 * radius * radius)
          .set("friction", 0.2)
          .set("restitution", 0.5)
          .tolerance({.relative = 1e-10})
          .slip()
          .start({.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, radius}, .velocity = velocity})
          .until(1)
          .run();
  ASSERT_TRUE(parts.status.ok) << parts.status.reason;
  ASSERT_EQ(names(parts), names(hand));
  EXPECT_NEAR(time_of(parts, "contact.rolls"), 0.5803075242513841, 1e-9);
  for (const char* name : {"x", "y", "z"})
    EXPECT_NEAR(last(parts, name) - (std::string(name) == "z" ? last(parts, name) : 0),
                std::string(name) == "z" ? 0 : last(hand, name), 1e-9);
  EXPECT_LT(parts.energy_error_max, 1e-9);
}

// A wheel that is let fall and bounces.
TEST(SlippingBall, StrikesByParts) {
  Mechanism m("ball");
  m.body("ball", {.mass = 1, .at = {0, 0, 1.1}, .sphere = 0.1});
  m.free("space", "ball", {.at = {0, 0, 1.1}});
  m.ball("contact", "ball",
         {.at = {0, 0, 1.1}, .radius = 0.1, .friction = 0.2, .restitution = 0.5});
  const Result r = slipping(m).until(1).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_FALSE(r.events.empty());
  EXPECT_EQ(r.events[0].name, "contact.strikes");
  EXPECT_NEAR(r.events[0].time, std::sqrt(2 / kGravity), 1e-13);
}

// With the mass centre c behind the front axle, N_r = m g c/w, the turning
// about the front axle is J omega' = (m c V - mu N_r w^2/V) omega: it grows above V^2 = mu g w.
Mechanism braked_car(double speed) {
  Mechanism m("car");
  m.body("car", {.mass = 1200, .at = {-1.1, 0, 0.5}, .inertia = {300, 1500, 1600}});
  m.planar("road", "car");
  m.blade("front", "car", {.at = {0, 0, 0}});
  m.point("rear", "car", {.at = {-2.6, 0, 0}, .friction = 0.7});
  m.start({{"v1", speed}, {"omega", 1e-6}});
  return m;
}
TEST(LockedRearWheels, UnstableAboveASpeedAlone) {
  const double critical = std::sqrt(0.7 * kGravity * 2.6);
  EXPECT_NEAR(critical, 4.225423055742, 1e-12);
  const double braking = 0.7 * kGravity * 1.1 / 2.6;
  for (const double ratio : {0.3, 0.9, 1 - 1e-5, 1 + 1e-5, 1.1, 3.0}) {
    const double v = ratio * critical, until = 1e-7;
    const Result r = slipping(braked_car(v + 0.5 * braking * until)).until(until).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    EXPECT_THAT(r.system->notes, Contains(HasSubstr("point 'rear' 4980.46")));
    const double inertia = 1600 + 1200 * 1.1 * 1.1, load = 1200 * kGravity * 1.1 / 2.6;
    const double rate = (1200 * 1.1 * v - 0.7 * load * 2.6 * 2.6 / v) / inertia;
    EXPECT_NEAR((last(r, "omega") / 1e-6 - 1) / until, rate, 1e-4 + 1e-4 * std::abs(rate)) << ratio;
    EXPECT_EQ(last(r, "omega") > 1e-6, ratio > 1) << ratio;
  }
}

TEST(BadFriction, IsNamed) {
  const auto with = [](const PointOptions& options, bool free = false,
                       const std::string& distribution = "") {
    return refusal([&] {
      Mechanism m("block");
      m.body("block", {.mass = 2, .at = {0, 0, 0.1}, .box = {0.2, 0.2, 0.2}});
      if (free) m.free("floor", "block");
      else m.planar("floor", "block");
      m.point("skid", "block", options);
      if (!distribution.empty()) m.distribution(distribution);
      (void)simulate(m).until(1).run();
    });
  };
  EXPECT_THAT(with({.friction = -0.1}),
              HasSubstr("point 'skid': friction: got -0.1, expected at least 0"));
  EXPECT_THAT(with({.friction = 0.1, .restitution = 1.5}, true),
              HasSubstr("point 'skid': restitution: got 1.5, expected in [0, 1]"));
  EXPECT_THAT(with({.friction = 0.3, .static_friction = 0.2}),
              HasSubstr("static_friction: got 0.2, expected at least friction, 0.3"));
  EXPECT_THAT(with({.static_friction = 0.2}), HasSubstr("static_friction: set friction too"));
  EXPECT_THAT(with({.friction = 0.3, .share = 2}), HasSubstr("distribution = \"stated\""));
  EXPECT_THAT(with({.friction = 0.3}, true, "stated"),
              HasSubstr("share: distribution is \"stated\": expected a positive number"));
  EXPECT_THAT(with({.friction = 0.1, .tangential_restitution = 2}, true),
              HasSubstr("tangential_restitution: got 2, expected in [0, 1]"));
  EXPECT_THAT(with({.load = 3.0}), HasSubstr("load: set friction too"));
  EXPECT_THAT(with({.restitution = 0.3}), HasSubstr("restitution: set friction too"));
  EXPECT_THAT(with({.friction = 0.1, .load = 3.0}, true), HasSubstr("load is a reaction"));
  EXPECT_THAT(with({.friction = 0.1, .restitution = 0.3}), HasSubstr("cannot strike"));
  EXPECT_THAT(with({.friction = 0.1, .unilateral = true}), HasSubstr("cannot open"));
  EXPECT_THAT(with({.friction = 0.1, .unilateral = false}, true), HasSubstr("may open"));
  EXPECT_THAT(with({.at = {0.2, 0, 0}, .friction = 0.1}),
              HasSubstr("do not balance the weight, 19.62 N at (0, 0) m"));
  EXPECT_THAT(with({.at = {0, 0, -0.1}, .friction = 0.1}, true),
              HasSubstr("its lowest point is at -0.1 m"));
}

}  // namespace
}  // namespace hamel
