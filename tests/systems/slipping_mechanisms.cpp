// Mechanisms with friction at contacts and in joints, stops and walls, against closed facts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/mechanisms/mechanism_file.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "../framework/run/refusal.hpp"

namespace hamel {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kGravity = 9.81;

double last(const Result& r, const std::string& name) { return r.trajectory.column(name).back(); }
std::vector<std::string> names(const Result& r) {
  std::vector<std::string> out;
  for (const EventMet& e : r.events) out.push_back(e.name);
  return out;
}
double time_of(const Result& r, const std::string& name) {
  for (const EventMet& e : r.events)
    if (e.name == name) return e.time;
  ADD_FAILURE() << "no event " << name;
  return std::nan("");
}
Simulation slipping(const Mechanism& m) {
  return simulate(m).tolerance({.relative = 1e-10}).slip();
}

// ---- contacts ---------------------------------------------------------------------------------

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

// ---- brakes -----------------------------------------------------------------------------------

Mechanism flywheel(double rate) {
  Mechanism m("flywheel");
  m.body("wheel", {.mass = 1, .at = {0, 0, 1}, .inertia = {1, 1, 2}});
  m.hinge("axle", kWorld, "wheel", {.at = {0, 0, 1}});
  m.motor("axle");
  m.brake("axle");
  m.start("axle.rate", rate);
  return m;
}

// J w' = 0.5 - b(t) until it rests, b = 2 t up to t = 1, then 2, from t = 3 on 5 - t: at rest until
// b = 0.5, at t = 4.5, then J w' = t - 4.5, and 0.5 behind t = 5.
TEST(Brake, IsAnInput) {
  const auto run = [](bool jumps) {
    Simulation out = slipping(flywheel(1));
    out.input("axle.torque", 0.5);
    InputTable b;
    b.times = {0, 1, 3, 5, 8};
    b.values = {0, 2, 2, 0, 0};
    if (jumps) {
      b.times = {0, 2, 8};
      b.values = {2, 0, 0};
      b.hold = true;
    }
    out.input("axle.brake", b);
    return out.until(6).run();
  };
  const double J = 2;
  const Result r = run(false);
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("axle.sticks", "axle.slips"));
  const double at_one = 1 + (0.5 - 1) / J, rests = 1 + at_one * J / 1.5;
  EXPECT_NEAR(time_of(r, "axle.sticks"), rests, 1e-9);
  EXPECT_NEAR(time_of(r, "axle.slips"), 4.5, 1e-9);
  EXPECT_NEAR(last(r, "axle.rate"), (0.125 + 0.5) / J, 1e-9);
  EXPECT_LT(r.energy_error_max, 1e-9);
  const Result step = run(true);
  ASSERT_TRUE(step.status.ok) << step.status.reason;
  EXPECT_NEAR(time_of(step, "axle.sticks"), J / 1.5, 1e-9);
  EXPECT_NEAR(time_of(step, "axle.slips"), 2, 1e-9);
  EXPECT_NEAR(last(step, "axle.rate"), 4 * 0.5 / J, 1e-9);
}

// Beside dry friction of the joint; a brake that nobody sets does nothing.
TEST(Brake, AddsToFriction) {
  Mechanism m("flywheel");
  m.body("wheel", {.mass = 1, .at = {0, 0, 1}, .inertia = {1, 1, 2}});
  m.hinge("axle", kWorld, "wheel", {.at = {0, 0, 1}, .friction = 0.3});
  m.brake("axle", {.least = 0, .most = 5});
  m.start("axle.rate", 1);
  const Result none = slipping(m).until(1).run();
  EXPECT_NEAR(last(none, "axle.rate"), 1 - 0.15, 1e-10);
  EXPECT_NEAR(last(slipping(m).input("axle.brake", 0.7).until(1).run(), "axle.rate"), 0.5, 1e-10);
  EXPECT_THAT(refusal([&] { slipping(m).input("axle.brake", -1).until(1).run(); }),
              HasSubstr("axle.brake"));
  Mechanism wrong("wrong");
  wrong.body("wheel", {.mass = 1, .at = {0, 0, 1}, .inertia = {1, 1, 2}});
  wrong.hinge("axle", kWorld, "wheel", {.at = {0, 0, 1}});
  wrong.brake("axel");
  EXPECT_THAT(refusal([&] { (void)wrong.model(); }), HasSubstr("did you mean 'axle'?"));
  wrong = flywheel(1);
  wrong.brake("axle");
  EXPECT_THAT(refusal([&] { (void)wrong.model(); }), HasSubstr("this joint has a brake already"));
}

