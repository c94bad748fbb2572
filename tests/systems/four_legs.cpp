// Four legs on a table in space, whose loads the motion leaves open: contacts that give way,
// against planar equations whose loads are a plane over the feet.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <Eigen/LU>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

using testing::HasSubstr;

constexpr double kGravity = 9.81, kMass = 2, kHeight = 0.4, kFriction = 0.3;
const Eigen::Vector2d kCentre(0.05, 0.02);
const Eigen::Matrix3d kInertia =
    (Eigen::Matrix3d() << 0.1, 0.01, -0.02, 0.01, 0.12, 0.015, -0.02, 0.015, 0.2).finished();
using Legs = std::array<int, 4>;
const std::array<Eigen::Vector2d, 4> kFeet = {
    Eigen::Vector2d(0.3, 0.2), Eigen::Vector2d(0.3, -0.25), Eigen::Vector2d(-0.3, 0.2),
    Eigen::Vector2d(-0.35, -0.2)};
constexpr Legs kInOrder = {0, 1, 2, 3};
constexpr std::array<double, 4> kEqual = {1, 1, 1, 1}, kUnequal = {1, 2, 0.5, 3};

std::string leg(int i) { return fmt::format("leg{}", i + 1); }

Mechanism table(const Legs& order, const std::string& policy, const std::array<double, 4>& shares) {
  Mechanism m("table");
  m.body("top", {.mass = kMass,
                 .at = {kCentre[0], kCentre[1], kHeight},
                 .inertia = {kInertia(0, 0), kInertia(0, 1), kInertia(0, 2), kInertia(1, 1),
                             kInertia(1, 2), kInertia(2, 2)}});
  m.free("root", "top", {.at = {0, 0, kHeight}});
  for (const int i : order) {
    const auto at = static_cast<size_t>(i);
    PointOptions options = {.at = {kFeet[at][0], kFeet[at][1], 0}, .friction = kFriction};
    if (policy == "stated") options.share = shares[at];
    m.point(leg(i), "top", options);
  }
  m.distribution(policy);
  m.sensor("centre", "top", {kCentre[0], kCentre[1], kHeight});
  return m;
}

// Of the table that lies flat, in its axes: what moves it, and its loads, share_i (p + q x_i + r
// y_i).
struct Flat {
  std::array<double, 4> shares;
  std::array<double, 4> loads = {};

  // (x, y, angle, u, v, w): of the mass centre, velocities along the table.
  Eigen::Matrix<double, 6, 1> rate(const Eigen::Matrix<double, 6, 1>& at) {
    const double u = at[3], v = at[4], w = at[5];
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();  // of p, q, r and the angular acceleration
    Eigen::Vector4d b(kMass * kGravity, -kInertia(1, 2) * w * w, kInertia(0, 2) * w * w, 0);
    std::array<Eigen::Vector2d, 4> along;
    for (size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d r = kFeet[i] - kCentre;
      along[i] = Eigen::Vector2d(u - w * r[1], v + w * r[0]).normalized();
      const Eigen::Vector2d f = -kFriction * along[i];  // of a load of 1
      const Eigen::Vector3d moment =
          Eigen::Vector3d(r[0], r[1], -kHeight).cross(Eigen::Vector3d(f[0], f[1], 1));
      const Eigen::RowVector3d plane = shares[i] * Eigen::RowVector3d(1, kFeet[i][0], kFeet[i][1]);
      a.block<1, 3>(0, 0) += plane;
      for (int k = 0; k < 3; ++k) a.block<1, 3>(1 + k, 0) += moment[k] * plane;
    }
    a(1, 3) = -kInertia(0, 2);
    a(2, 3) = -kInertia(1, 2);
    a(3, 3) = -kInertia(2, 2);
    const Eigen::Vector4d found = a.fullPivLu().solve(b);
    Eigen::Vector2d force(0, 0);
    for (size_t i = 0; i < 4; ++i) {
      loads[i] = shares[i] * (found[0] + found[1] * kFeet[i][0] + found[2] * kFeet[i][1]);
      force -= kFriction * loads[i] * along[i];
    }
    const double c = std::cos(at[2]), s = std::sin(at[2]);
    Eigen::Matrix<double, 6, 1> out;
    out << c * u - s * v, s * u + c * v, w, force[0] / kMass + w * v, force[1] / kMass - w * u,
        found[3];
    return out;
  }
};

Result slide(const Mechanism& m, double until) {
  return simulate(m)
      .tolerance({.relative = 1e-11})
      .slip()
      .start({.velocity = {0, 0, 3, 1 + 0.02 * 3, 0.5 - 0.05 * 3, 0}})
      .until(until)
      .run();
}

