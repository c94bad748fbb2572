// Carts on wheels that do not turn or steer, and how their loads are shared.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "../framework/run/refusal.hpp"
#include "slipping.hpp"

namespace hamel {
namespace {

using namespace test;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

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
  double taken = 0;  // all that it had
  for (const char* name : {"rear left", "rear right", "front left", "front right"}) {
    taken += last(r, std::string(name) + ".friction_work");
    EXPECT_LT(last(r, std::string(name) + ".friction_work"), -0.1) << name;
  }
  EXPECT_NEAR(taken, last(r, "energy") - r.trajectory.column("energy").front(), 1e-7);
  EXPECT_LT(r.energy_error_max, 1e-8);
  // sum N = m g, sum x N = 0.1 m g: 24.525 (1 -+ 1/3).
  EXPECT_THAT(r.system->notes,
              Contains(AllOf(HasSubstr("least sum of squares"), HasSubstr("'rear right' 16.35 N"),
                             HasSubstr("'front left' 32.7 N"))));
}

// All four slip across, in whatever order they are; each turns as fast as it rolls ahead.
TEST(SkidSteered, WheelsTurnAtANamedStart) {
  Mechanism m("cart");
  m.body("cart", {.mass = 10, .at = {0, 0, 0.2}, .box = {0.8, 0.5, 0.2}});
  m.planar("floor", "cart");
  for (const double x : {-0.3, 0.3})
    for (const double y : {-0.2, 0.2}) {
      const std::string name =
          fmt::format("{}{}", x > 0 ? "front " : "rear ", y > 0 ? "left" : "right");
      m.body(name, {.mass = 1, .at = {x, y, 0.1}, .inertia = {0.003, 0.005, 0.003}});
      m.hinge(name, "cart", name, {.at = {x, y, 0.1}, .axis = {0, 1, 0}});
      m.wheel(name, name, {.at = {x, y, 0.1}, .radius = 0.1, .friction = 0.5});
    }
  const Result r = slipping(m).start("v1", 1).start("omega", 1).until(1e-3).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  const auto first = [&](const std::string& name) { return r.trajectory.column(name).front(); };
  EXPECT_NEAR(first("v1"), 1, 1e-12);
  EXPECT_NEAR(first("v2"), 0, 1e-12);
  EXPECT_NEAR(first("omega"), 1, 1e-12);
  for (const char* const name : {"front left", "rear left"})
    EXPECT_NEAR(first(fmt::format("{}.rate", name)), 8, 1e-12) << name;
  for (const char* const name : {"front right", "rear right"})
    EXPECT_NEAR(first(fmt::format("{}.rate", name)), 12, 1e-12) << name;
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

// Two feet of a bar across, each with the bound B. The push 0.8 B ahead at the first is borne by
// it; that of t B along the bar by either: in equal parts up to 1.2 B, where the first is on its
// rim, then by the second, up to 1.6 B, where it is on its own: there both begin to slide, not
// before.
TEST(LockedCart, FeetSlideWhereNoneHoldsMore) {
  const double load = 10, bound = 0.5 * load;
  for (const bool given : {true, false}) {
    SCOPED_TRACE(given);
    Mechanism m("bar");
    m.body("bar", {.mass = 2 * load / kGravity, .at = {0, 0, 0}, .box = {0.1, 0.8, 0.02}});
    if (given) m.planar("floor", "bar");
    else m.free("root", "bar");
    for (const double y : {0.4, -0.4}) {
      PointOptions foot{.at = {0, y, 0}, .friction = 0.5};
      if (given) foot.load = load;
      m.point(y > 0 ? "first" : "second", "bar", foot);
    }
    const auto none = [](const SignalInput&) { return 0.0; };
    m.force("ahead", "bar",
            {.at = {0, 0.4, 0},
             .along = {[bound](const SignalInput&) { return 0.8 * bound; }, none, none},
             .time_dependent = false});
    m.force("across", "bar",
            {.at = {0, 0, 0},
             .along = {none, [bound](const SignalInput& at) { return at.t * bound; }, none}});
    const Result r = slipping(m).until(1.7).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    EXPECT_EQ(names(r), (std::vector<std::string>{"first.slides", "second.slides"}));
    EXPECT_NEAR(time_of(r, "first.slides"), 1.6, 1e-9);
    EXPECT_NEAR(time_of(r, "second.slides"), 1.6, 1e-9);
    const std::string ahead = ".reaction1", across = ".reaction2";
    for (size_t i = 0; i < r.trajectory.rows(); ++i) {
      const auto at = [&](const std::string& name) { return r.trajectory.column(name)[i]; };
      const double push = at("t") * bound;
      if (at("t") > 1.6 - 1e-9) continue;
      const double first = std::min(push / 2, 0.6 * bound);
      EXPECT_NEAR(at("first" + ahead), -0.8 * bound, 1e-9) << at("t");
      EXPECT_NEAR(at("first" + across), -first, 1e-9) << at("t");
      EXPECT_NEAR(at("second" + across), first - push, 1e-9) << at("t");
    }
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

}  // namespace
}  // namespace hamel