// Four wheels that no hinge turns.
Mechanism locked_cart() {
  Mechanism m("cart");
  m.body("cart", {.mass = 10, .at = {0.1, 0, 0.2}, .box = {0.8, 0.5, 0.2}});
  m.planar("floor", "cart");
  for (const double x : {-0.3, 0.3})
    for (const double y : {-0.2, 0.2})
      m.wheel(fmt::format("{}{}", x > 0 ? "front " : "rear ", y > 0 ? "left" : "right"), "cart",
              {.at = {x, y, 0.1}, .radius = 0.1, .friction = 0.5});
  m.start({{"v1", 2}, {"v2", 0.5}, {"omega", 3}});
  return m;
}
TEST(LockedCart, SlidesTurnsAndRests) {
  const Result r = simulate(locked_cart()).slip().until(3).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  for (const char* name : {"v1", "v2", "omega"}) EXPECT_LT(std::abs(last(r, name)), 1e-14) << name;
  for (const char* name : {"rear left.mode", "front right.mode"}) EXPECT_EQ(last(r, name), 1);
  EXPECT_LE(r.steps, 60);
  EXPECT_LT(r.energy_error_max, 1e-8);
  // sum N = m g, sum x N = 0.1 m g: 24.525 (1 -+ 1/3).
  EXPECT_THAT(r.system->notes,
              Contains(AllOf(HasSubstr("least sum of squares"), HasSubstr("'rear right' 16.35 N"),
                             HasSubstr("'front left' 32.7 N"))));
}

// Pushed at its middle by less than its friction each of four feet bears a quarter, whatever an
// order; the turning moment 0.3 of a push beside it adds a couple, across the way to the middle.
TEST(LockedCart, FeetOfEqualLoadsShareAPush) {
  Mechanism m("table");
  m.body("table", {.mass = 10, .at = {0, 0, 0.2}, .box = {0.8, 0.5, 0.2}});
  m.planar("floor", "table");
  const double x = 0.4, y = 0.3;
  for (const double sx : {-1.0, 1.0})
    for (const double sy : {-1.0, 1.0})
      m.point(fmt::format("{}{}", sx, sy), "table", {.at = {sx * x, sy * y, 0}, .friction = 0.5});
  m.force("push", "table",
          {.at = {0, -0.1, 0},
           .along = {[](const SignalInput&) { return 4.0; }, [](const SignalInput&) { return 0.0; },
                     [](const SignalInput&) { return 0.0; }},
           .time_dependent = false});
  const Result r = slipping(m).until(1).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_EQ(last(r, "omega"), 0);
  const double couple = -0.4 / (4 * (x * x + y * y));  // rotating about the middle, per length
  for (const double sx : {-1.0, 1.0})
    for (const double sy : {-1.0, 1.0}) {
      const std::string name = fmt::format("{}{}", sx, sy);
      EXPECT_NEAR(last(r, name + ".reaction1"), -1 - couple * sy * y, 1e-12) << name;
      EXPECT_NEAR(last(r, name + ".reaction2"), couple * sx * x, 1e-12) << name;
    }
}

