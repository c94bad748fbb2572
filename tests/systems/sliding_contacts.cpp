// Contacts that slide, open and strike, against motions in closed form.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include <hamel/groups/se2.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

using testing::ElementsAre;

constexpr double kPi = std::numbers::pi;
constexpr double kGravity = 9.81;
// Of a run at rtol 1e-10, whose errors add up over some hundred steps.
constexpr double kOfTolerance = 1e-9;

// A homogeneous ball: k = I/(m R^2) = 2/5.
Simulation ball(double mu, double radius, double e = 0) {
  auto out = simulate("rolling_ball");
  out.set("radius", radius).set("inertia", 0.4 * radius * radius);
  out.set("friction", mu).set("restitution", e).slip().tolerance({.relative = 1e-10});
  return out;
}
Start at_height(double z, std::vector<double> velocity) {
  return {.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, z}, .velocity = std::move(velocity)};
}
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
// What every run with friction holds: no friction does work on the body, and the energy balance.
void expect_laws(const Result& r, double balance = kOfTolerance) {
  EXPECT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_LT(r.energy_error_max, balance);
  for (const double power : r.trajectory.column("reaction_power")) EXPECT_LE(power, 1e-12);
  if (r.system->mechanics->holonomic_rows() > 0) {
    EXPECT_LT(r.holonomic_max, 1e-11);  // (a slip that ends moves the body by its last velocity)
  }
}

TEST(SlidingBall, RollsAfterTheTimeOfCoriolis) {
  const Result r = ball(0.2, 0.03).start(at_height(0.03, {40, -60, 7, 2, 0, 0})).until(1).run();
  expect_laws(r);
  ASSERT_THAT(names(r), ElementsAre("contact.rolls"));
  EXPECT_NEAR(time_of(r, "contact.rolls"), 0.5803075242513841, 1e-11);
  // v0 - k/(1 + k) s0 with s0 = (v_x - R w_y, v_y + R w_x).
  const Vec<2> slip(2 + 0.03 * 60, 0.03 * 40), end = Vec<2>(2, 0) - 2.0 / 7 * slip;
  EXPECT_NEAR(r.last.velocity[3], end[0], 1e-11);
  EXPECT_NEAR(r.last.velocity[4], end[1], 1e-11);
  EXPECT_EQ(r.trajectory.column("contact.mode").front(), 2);
  EXPECT_EQ(r.trajectory.column("contact.mode").back(), 1);
}

// Whatever the spin, friction takes the kinetic energy of the slip: m k/(1 + k) is the mass that a
// force along the ground moves at the contact. A ball that strikes loses some of it in strikes.
TEST(SlidingBall, FrictionTakesTheEnergyOfTheSlip) {
  const auto work = [](const Result& r) {
    return r.trajectory.column("contact.friction_work").back();
  };
  const Vec<2> slip(2 + 0.03 * 60, 0.03 * 40);
  const double energy = 0.5 * 2.0 / 7 * slip.squaredNorm();
  for (const std::string scheme : {"dop853", "nonsmooth"}) {
    auto run = simulate("rolling_ball");
    run.set("radius", 0.03).set("inertia", 0.4 * 9e-4).set("friction", 0.2).slip().until(1);
    run.start(at_height(0.03, {40, -60, 7, 2, 0, 0}));
    if (scheme == "nonsmooth") run.scheme(scheme).step(1e-3);
    else run.tolerance({.relative = 1e-10});
    const Result r = run.run();
    EXPECT_NEAR(work(r), -energy, scheme == "nonsmooth" ? 1e-3 : 1e-8) << scheme;
    EXPECT_NEAR(work(r), r.trajectory.column("work").back(), 1e-14) << scheme;
  }
  const Result bounces =
      ball(0.02, 0.03, 0.5).start(at_height(0.5, {0, 0, 0, 2, 0, 0})).until(2).run();
  EXPECT_LT(work(bounces), -0.01);
  EXPECT_GT(work(bounces), -0.5 * 2.0 / 7 * 4);
}

// A parabola along the slip at first.
TEST(SlidingBall, RunsAParabola) {
  const Result r = ball(0.2, 0.03).start(at_height(0.03, {40, -60, 7, 2, 0, 0})).until(0.5).run();
  const Vec<2> slip(2 + 0.03 * 60, 0.03 * 40), d = slip / slip.norm();
  EXPECT_NEAR(r.last.coordinates[9], 2 * 0.5 - 0.2 * kGravity * 0.125 * d[0], 1e-11);
  EXPECT_NEAR(r.last.coordinates[10], -0.2 * kGravity * 0.125 * d[1], 1e-11);
}