void expect_planar_motion(const Result& run, const std::array<double, 4>& shares) {
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  Flat flat{.shares = shares};
  Eigen::Matrix<double, 6, 1> at;
  at << kCentre, 0, 1 + 0.02 * 3 - 3 * kCentre[1], 0.5 - 0.05 * 3 + 3 * kCentre[0], 3;
  const double end = run.last.time;
  constexpr int steps = 4000;
  const double h = end / steps;
  for (int k = 0; k < steps; ++k) {
    const auto k1 = flat.rate(at), k2 = flat.rate(at + h / 2 * k1), k3 = flat.rate(at + h / 2 * k2),
               k4 = flat.rate(at + h * k3);
    at += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  flat.rate(at);
  const auto last = [&](const std::string& name) { return run.trajectory.column(name).back(); };
  EXPECT_NEAR(last("centre.x"), at[0], 1e-10);
  EXPECT_NEAR(last("centre.y"), at[1], 1e-10);
  EXPECT_NEAR(std::atan2(last("R21"), last("R11")), at[2], 1e-10);
  EXPECT_NEAR(last("w3"), at[5], 1e-9);
  for (int i = 0; i < 4; ++i)
    EXPECT_NEAR(last(leg(i) + ".reaction3"), flat.loads[static_cast<size_t>(i)], 1e-8) << i;
}

TEST(FourLegs, SlideAndTurnAsTheirLoadsHaveIt) {
  expect_planar_motion(slide(table(kInOrder, "equal_compliance", kEqual), 0.3), kEqual);
}

TEST(FourLegs, StatedSharesAreTheirCompliances) {
  expect_planar_motion(slide(table(kInOrder, "stated", kUnequal), 0.3), kUnequal);
}

// To rest, where friction holds all four; no trace of an order of the legs.
TEST(FourLegs, RestInAnyOrder) {
  const Result one = slide(table(kInOrder, "equal_compliance", kEqual), 2);
  const Result other = slide(table({2, 0, 3, 1}, "equal_compliance", kEqual), 2);
  ASSERT_TRUE(one.status.ok) << one.status.reason;
  ASSERT_TRUE(other.status.ok) << other.status.reason;
  EXPECT_LT(one.steps, 200);
  for (const char* const name : {"centre.x", "centre.y", "R11"})
    EXPECT_NEAR(one.trajectory.column(name).back(), other.trajectory.column(name).back(), 1e-9);
  double weight = 0;
  for (int i = 0; i < 4; ++i) {
    weight += one.trajectory.column(leg(i) + ".reaction3").back();
    EXPECT_EQ(one.trajectory.column(leg(i) + ".mode").back(), 1);
  }
  EXPECT_NEAR(weight, kMass * kGravity, 1e-9);
  EXPECT_LT(std::abs(one.trajectory.column("w3").back()), 1e-12);
}

// Sleds with a low mass centre, four to six legs, each with a friction of its own, at any velocity
// along the ground.
class Sleds {
 public:
  Simulation next() {
    const int k = made_++;
    Mechanism m("sled");
    const double x = 0.1 * random(), y = 0.1 * random();
    m.body("sled", {.mass = 2, .at = {x, y, 0.1}, .inertia = {0.1, 0.12, 0.2}});
    m.free("root", "sled", {.at = {0, 0, 0.1}});
    for (int i = 0; i < 4 + k % 3; ++i) {
      const double angle = 2 * M_PI * (i + 0.3 * random()) / (4 + k % 3);
      m.point(leg(i), "sled",
              {.at = {0.4 * std::cos(angle), 0.4 * std::sin(angle), 0},
               .friction = 0.35 + 0.3 * random()});
    }
    const double w = 5 * random(), v = random();
    return simulate(m).slip().start({.velocity = {0, 0, w, v, random(), 0}}).every(1000);
  }

 private:
  double random() { return uniform_(engine_); }
  std::mt19937 engine_{5};
  std::uniform_real_distribution<double> uniform_{-1, 1};
  int made_ = 0;
};

// To rest, but for the few of 60 that end with a reason where slips of several legs end at once.
TEST(FourLegs, ComeToRest) {
  Sleds sleds;
  int rested = 0;
  for (int k = 0; k < 60; ++k) {
    const Result run = sleds.next().until(20).run();
    if (!run.status.ok) continue;
    ++rested;
    EXPECT_LT(Eigen::Map<const Eigen::VectorXd>(run.last.velocity.data(), 6).norm(), 1e-11) << k;
    EXPECT_LT(run.steps, 400) << k;
  }
  EXPECT_GE(rested, 58);
}

// Each of them, in steps of one size, and as far.
TEST(FourLegs, ComeToRestBySteps) {
  Sleds sleds, again;
  for (int k = 0; k < 4; ++k) {
    const Result run = sleds.next().scheme("nonsmooth").step(0.02).until(2).run();
    ASSERT_TRUE(run.status.ok) << k << run.status.reason;
    EXPECT_LT(Eigen::Map<const Eigen::VectorXd>(run.last.velocity.data(), 6).norm(), 1e-11) << k;
    const Result exact = again.next().until(2).run();
    if (!exact.status.ok) continue;
    for (size_t i = 0; i < exact.last.coordinates.size(); ++i)
      EXPECT_NEAR(run.last.coordinates[i], exact.last.coordinates[i], 2e-3) << k << " " << i;
  }
}

TEST(FourLegs, EndWhereTheyMayNotShare) {
  const Result run = slide(table(kInOrder, "refuse", kEqual), 0.3);
  EXPECT_FALSE(run.status.ok);
  EXPECT_THAT(run.status.reason, HasSubstr("undetermined_reactions: the reactions of leg1, leg2"));
}

// No leg holds the table for being the first: what is not named is 0.
TEST(FourLegs, NoneOfThemIsAPivot) {
  for (const Legs& order : {kInOrder, Legs{3, 1, 0, 2}}) {
    const Result run =
        simulate(table(order, "equal_compliance", kEqual)).start("v1", 1).slip().until(0.01).run();
    ASSERT_TRUE(run.status.ok) << run.status.reason;
    for (const char* const name : {"w1", "w2", "w3", "v2", "v3"})
      EXPECT_NEAR(run.trajectory.column(name).front(), 0, 1e-13) << name;
    EXPECT_NEAR(run.trajectory.column("v1").front(), 1, 1e-13);
  }
}

// What is named of a start is kept, and the legs stay on the ground, which slip.
TEST(FourLegs, ANamedStartStaysOnTheGround) {
  const Result run = simulate(table(kInOrder, "equal_compliance", kEqual))
                         .start("v1", 1)
                         .start("w3", 1)
                         .slip()
                         .until(0.01)
                         .run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  for (const char* const name : {"w1", "w2", "v3"})
    EXPECT_NEAR(run.trajectory.column(name).front(), 0, 1e-13) << name;
  EXPECT_NEAR(run.trajectory.column("v1").front(), 1, 1e-13);
  EXPECT_NEAR(run.trajectory.column("w3").front(), 1, 1e-13);
}

// A push F(t) = 1.2 m g (1 - (t - 1)^2) down at one of four feet takes the load of the one across
// it, (m g - F)/4, where it is m g, and gives it back; the two beside it bear m g/2 each meanwhile,
// it F.
TEST(FourLegs, OneIsLiftedAndBearsAgain) {
  Mechanism m("table");
  m.body("top", {.mass = kMass, .at = {0, 0, kHeight}, .box = {0.8, 0.6, 0.05}});
  m.free("root", "top", {.at = {0, 0, kHeight}});
  for (const int i : kInOrder)
    m.point(leg(i), "top",
            {.at = {i < 2 ? 0.4 : -0.4, i % 2 == 0 ? 0.3 : -0.3, 0}, .friction = kFriction});
  const auto none = [](const SignalInput&) { return 0.0; };
  const auto push = [](double t) { return 1.2 * kMass * kGravity * (1 - (t - 1) * (t - 1)); };
  const auto down = [push](const SignalInput& at) { return -push(at.t); };
  m.force("push", "top", {.at = {0.4, 0.3, kHeight}, .along = {none, none, down}});
  const Result r = simulate(m).slip().until(2).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  ASSERT_EQ(r.events.size(), 2);
  EXPECT_EQ(r.events[0].name, "leg4.opens");
  EXPECT_EQ(r.events[1].name, "leg4.rolls");
  const double half = std::sqrt(1 - 1 / 1.2);
  EXPECT_NEAR(r.events[0].time, 1 - half, 1e-9);
  EXPECT_NEAR(r.events[1].time, 1 + half, 1e-9);
  for (size_t i = 0; i < r.trajectory.rows(); ++i) {
    const auto at = [&](const std::string& name) { return r.trajectory.column(name)[i]; };
    const double force = push(at("t")), weight = kMass * kGravity;
    const bool lifted = force > weight;
    EXPECT_EQ(at("leg4.mode"), lifted ? 0 : 1) << at("t");
    EXPECT_NEAR(at("leg4.reaction3"), lifted ? 0 : (weight - force) / 4, 1e-10);
    EXPECT_NEAR(at("leg1.reaction3"), lifted ? force : (weight + 3 * force) / 4, 1e-10);
    EXPECT_NEAR(at("leg2.reaction3"), lifted ? weight / 2 : (weight + force) / 4, 1e-10);
    EXPECT_NEAR(at("v3"), 0, 1e-14);
  }
}

}  // namespace
}  // namespace hamel