// A cart whose four wheels turn, half track b, half wheelbase a, as many loads N = m g/4: turning
// in place with the rates -+w of its wheels the slips are (-+(r w - b W), -+a W), and its friction
// has no moment where a^2 W = b (r w - b W): W = b r w/(a^2 + b^2), whatever mu and N. The torque
// of a wheel is then r mu N a/sqrt(a^2 + b^2).
struct SkidSteered {
  double a = 0.25, b = 0.2, r = 0.1, mu = 0.6, mass = 20, damping = 0.5;
  double load() const { return mass * kGravity / 4; }
  double friction_torque() const { return r * mu * load() * a / std::hypot(a, b); }
  Mechanism mechanism(double torque) const {
    Mechanism m("robot");
    m.body("base", {.mass = mass, .at = {0, 0, 0.15}, .box = {0.6, 0.3, 0.1}});
    m.planar("floor", "base");
    for (const double x : {-a, a})
      for (const double y : {-b, b}) {
        const std::string name =
            fmt::format("{}{}", x > 0 ? "front " : "rear ", y > 0 ? "left" : "right");
        m.body(name, {.mass = 0, .at = {x, y, r}, .inertia = {0, 0.01, 0}});
        m.hinge(name, "base", name, {.at = {x, y, r}, .axis = {0, 1, 0}, .damping = damping});
        m.wheel(name, name, {.at = {x, y, r}, .radius = r, .friction = mu});
        const double side = y > 0 ? -1 : 1;
        m.motor(
            name, [=](const SignalInput&) { return side * torque; }, false);
      }
    return m;
  }
};
TEST(SkidSteered, TurnsInPlaceAtTheQuasiStaticRate) {
  const SkidSteered s;
  const double torque = 1.5 * s.friction_torque();
  const Result r = slipping(s.mechanism(torque)).until(20).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_THAT(r.system->notes, Contains(HasSubstr("turns only by slipping")));
  const double w = (torque - s.friction_torque()) / s.damping;
  EXPECT_NEAR(last(r, "front right.rate"), w, 1e-8);
  EXPECT_NEAR(last(r, "omega"), s.b * s.r * w / (s.a * s.a + s.b * s.b), 1e-8);
  EXPECT_LT(std::hypot(last(r, "x"), last(r, "y")), 1e-9);
}
TEST(SkidSteered, RestsBelowTheTorque) {
  const SkidSteered s;
  const Result rests = slipping(s.mechanism(0.999 * s.friction_torque())).until(2).run();
  ASSERT_TRUE(rests.status.ok) << rests.status.reason;
  EXPECT_LT(std::abs(last(rests, "omega")), 1e-14);
  const Result turns = slipping(s.mechanism(1.001 * s.friction_torque())).until(2).run();
  ASSERT_TRUE(turns.status.ok) << turns.status.reason;
  EXPECT_GT(last(turns, "omega"), 1e-4);
}
// Four feet at the corners and one in the middle bear a fifth each, or, with 4 times the share, the
// one in the middle a half: the least sum of N^2/share.
TEST(Distribution, IsStatedOrRefused) {
  const auto table = [](const std::string& policy) {
    Mechanism m("table");
    m.body("table", {.mass = 8, .at = {0, 0, 0.2}, .box = {0.8, 0.5, 0.2}});
    m.planar("floor", "table");
    if (!policy.empty()) m.distribution(policy);
    const auto share = [&](double value) {
      return policy == "stated" ? std::optional<double>(value) : std::nullopt;
    };
    for (const double sx : {-1.0, 1.0})
      for (const double sy : {-1.0, 1.0})
        m.point(fmt::format("{}{}", sx, sy), "table",
                {.at = {0.4 * sx, 0.3 * sy, 0}, .friction = 0.5, .share = share(1)});
    m.point("middle", "table", {.friction = 0.5, .share = share(4)});
    return m;
  };
  EXPECT_THAT(table("").model().notes, Contains(HasSubstr("'middle' 15.696 N")));
  EXPECT_THAT(table("stated").model().notes,
              Contains(AllOf(HasSubstr("as the shares have it"), HasSubstr("'middle' 39.24 N"))));
  EXPECT_THAT(refusal([&] { (void)table("refuse").model(); }),
              HasSubstr("5 contacts share the weight, statics determines three"));
  EXPECT_THAT(refusal([&] { (void)table("statd").model(); }), HasSubstr("did you mean 'stated'?"));
}