TEST(SlidingBall, EndVelocityWhateverTheGround) {
  for (const auto& [mu, e, height] : {std::tuple{0.1, 0.0, 0.0}, std::tuple{0.5, 0.3, 0.0},
                                      std::tuple{0.2, 0.6, 0.3}, std::tuple{0.05, 0.8, 0.1}}) {
    const Result r =
        ball(mu, 0.03, e).start(at_height(0.03 + height, {40, -60, 7, 2, 0, 0})).until(6).run();
    EXPECT_TRUE(r.status.ok) << r.status.reason;
    const Vec<2> slip(2 + 0.03 * 60, 0.03 * 40), end = Vec<2>(2, 0) - 2.0 / 7 * slip;
    EXPECT_NEAR(r.last.velocity[3], end[0], kOfTolerance) << mu << ' ' << e;
    EXPECT_NEAR(r.last.velocity[4], end[1], kOfTolerance) << mu << ' ' << e;
    EXPECT_EQ(r.trajectory.column("contact.mode").back(), 1) << mu << ' ' << e;
  }
}

// Dropped from rest the ground bears m g t in all, in bounces or not, so that the time is the same.
TEST(SlidingBall, BouncesDoNotChangeTheTime) {
  const Result r =
      ball(0.2, 0.03, 0.5).start(at_height(0.05, {40, -60, 7, 2, 0, 0})).until(1).run();
  EXPECT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_NEAR(r.events.back().time, 0.5803075242513841, 1e-10);
  EXPECT_EQ(r.events.back().name, "contact.rolls");
  EXPECT_EQ(r.events[r.events.size() - 2].name, "contact.slides");  // the impacts have ended
}

// Set sliding without spin the body ends with 1/(1 + k) of its velocity.
TEST(SlidingBodies, SetSlidingWithoutSpin) {
  const Result r = ball(0.3, 0.1).start(at_height(0.1, {0, 0, 0, 2, 0, 0})).until(1).run();
  EXPECT_NEAR(r.last.velocity[3] / 2, 5.0 / 7, 1e-11);
  for (const double k : {0.5, 1.0}) {  // disk, hoop
    const FallingDisk body{.mass = 1,
                           .radius = 0.5,
                           .axial_inertia = k * 0.25,
                           .diametral_inertia = k * 0.125,
                           .ground = {.friction = 0.3, .restitution = {}}};
    Start start = body.at_speed(2);
    for (size_t i = 0; i < 3; ++i) start.velocity[i] = 0;
    const Result rolls =
        simulate(body).start(start).slip().tolerance({.relative = 1e-10}).until(1).run();
    expect_laws(rolls);
    ASSERT_THAT(names(rolls), ElementsAre("contact.rolls"));
    const Vec<3> v(rolls.last.velocity.data() + 3);
    EXPECT_NEAR(v.norm() / 2, 1 / (1 + k), 1e-11) << k;
  }
}

// A ball with spin dropped on the ground; u is the velocity along x. Source: Capobianco, Harsch,
// Eugster, Leine, A nonsmooth generalized-alpha method (2021), the bouncing ball.
TEST(DroppedBall, SlidesAndRolls) {
  const Result r = ball(0.2, 0.1).start(at_height(1, {0, 50, 0, 0, 0, 0})).until(1).run();
  ASSERT_THAT(names(r), ElementsAre("contact.strikes", "contact.slides", "contact.rolls"));
  EXPECT_NEAR(time_of(r, "contact.strikes"), 0.4283529368781187, 1e-13);
  EXPECT_NEAR(time_of(r, "contact.rolls"), 0.7281199942, 1e-10);
  EXPECT_NEAR(r.last.velocity[3], 10.0 / 7, 1e-11);
  EXPECT_NE(r.events[0].velocity, r.events[0].velocity_after);
  EXPECT_EQ(r.trajectory.column("contact.mode").front(), 0);
}
TEST(DroppedBall, SticksAtOnce) {
  const Result r = ball(0.2, 0.1).start(at_height(1, {0, 10, 0, 0, 0, 0})).until(0.6).run();
  ASSERT_THAT(names(r), ElementsAre("contact.strikes", "contact.rolls"));
  EXPECT_NEAR(r.last.velocity[3], 2.0 / 7, 1e-13);
}

