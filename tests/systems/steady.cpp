// Steady motions and their eigenvalues: against closed forms, and the published bicycle.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/systems/at_speed.hpp>
#include <hamel/systems/simulate.hpp>

#include "mechanism_systems.hpp"

namespace hamel {
namespace {

SystemModel model(const std::string& name) { return registry().system(name)->make({}); }
SteadyMotion at_speed(const SystemModel& system, double speed, int family = -1) {
  return steady_motion(registry(), system, *start_at_speed(system, speed), family);
}

// Meijaard and others 2007, Table 2: real and imaginary part of weave, then the two real ones.
TEST(Bicycle, HasThePublishedEigenvalues) {
  const double table[][5] = {
      {1, 3.52696170990070, 0.80774027519930, -3.13423125066578, -7.11008014637442},
      {2, 2.68234517512745, 1.68066296590675, -3.07158645641514, -8.67387984831735},
      {3, 1.70675605663975, 2.31582447384325, -2.63366137253667, -10.35101467245920},
      {4, 0.41325331521125, 3.07910818603206, -1.42944427361326, -12.15861426576447},
      {5, -0.77534188219585, 4.46486771378823, -0.32286642900409, -14.07838969279822},
      {6, -1.52644486584142, 5.87673060598709, -0.00406690076970, -16.08537123098026},
      {7, -2.13875644258362, 7.19525913329805, 0.10268170574766, -18.15788466125262},
      {8, -2.69348683581097, 8.46037971396931, 0.14327879765713, -20.27940894394569},
      {9, -3.21675402252485, 9.69377351531791, 0.15790184030917, -22.43788559040858},
      {10, -3.72016840437287, 10.90681139476287, 0.16105338653172, -24.62459635017404}};
  const SystemModel bicycle = model("bicycle");
  for (const auto& row : table) {
    SCOPED_TRACE(row[0]);
    const SteadyMotion motion = at_speed(bicycle, row[0]);
    ASSERT_EQ(motion.eigenvalues.size(), 4u);
    EXPECT_EQ(motion.neutral, 6);  // x, y, heading, two wheels; speed
    EXPECT_LT(motion.residual, 1e-12);
    const auto has = [&](std::complex<double> value) {
      double nearest = 1e9;
      for (const auto& x : motion.eigenvalues) nearest = std::min(nearest, std::abs(x - value));
      EXPECT_LT(nearest, 1e-8) << value;
    };
    has({row[1], row[2]});
    has({row[1], -row[2]});
    has(row[3]);
    has(row[4]);
  }
}

TEST(Bicycle, WeavesAndCapsizesAtThePublishedSpeeds) {
  const SystemModel bicycle = model("bicycle");
  std::vector<double> speeds;
  for (int i = 0; i <= 14; ++i) speeds.push_back(1 + 0.5 * i);
  const SteadySweep sweep =
      sweep_steady(speeds, [&](double v, int family) { return at_speed(bicycle, v, family); });
  ASSERT_EQ(sweep.crossings.size(), 2u);
  EXPECT_TRUE(sweep.crossings[0].pair);
  EXPECT_NEAR(sweep.crossings[0].value, 4.29238253634111, 1e-9);
  EXPECT_FALSE(sweep.crossings[1].pair);
  EXPECT_NEAR(sweep.crossings[1].value, 6.02426201538837, 1e-9);
}

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
      {1.0, 1.5, 2.0}, [&](double v, int family) { return at_speed(system, v, family); });
  ASSERT_EQ(sweep.crossings.size(), 1u);
  EXPECT_NEAR(sweep.crossings[0].value, r * std::sqrt(a * m * g * r / (c * (c + m * r * r))),
              1e-10);
}

TEST(Steady, DiskSpinsUprightAboveItsThreshold) {
  const FallingDisk disk;
  const double m = disk.mass, a = disk.diametral_inertia, r = disk.radius;
  const auto spinning = [&](double rate, int family) {
    // Upright at pi/2: the vertical is the body's axis e2.
    return steady_motion(registry(), model("falling_disk"),
                         disk.rolling(0.5 * std::numbers::pi, {0, rate, 0}), family);
  };
  const SteadySweep sweep = sweep_steady({3.0, 3.5, 4.0, 4.5}, spinning);
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

// With the mass centre ahead of the blade straight motion decays at m a u / (I + m a^2), behind it it grows.
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

// A disk that leans and runs round a circle, from a guess that is off.
TEST(Steady, FindsTheCircleOfALeaningDisk) {
  const FallingDisk disk;
  Start guess = disk.rolling(1.2, {0, 0.9, 6});
  const SteadyMotion motion = steady_motion(registry(), model("falling_disk"), guess);
  ASSERT_TRUE(motion.found);
  const auto& e = motion.element;
  // gamma = R^T e_z, the precession alpha about the vertical: omega = alpha gamma + (w3 - alpha gamma_3) e3.
  const Vec<3> gamma(e[6], e[7], e[8]),
      omega(motion.velocity[0], motion.velocity[1], motion.velocity[2]);
  const double cosine = gamma[2], sine = std::hypot(gamma[0], gamma[1]);
  const double alpha = (omega[0] * gamma[0] + omega[1] * gamma[1]) / (sine * sine), w3 = omega[2];
  const double m = disk.mass, a = disk.diametral_inertia, c = disk.axial_inertia, r = disk.radius;
  EXPECT_NEAR((c + m * r * r) * w3 * alpha * sine,
              a * alpha * alpha * sine * cosine - m * disk.gravity * r * cosine, 1e-9);
}

// The nonlinear bicycle, upright and disturbed by 1e-6, leaves or returns at the rates of its eigenvalues: with modes of
// rates l_i the signal s(t) = sum c_i exp(l_i t) satisfies the recursion with the roots exp(l_i d).
TEST(Bicycle, NonlinearMotionGrowsAndDecaysAtTheseRates) {
  const SystemModel system = model("bicycle");
  for (const double speed : {3.0, 5.0, 7.0}) {
    const SteadyMotion motion = at_speed(system, speed);
    Start start = *start_at_speed(system, speed);
    start.velocity[0] = 1e-6;  // roll rate
    const double d = 0.1;
    std::vector<double> steer;
    const auto make = [&](const Parameters&) { return system; };
    Simulation run(registry(), "bicycle", make);
    const Result result =
        run.start(start).compose("kahan_li6").step(0.005).until(1.6).every(20).run();
    ASSERT_TRUE(result.status.ok);
    steer = result.trajectory.column("steer.angle");
    std::vector<std::complex<double>> polynomial{1};  // product of (z - exp(l_i d))
    for (const auto& l : motion.eigenvalues) {
      std::vector<std::complex<double>> next(polynomial.size() + 1, 0);
      for (size_t i = 0; i < polynomial.size(); ++i) {
        next[i] += polynomial[i];
        next[i + 1] -= std::exp(l * d) * polynomial[i];
      }
      polynomial = next;
    }
    double size = 0;
    for (const double x : steer) size = std::max(size, std::abs(x));
    EXPECT_GT(size, 1e-8);
    for (size_t k = polynomial.size() - 1; k < steer.size(); ++k) {
      double left = 0;
      for (size_t i = 0; i < polynomial.size(); ++i) left += polynomial[i].real() * steer[k - i];
      EXPECT_LT(std::abs(left), 1e-3 * size * 1e-1) << speed << " " << k;
    }
  }
}

}  // namespace
}  // namespace hamel