// Straight ahead it rolls: m v' + 4 J v'/r^2 = 4 (torque - damping v/r)/r.
TEST(SkidSteered, RollsAhead) {
  const SkidSteered s;
  Mechanism m = s.mechanism(0);
  m.force("push", "base",
          {.at = {0, 0, 0.1},
           .along = {[](const SignalInput&) { return 2.0; }, [](const SignalInput&) { return 0.0; },
                     [](const SignalInput&) { return 0.0; }},
           .time_dependent = false});
  const Result r = simulate(m).tolerance({.relative = 1e-10}).until(1).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  const double inertia = s.mass + 4 * 0.01 / (s.r * s.r), drag = 4 * s.damping / (s.r * s.r);
  EXPECT_NEAR(last(r, "v1"), 2 / drag * (1 - std::exp(-drag / inertia)), 1e-10);
  EXPECT_TRUE(r.events.empty());
}

// ---- joints -----------------------------------------------------------------------------------

Mechanism dry_slider(double friction) {
  Mechanism m("block");
  m.body("block", {.mass = 1, .at = {0, 0, 0.1}, .box = {0.2, 0.2, 0.2}});
  m.slider("way", kWorld, "block", {.axis = {1, 0, 0}, .friction = friction});
  m.start("way.rate", 1);
  return m;
}
TEST(DryFriction, ABlockStopsAndRests) {
  const Result r = slipping(dry_slider(2)).until(1000).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("way.sticks"));
  EXPECT_NEAR(time_of(r, "way.sticks"), 0.5, 1e-13);
  EXPECT_NEAR(last(r, "way.position"), 0.25, 1e-13);
  EXPECT_EQ(last(r, "way.rate"), 0);
  EXPECT_LE(r.steps, 12);
}

TEST(Stops, AJointStrikesItsEnds) {
  Mechanism m("block");
  m.body("block", {.mass = 1, .at = {0, 0, 0.1}, .box = {0.2, 0.2, 0.2}});
  m.slider("way", kWorld, "block", {.axis = {1, 0, 0}, .restitution = 0.5, .stop = {-0.5, 1}});
  m.start("way.rate", 2);
  const Result r = slipping(m).until(3).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("way.high.strikes", "way.low.strikes"));
  EXPECT_NEAR(r.events[0].time, 0.5, 1e-13);
  EXPECT_NEAR(r.events[1].time, 0.5 + 1.5, 1e-13);
  EXPECT_NEAR(last(r, "way.rate"), 0.5, 1e-13);
}

// Two masses on one rail, of which neither passes the other: e = 1 exchanges equal ones' speeds.
TEST(Walls, TwoBlocksOnARail) {
  Mechanism m("rail");
  for (const char* name : {"a", "b"}) {
    m.body(name, {.mass = 1, .at = {0, 0, 0.1}, .box = {0.2, 0.2, 0.2}});
    m.slider(name, kWorld, name, {.axis = {1, 0, 0}});
  }
  m.wall("buffer", {.distance = "b.position - a.position - width",
                    .restitution = 1,
                    .constants = {{"width", {0.2}}}});
  m.start({{"b.position", 1}, {"a.rate", 2}});
  const Result r = slipping(m).until(1).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("buffer.strikes"));
  EXPECT_NEAR(r.events[0].time, 0.4, 1e-13);
  EXPECT_NEAR(last(r, "a.rate"), 0, 1e-13);
  EXPECT_NEAR(last(r, "b.rate"), 2, 1e-13);
}

// ---- mistakes ---------------------------------------------------------------------------------

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