// All impacts of a ball from the height h end at sqrt(2 h/g) (1 + e)/(1 - e).
TEST(BouncingBall, ItsImpactsEnd) {
  const Result r = ball(0.2, 0.1, 0.9).start(at_height(1.1, {0, 0, 0, 0, 0, 0})).until(9).run();
  EXPECT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_NEAR(r.events.back().time, 8.578949178728, 1e-8);
  EXPECT_EQ(r.events.back().name, "contact.rolls");
  EXPECT_NEAR(r.events[0].time, std::sqrt(2 / kGravity), 1e-14);
  EXPECT_NEAR(r.events[1].time, std::sqrt(2 / kGravity) * (1 + 2 * 0.9), 1e-12);
  EXPECT_GT(r.events.size(), 100U);
  EXPECT_EQ(r.trajectory.column("contact.mode").back(), 1);
  EXPECT_THAT(r.notes, testing::Contains(testing::HasSubstr("chatter")));
}
// One flight that a step of the controller would span.
TEST(BouncingBall, ALongFlightIsNotMissed) {
  const Result r = ball(0, 0.1, 1).start(at_height(0.1, {0, 0, 0, 1, 0, 3})).until(20).run();
  EXPECT_EQ(r.events.size(), static_cast<size_t>(20 * kGravity / 6));
  EXPECT_NEAR(r.events.back().time, 2 * 3 / kGravity * static_cast<double>(r.events.size()), 1e-9);
}

// The force across the blade is m J v w/(J + m a^2), at most m g mu.
TEST(SleighWithWeight, SlipsWhereTheForceIsLarger) {
  const double most = 0.2018367657562;
  for (const double factor : {1.001, 0.999}) {
    const ChaplyginSleigh sleigh{.mass = 1, .moment = 1, .offset = 0.2, .friction = most * factor};
    const Result r = simulate(sleigh)
                         .start({.velocity = {2, 0.2, 0}})
                         .tolerance({.relative = 1e-10})
                         .until(10)
                         .run();
    expect_laws(r);
    if (factor > 1) EXPECT_TRUE(r.events.empty());
    else EXPECT_THAT(names(r), ElementsAre("blade.slides", "blade.rolls"));
  }
}
TEST(SleighWithWeight, LateralForceDecides) {
  const ChaplyginSleigh sleigh{.mass = 1, .moment = 1, .offset = 0.2, .friction = 0.1};
  const Result r = simulate(sleigh)
                       .start({.velocity = {2, 0.2, 0}})
                       .tolerance({.relative = 1e-10})
                       .stop_at({"blade.slides"})
                       .until(10)
                       .run();
  EXPECT_TRUE(r.stopped_by_event);
  const double force = r.last.velocity[0] * r.last.velocity[1] / 1.04;
  EXPECT_NEAR(force, 0.1 * kGravity, 1e-9);
}

// While nothing slips the motion is that of the ideal contact.
TEST(EnoughFriction, IsAnIdealContact) {
  for (const char* name : {"falling_disk", "rattleback", "chaplygin_sleigh"}) {
    auto ideal = simulate(name), rough = simulate(name);
    ideal.tolerance({.relative = 1e-11}).until(0.5);
    rough.set("friction", 20).tolerance({.relative = 1e-11}).until(0.5);
    const Result a = ideal.run(), b = rough.run();
    EXPECT_TRUE(b.status.ok) << name << ": " << b.status.reason;
    EXPECT_TRUE(b.events.empty()) << name;
    for (size_t i = 0; i < a.last.velocity.size(); ++i)
      EXPECT_NEAR(a.last.velocity[i], b.last.velocity[i], 1e-9) << name << ' ' << i;
    // Its reactions too.
    for (const char* column : {"lambda1", "reaction_power"})
      EXPECT_NEAR(a.trajectory.column(column).back(), b.trajectory.column(column).back(), 1e-7)
          << name << ' ' << column;
  }
}

// Turning the start about the vertical turns the motion.
TEST(SlidingDisk, MovesTheSameInAllDirections) {
  const FallingDisk disk{.ground = {.friction = 0.3, .restitution = 0.2}};
  const auto end_of = [&](double angle) {
    auto g = SE3::from_coordinates(disk.start().configuration);
    const Mat<3, 3> turn{
        {std::cos(angle), -std::sin(angle), 0}, {std::sin(angle), std::cos(angle), 0}, {0, 0, 1}};
    g.rotation = turn * g.rotation;
    const Result r =
        simulate(disk)
            .start({.configuration = SE3::coordinates(g), .velocity = {0.1, 0.4, 5, 1, 0, 0}})
            .slip()
            .tolerance({.relative = 1e-10})
            .until(1)
            .run();
    EXPECT_TRUE(r.status.ok) << r.status.reason;
    EXPECT_FALSE(r.events.empty());
    const auto end = SE3::from_coordinates(r.last.coordinates);
    return Vec<3>(turn.transpose() * end.translation);
  };
  const Vec<3> straight = end_of(0);
  for (const double angle : {0.3, 1.0, 2.0, kPi / 2})
    EXPECT_LT((end_of(angle) - straight).norm(), 1e-12) << angle;
}

