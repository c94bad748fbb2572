// Closed chains along trajectories, against motions that are known by other
// means.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

using Eigen::Vector2d;

constexpr double kGravity = 9.81;

// In the plane of x and z, a turn about y.
Vector2d turned(double angle, const Vector2d& v) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v[0] + s * v[1], -s * v[0] + c * v[1]};
}
Vector2d turning(const Vector2d& v) { return {v[1], -v[0]}; }  // at unit rate
double between(const Vector2d& from, const Vector2d& to) {
  return std::atan2(to[0] * from[1] - to[1] * from[0], from.dot(to));
}

// A four-bar: crank, coupler and rocker, of which the angle of the crank determines all.
struct FourBar {
  struct Bar {
    double mass, moment;
    Vector2d centre;
  };
  Bar crank{1.0, 0.02, {0.05, 0.25}}, coupler{1.5, 0.03, {0.5, 0.65}},
      rocker{0.8, 0.016, {1.05, 0.4}};
  Vector2d low{0.1, 0.5}, high{0.9, 0.8}, foot{1.2, 0};  // the joints, beside the origin

  Mechanism by_parts(JointOptions at_crank = {}) const {
    Mechanism m("four-bar");
    const auto in_space = [](const Vector2d& v) { return Point{v[0], 0, v[1]}; };
    const auto add = [&](const std::string& name, const Bar& bar) {
      m.body(name,
             {.mass = bar.mass, .at = in_space(bar.centre), .inertia = {0.03, bar.moment, 0.03}});
    };
    add("crank", crank);
    add("coupler", coupler);
    add("rocker", rocker);
    const Point axis = {0, 1, 0};
    at_crank.axis = axis;
    m.hinge("a", kWorld, "crank", at_crank);
    m.hinge("b", "crank", "coupler", {.at = in_space(low), .axis = axis});
    m.hinge("d", kWorld, "rocker", {.at = in_space(foot), .axis = axis});
    m.loop("c", "coupler", "rocker", {.at = in_space(high), .axis = axis});
    m.start({{"a.rate", 2}});
    return m;
  }

  // At an angle of the crank: those of coupler and rocker in the world, V, and twice the kinetic
  // energy at unit rate.
  struct Seen {
    double coupler, rocker, potential, moment;
  };
  Seen at(double angle) const {
    const Vector2d b = turned(angle, low), apart = foot - b;
    const double r = (high - low).norm(), s = (high - foot).norm(), d = apart.norm();
    const double along = (r * r - s * s + d * d) / (2 * d),
                 across = std::sqrt(r * r - along * along);
    const Vector2d e = apart / d;
    const Vector2d c = b + along * e + across * Vector2d(-e[1], e[0]);  // the branch above
    Seen out{between(high - low, c - b), between(high - foot, c - foot), 0, 0};
    // b' + coupler' x (c - b) = rocker' x (c - foot)
    Eigen::Matrix2d a;
    a << -turning(c - b), turning(c - foot);
    const Vector2d rates = a.inverse() * turning(b);
    const auto add = [&](const Bar& bar, const Vector2d& x, const Vector2d& v, double rate) {
      out.potential += bar.mass * kGravity * x[1];
      out.moment += bar.mass * v.squaredNorm() + bar.moment * rate * rate;
    };
    const Vector2d x = turned(angle, crank.centre), y = turned(out.coupler, coupler.centre - low),
                   z = turned(out.rocker, rocker.centre - foot);
    add(crank, x, turning(x), 1);
    add(coupler, b + y, turning(b) + rates[0] * turning(y), rates[0]);
    add(rocker, foot + z, rates[1] * turning(z), rates[1]);
    return out;
  }
};

