// Closed facts of contacts that slide and strike, of mechanisms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "slipping.hpp"

namespace hamel {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kShare = 0.4;  // k = I/(m R^2) of a homogeneous ball

Mechanism ball_at(const Point& at, double radius, const WheelOptions& contact) {
  Mechanism m("ball");
  m.body("ball", {.mass = 0.3, .at = at, .sphere = radius});
  m.free("root", "ball", {.at = at});
  WheelOptions o = contact;
  o.at = at;
  o.radius = radius;
  m.ball("contact", "ball", o);
  return m;
}

// Rolling down a sphere from rest at th0 it slips where mu N = |T|, with N = m g ((3 + k) cos th -
// 2 cos th0)/(1 + k) and T = k m g sin th/(1 + k).
TEST(Dome, TheBallSlipsBeforeItLeaves) {
  const double big = 0.7, small = 0.1, apart = big + small, th0 = 0.1;
  Mechanism m =
      ball_at({apart * std::sin(th0), 0, apart * std::cos(th0) - big}, small, {.friction = 0.3});
  m.ground_height("sqrt(R^2 - x^2 - y^2) - R", {{"R", {big}}});
  const Result r = slipping(m).stop_at({"contact.slides"}).until(5).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_TRUE(r.stopped_by_event);
  const double angle = std::atan2(r.last.coordinates[9], r.last.coordinates[11] + big);
  EXPECT_NEAR(angle, 0.6208051218962687, 1e-9);
}

// A ball alone has no extent: its ground reaches as far as it may roll.
TEST(Ground, IsDrawnAroundABall) {
  Mechanism m = ball_at({0, 0, 0.1}, 0.1, {});
  m.ground_height("top*cos(x)", {{"top", {0.0}}});
  const Result r = simulate(m).until(0.01).run();
  const DrawnBody& ground = r.system->drawing.bodies.front();
  ASSERT_EQ(ground.name, "ground");
  double far = 0;
  for (const BodyShape& line : ground.shapes)
    for (const Point& at : line.points) far = std::max(far, std::hypot(at[0], at[1]));
  EXPECT_GT(far, 5);
}

// On a slope a ball rolls from rest where mu >= k/(1 + k) tan a, with g k'/(1 + k); else it slides.
TEST(Incline, RollsWhereFrictionIsEnough) {
  const double slope = 0.5, least = kShare / (1 + kShare) * std::tan(slope);
  for (const double ratio : {1 + 1e-9, 1 - 1e-9, 0.5}) {
    Mechanism m = ball_at({0, 0, 0.1}, 0.1, {.friction = least * ratio});
    m.gravity({kGravity * std::sin(slope), 0, -kGravity * std::cos(slope)});
    const Result r = slipping(m).until(1).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    const bool rolls = ratio > 1;
    EXPECT_EQ(last(r, "contact.mode"), rolls ? 1 : 2) << ratio;
    const double rate =
        kGravity * (std::sin(slope) - std::min(least, ratio * least) * std::cos(slope));
    EXPECT_NEAR(last(r, "x"), rate / 2, 1e-9) << ratio;
  }
}

// A rolling disk whose rim strikes a wall without friction: v+ = v - (1 + e) (a v)/(a G^-1 a^T)
// G^-1 a^T with G = diag(I, m R^2 + J), a = (R sin th, -R cos th).
TEST(WallAgainstADisk, IsAnImpactWithinTheRows) {
  const std::array<std::array<double, 3>, 2> cases{
      {{1, 4.71628996, -0.54108055}, {0, 2.35814498, 0.72945972}}};
  for (const auto& [e, turn, roll] : cases) {
    Mechanism m("disk");
    m.body("along", {.mass = 0});
    m.body("across", {.mass = 0});
    m.body("fork", {.mass = 0});
    m.body("disk", {.mass = 1, .at = {0, 0, 1}, .inertia = {0.25, 0.5, 0.25}});
    m.slider("x", kWorld, "along", {.axis = {1, 0, 0}});
    m.slider("y", "along", "across", {.axis = {0, 1, 0}});
    m.hinge("turn", "across", "fork", {.axis = {0, 0, 1}});
    m.hinge("roll", "fork", "disk", {.at = {0, 0, 1}, .axis = {0, 1, 0}});
    m.wheel("wheel", "disk", {.at = {0, 0, 1}, .radius = 1});
    m.wall("wall",
           {.distance = "2 - x.position - cos(turn.angle)", .restitution = e, .constants = {}});
    // It rolls ahead at 2 rad/s until its rim is at the wall.
    m.start({{"turn.angle", 0.3}, {"roll.rate", 2}});
    const Result r = slipping(m).until(1).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    ASSERT_FALSE(r.events.empty());
    EXPECT_EQ(r.events[0].name, "wall.strikes");
    const auto after = [&](const std::string& name) {
      const auto& columns = r.trajectory.columns();
      const size_t first = 1 + r.last.coordinates.size();
      for (size_t i = 0; i < r.last.velocity.size(); ++i)
        if (columns[first + i] == name) return r.events[0].velocity_after[i];
      ADD_FAILURE() << "no velocity " << name;
      return std::nan("");
    };
    EXPECT_NEAR(r.events[0].time, (2 - std::cos(0.3)) / (2 * std::cos(0.3)), 1e-11);
    EXPECT_NEAR(after("turn.rate"), turn, 5e-9);
    EXPECT_NEAR(after("roll.rate"), roll, 5e-9);
  }
}

// Which of three balls in a row goes on depends on the order in which they strike: (-1/3, 2/3, 2/3)
// at once, (0, 0, 1) one by one.
TEST(ThreeBalls, AreNotDecided) {
  Mechanism m("row");
  for (int i = 0; i < 3; ++i) {
    const std::string name(1, static_cast<char>('a' + i));
    m.body(name, {.mass = 1, .at = {0, 0, 0.1}, .sphere = 0.1});
    m.slider(name, kWorld, name, {.axis = {1, 0, 0}});
  }
  m.wall("ab", {.distance = "b.position - a.position - 1", .restitution = 1});
  m.wall("bc", {.distance = "c.position - b.position - 1", .restitution = 1});
  m.start({{"b.position", 2}, {"c.position", 3}, {"a.rate", 1}});
  const Result r = slipping(m).until(2).run();
  EXPECT_FALSE(r.status.ok);
  EXPECT_THAT(r.status.reason, testing::StartsWith("simultaneous_impacts: "));
  EXPECT_THAT(r.status.reason, HasSubstr("ab"));
  EXPECT_THAT(r.status.reason, HasSubstr("bc"));
  EXPECT_NEAR(r.last.time, 1, 1e-12);
}

// Jellett's integral of a ball whose mass centre C lies apart from its middle on the axis of its
// inertia, -L.(P - C), P its lowest point: no force at P changes it.
// Source: Or, The dynamics of a tippe top, SIAM J. Appl. Math. 54 (1994).
TEST(TippeTop, KeepsJellettsIntegralUnderFriction) {
  const double radius = 0.02, below = 0.006, mass = 0.01;
  const double across = 0.4 * mass * radius * radius, along = 1.1 * across;
  Mechanism m("top");
  m.body("top", {.mass = mass, .at = {0, 0, radius - below}, .inertia = {across, across, along}});
  m.free("root", "top", {.at = {0, 0, radius - below}});
  m.ball("contact", "top", {.at = {0, 0, radius}, .radius = radius, .friction = 0.3});
  const double tilt = 0.8, spin = 150;
  const Eigen::AngleAxisd lean(tilt, Eigen::Vector3d::UnitX());
  const Eigen::Matrix3d turned = lean.toRotationMatrix();
  const double height = radius - below * std::cos(tilt);
  std::vector<double> place;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) place.push_back(turned(i, j));
  place.insert(place.end(), {0, 0, height});
  const Result r =
      slipping(m).start({.configuration = place, .velocity = {0, 0, spin, 0, 0, 0}}).until(1).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  const auto value = [&](size_t row, const std::string& name) {
    return r.trajectory.at(row, r.trajectory.index(name));
  };
  double first = 0;
  for (size_t row = 0; row < r.trajectory.rows(); ++row) {
    const Eigen::Vector3d axis(value(row, "R13"), value(row, "R23"), value(row, "R33"));
    Eigen::Matrix3d now;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        now(i, j) = value(row, "R" + std::to_string(i + 1) + std::to_string(j + 1));
    const Eigen::Vector3d rate(value(row, "w1"), value(row, "w2"), value(row, "w3"));
    const Eigen::Vector3d momentum =
        now * Eigen::Vector3d(across, across, along).cwiseProduct(rate);
    const Eigen::Vector3d to_contact = below * axis - radius * Eigen::Vector3d::UnitZ();
    const double jellett = -momentum.dot(to_contact);
    if (row == 0) first = jellett;
    EXPECT_NEAR(jellett / first, 1, 1e-9);
  }
  EXPECT_LT(last(r, "work"), -1e-4) << "friction takes energy";
  EXPECT_LT(r.energy_error_max, 1e-8);
}

}  // namespace
}  // namespace hamel