// A disk set down sliding takes few steps, and its ends at two tolerances agree.
TEST(SlidingDisk, SlidesThenRolls) {
  const FallingDisk disk{.ground = {.friction = 0.3, .restitution = {}}};
  Start start = disk.start();
  start.velocity[3] += 1.5;  // along the ground
  const auto run = [&](double rtol) {
    return simulate(disk).start(start).slip().tolerance({.relative = rtol}).until(2).run();
  };
  const Result r = run(1e-10), finer = run(1e-12);
  expect_laws(r);
  EXPECT_THAT(names(r), ElementsAre("contact.rolls"));
  EXPECT_LT(r.steps, 200);
  for (size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(r.last.coordinates[9 + i], finer.last.coordinates[9 + i], 1e-8);
}

// A rolling disk that falls starts to slide, and rolls again.
TEST(SlidingDisk, BeginsToSlideInSpace) {
  const FallingDisk disk{.ground = {.friction = 0.3, .restitution = {}}};
  const auto run = [&](double rtol) {
    return simulate(disk)
        .start({.velocity = {0.1, 0.4, 5, 1.5, 0, 0}})
        .slip()
        .tolerance({.relative = rtol})
        .until(1)
        .run();
  };
  const Result r = run(1e-10), finer = run(1e-12);
  EXPECT_THAT(names(r), ElementsAre("contact.strikes", "contact.rolls", "contact.slides",
                                    "contact.rolls", "contact.slides"));
  EXPECT_LT(r.energy_error_max, 1e-6);  // of its quadrature, where the slip turns at a low speed
  EXPECT_NEAR(r.events[2].time, finer.events[2].time, 1e-9);
  for (size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(r.last.coordinates[9 + i], finer.last.coordinates[9 + i], 2e-9);
}

// A slender rod that slides on a rough plane on one end, a system of a user's own: the coefficient
// of its normal reaction, (1 + 3 cos(th) (cos(th) - mu sin(th)))/m, is negative somewhere from mu =
// 4/3 on, first at tan(th) = 2. Source: Painleve, Sur les lois du frottement de glissement (1895).
struct Rod {
  using Group = SE2;
  double mu = 1;
  static constexpr double half = 0.5;
  static std::string name() { return "rod"; }
  static Mat<3, 3> inertia() { return Vec<3>(half * half / 3, 1, 1).asDiagonal(); }
  // The end at (-half, 0) in the rod moves along x.
  static auto constraints(const auto& g) {
    using T = std::decay_t<decltype(g.translation[0])>;
    const T c = g.rotation.c, s = g.rotation.s;
    return MatT<T, 1, 3>(s * half, c, -s);
  }
  static auto holonomic(const auto& g) {
    using T = std::decay_t<decltype(g.translation[0])>;
    return VecT<T, 1>(g.translation[1] - half * g.rotation.s);
  }
  static auto potential(const auto& g) { return kGravity * g.translation[1]; }
  void contacts(auto& add) const { add({.tangential = {0}, .normal = 1, .friction = mu}); }
};

Result slide_rod(double mu) {
  const double angle = std::atan(2.0);
  const double c = std::cos(angle), s = std::sin(angle);
  // The end slides at 1 m/s in the direction in which friction raises the load.
  return simulate(Rod{.mu = mu})
      .start({.configuration = {angle, 0, Rod::half * s}, .velocity = {0, -c, s}})
      .slip()
      .tolerance({.relative = 1e-10})
      .until(0.001)
      .run();
}

TEST(Rod, NoMotionBehindPainlevesLimit) {
  EXPECT_TRUE(slide_rod(1.333).status.ok) << slide_rod(1.333).status.reason;
  const Result r = slide_rod(1.3334);
  EXPECT_FALSE(r.status.ok);
  EXPECT_THAT(r.status.reason,
              testing::StartsWith("painleve: no acceleration of contact 'contact' satisfies "));
  EXPECT_THAT(r.status.reason, testing::HasSubstr("friction = 1.3334"));
}

}  // namespace
}  // namespace hamel
