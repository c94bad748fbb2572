// Balls with friction on, or inside, the sphere or cylinder of another body, against closed facts.
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
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kBall = 0.1, kMass = 0.3, kSphere = 0.4;  // k of a solid ball

// A ball of radius kBall in space, on a body that is welded to the world.
Mechanism ball_on_fixed(const Point& at, const BodyOptions& fixed, const WheelOptions& contact) {
  Mechanism m("pair");
  m.body("fixed", fixed);
  m.weld("mount", kWorld, "fixed");
  m.body("ball", {.mass = kMass, .at = at, .sphere = kBall});
  m.free("root", "ball", {.at = at});
  WheelOptions o = contact;
  o.at = at;
  o.radius = kBall;
  o.on = "fixed";
  m.ball("contact", "ball", o);
  return m;
}

const EventMet& event(const Result& r, const std::string& name) {
  for (const EventMet& e : r.events)
    if (e.name == name) return e;
  ADD_FAILURE() << "no event " << name;
  return r.events.front();
}

// The angle at which the ball that rolls down from a0 slides: mu ((3 + k) cos a - 2 cos a0) = k sin
// a, L a'^2 = 2 g/(1 + k) (cos a0 - cos a) until then.
double slides_at(double a0, double mu) {
  double low = a0, high = std::acos(2 * std::cos(a0) / (3 + kSphere));
  for (int i = 0; i < 100; ++i) {
    const double a = (low + high) / 2;
    const bool holds =
        mu * ((3 + kSphere) * std::cos(a) - 2 * std::cos(a0)) > kSphere * std::sin(a);
    (holds ? low : high) = a;
  }
  return low;
}

// From there u = a'^2 has du/da = 2 mu u + 2 g/L (sin a - mu cos a), until g cos a = L u. It leaves
// the dome there: by the method of Runge and Kutta, ten thousand steps.
double leaves_at(double a0, double mu, double apart) {
  double a = slides_at(a0, mu);
  double u = 2 * kGravity / ((1 + kSphere) * apart) * (std::cos(a0) - std::cos(a));
  const auto slope = [&](double at, double value) {
    return 2 * mu * value + 2 * kGravity / apart * (std::sin(at) - mu * std::cos(at));
  };
  const double h = 1e-4;
  while (true) {
    const double k1 = slope(a, u), k2 = slope(a + h / 2, u + h / 2 * k1),
                 k3 = slope(a + h / 2, u + h / 2 * k2), k4 = slope(a + h, u + h * k3);
    const double next = u + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    const auto held = [&](double at, double value) {
      return kGravity * std::cos(at) - apart * value;
    };
    const double before = held(a, u), after = held(a + h, next);
    if (after < 0) {  // the root of the cubic through both ends
      const double d0 = -kGravity * std::sin(a) - apart * slope(a, u),
                   d1 = -kGravity * std::sin(a + h) - apart * slope(a + h, next);
      double x = before / (before - after);
      for (int i = 0; i < 20; ++i) {
        const double y = before * (1 + 2 * x) * (1 - x) * (1 - x) + h * d0 * x * (1 - x) * (1 - x) +
                         after * x * x * (3 - 2 * x) + h * d1 * x * x * (x - 1);
        x += y / (before - after);
      }
      return a + x * h;
    }
    a += h;
    u = next;
  }
}