// No row of it is nonholonomic. Its angles, the rate of its energy, and the time that it takes, by
// quadrature.
TEST(MechanismMotions, FourBarFollowsItsAngleEquation) {
  const FourBar bars;
  const double until = 0.25;
  const Simulation run = simulate(bars.by_parts()).compose("kahan_li6").step(0.0025).until(until);
  EXPECT_EQ(run.build().system().mechanics->holonomic_rows(), 2);
  const Result result = Simulation(run).run();
  ASSERT_TRUE(result.status.ok) << result.status.reason;
  const auto& angles = result.last.coordinates;
  const FourBar::Seen first = bars.at(0), last = bars.at(angles[0]);
  EXPECT_GT(angles[0], 0.3);
  EXPECT_NEAR(angles[0] + angles[1], last.coupler, 1e-11);
  EXPECT_NEAR(angles[2], last.rocker, 1e-11);
  const double energy = 0.5 * first.moment * 4 + first.potential;
  const auto rate = [&](double angle) {
    const FourBar::Seen seen = bars.at(angle);
    return std::sqrt(2 * (energy - seen.potential) / seen.moment);
  };
  EXPECT_NEAR(result.last.velocity[0], rate(angles[0]), 1e-9);
  double time = 0;  // by Simpson's rule
  constexpr int kPieces = 2000;
  for (int i = 0; i <= kPieces; ++i) {
    const double weight = i == 0 || i == kPieces ? 1 : i % 2 == 1 ? 4 : 2;
    time += weight / rate(angles[0] * i / kPieces);
  }
  EXPECT_NEAR(time * angles[0] / (3 * kPieces), until, 1e-10);
}

TEST(MechanismMotions, FourBarFromRestBySmallSteps) {
  Mechanism bars = FourBar().by_parts();
  bars.start({{"a.rate", 0}});
  const Result exact = simulate(bars).scheme("dop853").tolerance({1e-12}).until(0.02).run();
  for (const double h : {2e-3, 1e-3, 1e-4}) {
    const Result r = simulate(bars).step(h).until(0.02).run();
    ASSERT_TRUE(r.status.ok) << h << ": " << r.status.reason;
    EXPECT_NEAR(r.last.velocity[0], exact.last.velocity[0], 10 * h * h + 1e-9) << h;
  }
  const Result chosen = simulate(bars).tolerance({1e-8}).until(0.02).run();
  EXPECT_TRUE(chosen.status.ok) << chosen.status.reason;
}

// A damped linkage without weight comes to rest where its spring does: its momenta vanish, the
// round-off of the rows that close it does not.
TEST(MechanismMotions, FourBarComesToRest) {
  Mechanism bars = FourBar().by_parts({.stiffness = 20, .damping = 0.5});
  bars.gravity({0, 0, 0});
  for (const char* scheme : {"lift", "balance"}) {
    const Result r = simulate(bars).scheme(scheme).step(0.002).until(100).every(1000).run();
    ASSERT_TRUE(r.status.ok) << scheme << ": " << r.status.reason << ", t = " << r.status.time;
    for (const double angle : r.last.coordinates) EXPECT_NEAR(angle, 0, 1e-9) << scheme;
    for (const double rate : r.last.velocity) EXPECT_NEAR(rate, 0, 1e-9) << scheme;
  }
}

// Two links on a spring, without weight, on a head that rolls: in one of these steps the motion
// turns, so that the step itself moves next to nothing, which those of smaller size do.
TEST(MechanismMotions, TurnsWithinAStep) {
  Mechanism m("chain");
  m.gravity({0, 0, 0});
  m.body("head", {.mass = 1, .at = {0, 0, 0.1}, .inertia = {0.00104, 0.00771, 0.00833}});
  m.body("tail", {.mass = 1, .at = {-0.3, 0, 0.1}, .inertia = {0.00104, 0.00771, 0.00833}});
  m.free("space", "head", {.at = {0, 0, 0.1}});
  m.hinge("hinge", "head", "tail", {.at = {-0.15, 0, 0.1}, .axis = {0, 0, 1}, .stiffness = 50});
  m.ball("ball", "head", {.at = {0, 0, 0.1}, .radius = 0.1});
  m.start({{"v1", 0}, {"hinge.rate", 0.054}});
  const Result r = simulate(m).scheme("lift").step(0.001).until(30).every(1000).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason << ", t = " << r.status.time;
  EXPECT_LE(r.energy_error_max, 0.005);
}

