// Steady motions and their eigenvalues: against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "mechanism_systems.hpp"
#include "steady_motions.hpp"

namespace hamel {
namespace {

using namespace test;

// The wheel's frame turns with it: a symmetry of the body carries it along.
TEST(Steady, DiskRollsUprightAboveItsThreshold) {
  const FallingDisk disk;
  const double m = disk.mass, a = disk.diametral_inertia, c = disk.axial_inertia, r = disk.radius,
               g = disk.gravity;
  const SystemModel system = model("falling_disk");
  for (const double spin : {1.0, 3.0, 6.0}) {
    const SteadyMotion motion = at_speed(system, spin * r);
    const double square =
        (c * (c + m * r * r) * spin * spin - a * m * g * r) / (a * (a + m * r * r));
    ASSERT_EQ(motion.eigenvalues.size(), 2u) << spin;
    EXPECT_EQ(motion.neutral, 6);  // x, y, heading, its own axis; a family of circles
    const std::complex<double> expected = std::sqrt(std::complex<double>(-square));
    const double apart = std::min(std::abs(motion.eigenvalues[0] - expected),
                                  std::abs(motion.eigenvalues[0] + expected));
    EXPECT_LT(apart, 1e-10) << spin;
  }
  const SteadySweep sweep = sweep_steady(
      registry(), {1.0, 1.5, 2.0}, [](double v) { return simulate("falling_disk").speed(v); });
  ASSERT_EQ(sweep.crossings.size(), 1u);
  EXPECT_EQ(sweep.crossings[0].kind, Bifurcation::none);  // circles are beside it at every speed
  EXPECT_NEAR(sweep.crossings[0].value, r * std::sqrt(a * m * g * r / (c * (c + m * r * r))),
              1e-10);
}

TEST(Steady, DiskSpinsUprightAboveItsThreshold) {
  const FallingDisk disk;
  const double m = disk.mass, a = disk.diametral_inertia, r = disk.radius;
  const auto spinning = [&](double rate) {
    // Upright at pi/2: the vertical is the body's axis e2.
    return simulate("falling_disk").start(disk.rolling(0.5 * std::numbers::pi, {0, rate, 0}));
  };
  const SteadySweep sweep = sweep_steady(registry(), {3.0, 3.5, 4.0, 4.5}, spinning);
  ASSERT_EQ(sweep.crossings.size(), 1u);
  EXPECT_NEAR(sweep.crossings[0].value, std::sqrt(m * disk.gravity * r / (a + m * r * r)), 1e-10);
}

TEST(Steady, SegwayFallsAtItsRate) {
  for (const double speed : {0.0, 2.0}) {
    const SteadyMotion motion = at_speed(model("segway"), speed);
    ASSERT_EQ(motion.eigenvalues.size(), 2u);
    EXPECT_NEAR(motion.eigenvalues[0].real(), Segway{}.growth_rate(), 1e-10);
    EXPECT_NEAR(motion.eigenvalues[1].real(), -Segway{}.growth_rate(), 1e-10);
    ASSERT_FALSE(motion.modes[0].empty());
  }
}

// With the mass centre ahead of the blade straight motion decays at m a u / (I + m a^2), behind it
// it grows.
TEST(Steady, SleighTurnsRoundOrNot) {
  for (const double offset : {0.2, -0.2}) {
    ChaplyginSleigh sleigh;
    sleigh.offset = offset;
    const double u = 1.5;
    const SteadyMotion motion =
        steady_motion(registry(), simulate(sleigh).start({.velocity = {0, u, 0}}));
    ASSERT_EQ(motion.eigenvalues.size(), 1u);
    EXPECT_NEAR(motion.eigenvalues[0].real(),
                -sleigh.mass * offset * u / (sleigh.moment + sleigh.mass * offset * offset), 1e-10);
  }
}

// What no symmetry carries along: rest, at the rates of M q'' + K q = 0. Every coordinate of a
// commutative factor goes with a pair (zeta, -zeta) that moves nothing.
TEST(Steady, RestOnCommutativeGroups) {
  const SystemModel particle = data_system(registry(), R"(
group = "r2"
inertia = [1, 2]
potential = "0.5*x1^2 + 3*x2^2 + 0.1*x1*x2 + 0.01*x1^4"
)",
                                           "particle.toml");
  const SteadyMotion rest =
      steady_motion(registry(), particle, {.configuration = {0.3, 0.1}, .velocity = {0.1, 0.2}});
  ASSERT_TRUE(rest.found);
  ASSERT_EQ(rest.eigenvalues.size(), 4u);
  EXPECT_EQ(rest.neutral, 0);
  EXPECT_EQ(rest.growing(), 0);
  const Eigen::Matrix2d k{{1, 0.1}, {0.05, 3}};  // M^-1 K
  for (const auto& square : dense::eigenvalues(k))
    EXPECT_LT(nearest(rest.eigenvalues, std::sqrt(-square)), 1e-10);
  for (const double x : rest.element) EXPECT_NEAR(x, 0, 1e-12);
}

// A rod on its end, with a spring at its pivot: it stays upright from k = m g l on, and falls at
// sqrt((m g l - k) / J) before.
TEST(Steady, InvertedPendulum) {
  const auto rod = [](double stiffness) {
    Mechanism m("rod");
    const auto body = m.body("rod", {.mass = 1, .at = {0, 0, 0.5}, .inertia = {0.1, 0.1, 0.01}});
    m.hinge("pivot", "ground", body, {.axis = {0, 1, 0}, .stiffness = stiffness});
    return simulate(m).start({.configuration = {0}, .velocity = {0}});
  };
  const double mgl = 9.81 * 0.5;
  const SteadyMotion falls = steady_motion(registry(), rod(1));
  ASSERT_EQ(falls.eigenvalues.size(), 2u);
  EXPECT_NEAR(falls.eigenvalues[0].real(), std::sqrt((mgl - 1) / (0.1 + 0.25)), 1e-10);
  const SteadySweep sweep = sweep_steady(registry(), {1, 4, 7, 10}, rod);
  ASSERT_EQ(sweep.crossings.size(), 1u);
  EXPECT_NEAR(sweep.crossings[0].value, mgl, 1e-10);
  EXPECT_EQ(sweep.crossings[0].kind, Bifurcation::pitchfork);
}

// With products of inertia a Suslov body turns about no axis steadily but the one that it comes to
// rest on: Newton's method approaches rest by halves.
TEST(Steady, HalfWayToRestIsNoMotion) {
  const SteadyMotion motion =
      steady_motion(registry(), simulate("suslov").set("inertia", {10, 1, 2, 1, 12, 3, 2, 3, 14}));
  EXPECT_FALSE(motion.found);
  EXPECT_GT(motion.residual, 1e-3);
}

// A wheel that spins down does nothing but spin: its angle is a symmetry.
TEST(Steady, ASpinThatDecaysIsNamed) {
  Mechanism m("wheel");
  const auto wheel = m.body("wheel", {.mass = 1, .at = {0, 0, 0}, .inertia = {0.1, 0.2, 0.1}});
  m.hinge("spin", "ground", wheel, {.axis = {0, 1, 0}, .damping = 0.5});
  const SteadyMotion motion =
      steady_motion(registry(), m.model(), {.configuration = {0}, .velocity = {0}});
  ASSERT_EQ(motion.eigenvalues.size(), 1u);
  EXPECT_NEAR(motion.eigenvalues[0].real(), -0.5 / 0.2, 1e-10);
  ASSERT_EQ(motion.modes[0].size(), 1u);
  EXPECT_EQ(motion.modes[0][0].name, "spin.rate");
}

// Backwards the trailers jackknife, each at a rate in proportion to the speed: stability changes at
// rest, on the grid or off it.
TEST(Steady, TrailersFoldBackwards) {
  for (const std::vector<double>& speeds :
       {std::vector<double>{-6, -3, 0, 3, 6}, std::vector<double>{-6, -7.0 / 3, 4.0 / 3, 5}}) {
    const SteadySweep sweep = sweep_steady(
        registry(), speeds, [](double v) { return simulate("two_trailer_truck").speed(v); });
    ASSERT_EQ(sweep.crossings.size(), 2u);
    for (const auto& crossing : sweep.crossings) EXPECT_NEAR(crossing.value, 0, 1e-10);
  }
}

// A disk that leans and runs round a circle, from a guess that is off.
TEST(Steady, FindsTheCircleOfALeaningDisk) {
  const FallingDisk disk;
  Start guess = disk.rolling(1.2, {0, 0.9, 6});
  const SteadyMotion motion = steady_motion(registry(), model("falling_disk"), guess);
  ASSERT_TRUE(motion.found);
  const auto& e = motion.element;
  // gamma = R^T e_z, the precession alpha about the vertical: omega = alpha gamma + (w3 - alpha
  // gamma_3) e3.
  const Vec<3> gamma(e[6], e[7], e[8]),
      omega(motion.velocity[0], motion.velocity[1], motion.velocity[2]);
  const double cosine = gamma[2], sine = std::hypot(gamma[0], gamma[1]);
  const double alpha = (omega[0] * gamma[0] + omega[1] * gamma[1]) / (sine * sine), w3 = omega[2];
  const double m = disk.mass, a = disk.diametral_inertia, c = disk.axial_inertia, r = disk.radius;
  EXPECT_NEAR((c + m * r * r) * w3 * alpha * sine,
              a * alpha * alpha * sine * cosine - m * disk.gravity * r * cosine, 1e-9);
}

TEST(Steady, PartsOfAModeAreVelocities) {
  const SteadyMotion motion = steady_motion(registry(), simulate("bicycle").speed(5));
  const std::vector<ModePart>& capsize = motion.modes[0];
  ASSERT_GE(capsize.size(), 3u);
  EXPECT_EQ(capsize[0].name, "w3");
  EXPECT_NEAR(capsize[0].size, 1, 1e-12);
  EXPECT_EQ(capsize[1].name, "w1");
  EXPECT_NEAR(capsize[1].size, 0.163, 1e-3);
  EXPECT_EQ(capsize[2].name, "steer.rate");
  EXPECT_NEAR(capsize[2].size, 0.070, 1e-3);
}

}  // namespace
}  // namespace hamel