// Down a dome from rest: it slides before it leaves, never after, whatever the direction of its
// way; and it does not strike again as it leaves. Source: hybrid motion, ball down a dome.
TEST(SlidingPairs, BallDownADome) {
  const double radius = 0.7, apart = radius + kBall;
  EXPECT_NEAR(slides_at(0.1, 0.3), 0.6208051218962687, 1e-14);
  for (const auto& one : std::vector<std::array<double, 3>>{
           {0.1, 0.3, 0}, {0.1, 0.3, 1.1}, {0.3, 0.7, -2.3}, {0.2, 0.1, 0.4}}) {
    const double a0 = one[0], mu = one[1], heading = one[2];
    SCOPED_TRACE(testing::Message() << a0 << " " << mu << " " << heading);
    const Point at = {apart * std::sin(a0) * std::cos(heading),
                      apart * std::sin(a0) * std::sin(heading), 1 + apart * std::cos(a0)};
    const Result r = slipping(ball_on_fixed(at, {.mass = 0, .at = {0, 0, 1}, .sphere = radius},
                                            {.friction = mu}))
                         .tolerance({.relative = 1e-12})
                         .until(1.5)
                         .run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    ASSERT_THAT(names(r), ElementsAre("contact.slides", "contact.opens"));
    const auto angle = [&](const EventMet& e) {
      const double x = e.coordinates[9], y = e.coordinates[10], z = e.coordinates[11] - 1;
      EXPECT_NEAR(std::atan2(y, x), heading, 1e-9);
      return std::atan2(std::hypot(x, y), z);
    };
    EXPECT_NEAR(angle(r.events[0]), slides_at(a0, mu), 1e-9);
    EXPECT_NEAR(angle(r.events[1]), leaves_at(a0, mu, apart), 1e-8);
    EXPECT_LT(last(r, "contact.friction_work"), 0);
  }
}

// A wheel of radius R that rolls against a step of height h, without restitution, turns about its
// edge: w+/w- = (k + cos b)/(1 + k), b the angle of the centre above the edge: 1 - (h/R)/(1 + k).
// The edge is the axis of a cylinder of radius c: cos b = (R - h + c)/(R + c).
TEST(SlidingPairs, BallAgainstAStep) {
  for (const double edge : {1e-6, 0.02}) {
    SCOPED_TRACE(edge);
    const double height = 0.04, speed = 2, rises = (kBall - height + edge) / (kBall + edge);
    const double apart = (kBall + edge) * std::sqrt(1 - rises * rises);
    const Point at = {-apart - 0.1, 0, kBall};
    Mechanism m = ball_on_fixed(
        at, {.mass = 0, .at = {0, 0, height - edge}, .cylinder = {edge, 1}, .axis = {0, 1, 0}},
        {.friction = 0.8});
    m.ball("floor", "ball", {.at = at, .radius = kBall, .friction = 0.8});
    m.start({{"v1", speed}, {"w2", speed / kBall}});
    const Result r = slipping(m).until(0.06).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    ASSERT_THAT(names(r), testing::IsSupersetOf({"contact.strikes", "floor.opens"}));
    const EventMet& strike = event(r, "contact.strikes");
    EXPECT_NEAR(strike.time, 0.1 / speed, 1e-11);
    const double ratio = (kSphere + rises) / (1 + kSphere);
    EXPECT_NEAR(ratio, 1 - height / kBall / (1 + kSphere), 4 * edge);
    ASSERT_EQ(strike.velocity_after.size(), 6u);
    EXPECT_NEAR(strike.velocity_after[1] / (speed / kBall), ratio, 1e-10);
    const double after = ratio * speed;
    EXPECT_NEAR(std::hypot(strike.velocity_after[3], strike.velocity_after[5]), after, 1e-10);
    // It turns about the edge: the energy is that behind the strike.
    EXPECT_NEAR(last(r, "energy"),
                (1 + kSphere) / 2 * kMass * after * after + kMass * kGravity * kBall, 1e-9);
  }
}