// Two rods that close a triangle with the ground swing about its side there, 45 degrees from the
// vertical: 1/2 J phi'^2 - m g l/2 cos phi, J = J_t + m l^2/4 of both together.
TEST(MechanismMotions, TriangleSwingsAsAPhysicalPendulum) {
  const double mass = 1, length = 1, width = 0.05;
  Mechanism m("triangle");
  m.body("a", {.mass = mass, .at = {0, 0, -0.5}, .box = {width, width, length}});
  m.body("b", {.mass = mass, .at = {0.5, 0, -1}, .box = {length, width, width}});
  m.ball_joint("p", kWorld, "a", {});
  m.ball_joint("q", "a", "b", {.at = {0, 0, -1}});
  m.loop("r", "b", kWorld, {.at = {1, 0, -1}});
  const double rate = 2, half = std::numbers::sqrt2 / 2;
  // Neither rod spins about itself: b turns about the vertical alone, so that q.w1 is -p.w1.
  m.start({{"p.w1", rate * half}, {"p.w3", 0}, {"q.w1", -rate * half}});
  const double moment = mass * (length * length + width * width) / 12 + mass * length * length / 4;
  const double square = mass * kGravity * length / 2 / moment;  // of the small swing's rate
  const double modulus = rate / (2 * std::sqrt(square));        // sin of half the widest angle
  const double period = 4 * std::comp_ellint_1(modulus) / std::sqrt(square);
  const auto after = [&](double until) {
    const Result out = simulate(m).compose("kahan_li6").step(period / 400).until(until).run();
    EXPECT_TRUE(out.status.ok) << out.status.reason;
    return out;
  };
  const Result whole = after(period), quarter = after(period / 4);
  for (size_t i = 0; i < whole.last.coordinates.size(); ++i)
    EXPECT_NEAR(whole.last.coordinates[i], whole.config.start.configuration[i], 1e-9) << i;
  EXPECT_NEAR(whole.last.velocity[0], rate * half, 1e-8);
  EXPECT_NEAR(quarter.last.velocity[0], 0, 1e-8);
  // The corner between the rods is off the drawn plane by its distance from the side times the sine
  // of the angle.
  EXPECT_NEAR(std::abs(quarter.last.coordinates[5]), half * std::sin(2 * std::asin(modulus)), 1e-9);
}

// A prescribed angle is that of the start too, whenever that is.
/// The example on top of mechanism.hpp.
TEST(Mechanisms, RunTheExampleOfTheirHeader) {
  hamel::Mechanism m("scooter");
  const auto deck = m.body("deck", {.mass = 5, .at = {0.3, 0, 0.1}, .box = {0.8, 0.2, 0.05}});
  const auto fork = m.body("fork", {.mass = 2, .at = {0.7, 0, 0.4}, .inertia = {0.1, 0.1, 0.01}});
  m.planar("road", deck);
  m.hinge("steer", deck, fork, {.at = {0.7, 0, 0}, .axis = {0, 0, 1}});
  m.blade("rear", deck, {.at = {0, 0, 0}});
  m.blade("front", fork, {.at = {0.7, 0, 0}});
  m.start({{"speed", 2}, {"steer.angle", 0.3}});
  const Result run = hamel::simulate(m).until(10).run();
  ASSERT_TRUE(run) << run.status.reason;
  EXPECT_NEAR(run.config.start.velocity[0], 2 * std::tan(0.3) / 0.7, 1e-12);
}

/// A needle on a ship, 5e13 times as heavy: what holds and drives the small one is no round-off of
/// the large one.
TEST(Mechanisms, LightPartsOnHeavyOnes) {
  const double inertia = 1e-6, stiffness = 1e-6, angle = 0.5;
  const auto ship = [](bool upright) {
    Mechanism m("ship");
    m.gravity({0, 0, upright ? -kGravity : 0.0});
    m.body("ship", {.mass = 1e6, .inertia = {5e7, 5e7, 5e7}});
    m.planar("sea", "ship");
    return m;
  };
  Mechanism compass = ship(false);
  compass.body("needle", {.mass = 1e-3, .inertia = {inertia, inertia, inertia}});
  compass.hinge("needle", "ship", "needle", {.stiffness = stiffness});
  compass.start({{"needle.angle", angle}});
  const Result turned = simulate(compass).scheme("dop853").tolerance({1e-10}).until(3).run();
  ASSERT_TRUE(turned) << turned.status.reason;
  EXPECT_NEAR(turned.trajectory.column("needle.angle").back(), angle * std::cos(3.0), 1e-9);
  Mechanism clock = ship(true);
  clock.body("bob", {.mass = 1e-3, .at = {0, 0, 1}, .inertia = {1e-9, 1e-9, 1e-9}});
  clock.hinge("pivot", "ship", "bob", {.at = {0, 0, 2}, .axis = {0, 1, 0}});
  clock.start({{"pivot.angle", 1e-3}});
  const Result swung = simulate(clock).scheme("dop853").tolerance({1e-10}).until(1).run();
  ASSERT_TRUE(swung) << swung.status.reason;
  EXPECT_NEAR(swung.trajectory.column("pivot.angle").back(), 1e-3 * std::cos(std::sqrt(kGravity)),
              1e-9);
}

}  // namespace
}  // namespace hamel