// Falls onto a fixed sphere beside its top: v_n+ = -e v_n, and a spin that sticks leaves the
// tangential velocity (v_t + k r w)/(1 + k), for w the spin that rolls that way.
TEST(SlidingPairs, BallStrikesASphere) {
  const double radius = 0.5, a = 0.4, apart = radius + kBall, spin = 3;
  for (const double e : {0.0, 0.6}) {
    for (const double mu : {0.9, 0.02}) {
      SCOPED_TRACE(testing::Message() << e << " " << mu);
      const double fall = 0.2, speed = std::sqrt(2 * kGravity * fall);
      Mechanism m = ball_on_fixed({apart * std::sin(a), 0, apart * std::cos(a) + fall},
                                  {.mass = 0, .at = {0, 0, 0}, .sphere = radius},
                                  {.friction = mu, .restitution = e});
      m.start({{"w2", spin}});
      const Result r = slipping(m).until(speed / kGravity + 0.01).run();
      ASSERT_TRUE(r.status.ok) << r.status.reason;
      const EventMet& strike = event(r, "contact.strikes");
      EXPECT_NEAR(strike.time, speed / kGravity, 1e-10);
      // Along the fall line t = (cos a, 0, -sin a) and across it; the ball's axes have turned.
      const double turned = spin * strike.time, c = std::cos(turned), s = std::sin(turned);
      const double x = c * strike.velocity_after[3] + s * strike.velocity_after[5],
                   z = -s * strike.velocity_after[3] + c * strike.velocity_after[5];
      const double along = x * std::cos(a) - z * std::sin(a),
                   across = x * std::sin(a) + z * std::cos(a);
      const double v_t = speed * std::sin(a), v_n = speed * std::cos(a);
      const double sticks = (v_t + kSphere * kBall * spin) / (1 + kSphere);
      const double slides = v_t - mu * (1 + e) * v_n;  // its slip is ahead
      EXPECT_NEAR(across, e * v_n, 1e-10);
      EXPECT_NEAR(along, std::max(sticks, slides), 1e-10);
    }
  }
}

// On a dome that a cart carries without friction: what the contact does is no force from outside.
TEST(SlidingPairs, BallOnACartKeepsTheMomentum) {
  const double radius = 0.5, a = 0.15, apart = radius + kBall;
  const Point at = {apart * std::sin(a), 0, 1 + apart * std::cos(a)};
  Mechanism m("cart");
  m.body("dome", {.mass = 0.5, .at = {0, 0, 1}, .sphere = radius});
  m.slider("rail", kWorld, "dome", {.axis = {1, 0, 0}});
  m.body("ball", {.mass = kMass, .at = at, .sphere = kBall});
  m.free("root", "ball", {.at = at});
  m.ball("contact", "ball", {.at = at, .radius = kBall, .friction = 0.2, .on = "dome"});
  m.sensor("centre", "ball", at);
  m.start({{"root.w2", -6}, {"root.v1", 0}, {"root.v3", 0}, {"rail.rate", 0}});
  const Result r = slipping(m).until(0.6).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), testing::Contains("contact.rolls"));
  for (size_t i = 0; i < r.trajectory.rows(); ++i)
    EXPECT_NEAR(
        0.5 * r.trajectory.column("rail.rate")[i] + kMass * r.trajectory.column("centre.vx")[i], 0,
        1e-10);
  EXPECT_LT(last(r, "contact.friction_work"), -1e-3);
  EXPECT_LT(std::abs(last(r, "energy_error")), 1e-9);
}

// Drawn above the sphere it falls, without restitution rests and rolls.
TEST(SlidingPairs, MayBeDrawnApart) {
  const Result r = slipping(ball_on_fixed({0, 0, 1}, {.mass = 0, .at = {0, 0, 0}, .sphere = 0.5},
                                          {.friction = 0.5}))
                       .until(0.4)
                       .run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("contact.strikes", "contact.rolls"));
  EXPECT_NEAR(time_of(r, "contact.strikes"), std::sqrt(2 * 0.4 / kGravity), 1e-11);
  EXPECT_NEAR(last(r, "z"), 0.6, 1e-12);
}

TEST(SlidingPairs, RefusesWhatHasNoMeaning) {
  const auto refused = [](const WheelOptions& o) {
    return refusal([&] {
      (void)ball_on_fixed({0, 0, 0.6}, {.mass = 0, .at = {0, 0, 0}, .sphere = 0.5}, o).model();
    });
  };
  EXPECT_THAT(refused({.friction = 0.3, .load = 2}),
              HasSubstr("load: that of a ball on another body is a reaction; leave it out"));
  EXPECT_THAT(refused({.friction = -0.3}), HasSubstr("friction: got -0.3, expected at least 0"));
  EXPECT_THAT(refused({.restitution = 0.3}), HasSubstr("restitution: set friction too"));
  EXPECT_THAT(refused({.friction = 0.3, .unilateral = false}), HasSubstr("leave friction out"));
  EXPECT_THAT(refused({.friction = 0.3, .share = 1}), HasSubstr("distribution = \"stated\""));
}

}  // namespace
}  // namespace hamel
