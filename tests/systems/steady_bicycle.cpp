// The bicycle's steady motions and their eigenvalues: against the published ones.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/Dense>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "mechanism_systems.hpp"
#include "steady_motions.hpp"

namespace hamel {
namespace {

using namespace test;

// Radii of the crowns of two toroidal wheels, 0 of thin ones.
struct Crowns {
  double rear = 0, front = 0;  // m
};

// Of M q'' + v C1 q' + (g K0 + v^2 K2) q = 0, q = (lean, steer), with the benchmark's matrices of
// Meijaard and others 2007.
//
// A crown of radius rho, r that of the wheel: its circle of radius r - rho lies rho above the
// ground, so that its centre at a lean p of its plane is rho + (r - rho) cos p high, by
// rho p^2/2 higher than a thin wheel's. To first order the velocity of the centre is that of a thin
// wheel: (theta' n + p' x) x (rho z + (r - rho) e) = r (theta', -p', 0) with z and e = z + O(p),
// z.(n x e) = O(p^2). So only the static loads N do other work: K0 g gains the second derivative of
// sum N rho p^2/2, with p = lean behind and lean + steer sin(tilt) in front.
Eigen::VectorXcd published(double v, const Crowns& crowns = {}) {
  using Pair = Eigen::Matrix2d;
  const Pair m{{80.81722, 2.31941332208709}, {2.31941332208709, 0.29784188199686}};
  Pair k0{{-80.95, -2.59951685249872}, {-2.59951685249872, -0.80329488458618}};
  const Pair k2{{0, 76.59734589573222}, {0, 2.65431523794604}};
  const Pair c1{{0, 33.86641391492494}, {-0.85035641456978, 1.68540397397560}};
  const double front = (85 * 0.3 + 4 * 0.9 + 3 * 1.02) / 1.02, rear = 94 - front;  // N/g
  const Eigen::Vector2d leans[] = {{1, 0}, {1, std::sin(std::numbers::pi / 10)}};
  k0 += rear * crowns.rear * leans[0] * leans[0].transpose() +
        front * crowns.front * leans[1] * leans[1].transpose();
  Eigen::Matrix4d flow = Eigen::Matrix4d::Zero();
  flow.topRightCorner<2, 2>() = Pair::Identity();
  flow.bottomLeftCorner<2, 2>() = -m.inverse() * (9.81 * k0 + v * v * k2);
  flow.bottomRightCorner<2, 2>() = -m.inverse() * (v * c1);
  return dense::eigenvalues(flow);
}

TEST(Bicycle, HasTheEigenvaluesOfThePublishedMatrices) {
  const SystemModel bicycle = model("bicycle");
  for (int v = 0; v <= 10; ++v) {
    const SteadyMotion motion = at_speed(bicycle, v);
    ASSERT_EQ(motion.eigenvalues.size(), 4u) << v;
    EXPECT_EQ(motion.neutral, 6) << v;  // x, y, heading, two wheels; speed
    EXPECT_LT(motion.residual, 1e-12);
    const Eigen::VectorXcd values = published(v);
    for (const auto& value : values) EXPECT_LT(nearest(motion.eigenvalues, value), 1e-8) << v;
  }
}

// The bicycle on toroidal wheels.
SystemModel on_tubes(const Crowns& crowns) {
  Mechanism m("bicycle on tubes");
  const double tilt = std::numbers::pi / 10;
  const Point rear = {0, 0, 0.3}, front = {1.02, 0, 0.35}, axle = {0, 1, 0};
  m.body("frame", {.mass = 85, .at = {0.3, 0, 0.9}, .inertia = {9.2, 0, -2.4, 11, 0, 2.8}});
  m.body("fork",
         {.mass = 4, .at = {0.9, 0, 0.7}, .inertia = {0.05892, 0, 0.00756, 0.06, 0, 0.00708}});
  m.body("rear wheel", {.mass = 2, .at = rear, .inertia = {0.0603, 0.12, 0.0603}});
  m.body("front wheel", {.mass = 3, .at = front, .inertia = {0.1405, 0.28, 0.1405}});
  m.free("space", "frame", {.at = rear});
  m.hinge("steer", "frame", "fork",
          {.at = {1.1, 0, 0}, .axis = {-std::sin(tilt), 0, std::cos(tilt)}});
  m.hinge("rear", "frame", "rear wheel", {.at = rear, .axis = axle});
  m.hinge("front", "fork", "front wheel", {.at = front, .axis = axle});
  m.contact("tube", "rear", "rear wheel",
            {rear, {{"axle", {0, 1, 0}}, {"radius", {0.3}}, {"crown", {crowns.rear}}}});
  m.contact("tube", "front", "front wheel",
            {front, {{"axle", {0, 1, 0}}, {"radius", {0.35}}, {"crown", {crowns.front}}}});
  return m.model();
}

TEST(Bicycle, OnToroidalWheelsHasTheLoadsInItsStiffness) {
  for (const Crowns& crowns : {Crowns{0.05, 0.03}, Crowns{0, 0.04}, Crowns{0.02, 0}}) {
    const SystemModel bicycle = on_tubes(crowns);
    for (int v = 0; v <= 10; v += 2) {
      const SteadyMotion motion = at_speed(bicycle, v);
      ASSERT_EQ(motion.eigenvalues.size(), 4u) << v;
      for (const auto& value : published(v, crowns))
        EXPECT_LT(nearest(motion.eigenvalues, value), 1e-8) << v;
    }
  }
}

// Where the published matrices with the loads of the crowns have a pair on the imaginary axis: the
// weave speed falls from 4.29 m/s.
TEST(Bicycle, WeavesAtALowerSpeedOnToroidalWheels) {
  const Crowns crowns{0.05, 0.03};
  const auto growth = [](const Eigen::VectorXcd& values) {
    double out = -1e9;
    for (const auto& value : values)
      if (std::abs(value.imag()) > 0.1) out = std::max(out, value.real());
    return out;
  };
  double slow = 3, fast = 4.5;
  while (fast - slow > 1e-13) {
    const double middle = (slow + fast) / 2;
    (growth(published(middle, crowns)) > 0 ? slow : fast) = middle;
  }
  EXPECT_LT(slow, 4.2);
  const SteadyMotion motion = at_speed(on_tubes(crowns), slow);
  double least = 1e9;
  for (const auto& value : motion.eigenvalues)
    if (std::abs(value.imag()) > 0.1) least = std::min(least, std::abs(value.real()));
  EXPECT_LT(least, 1e-8);
}

// Table 2: real and imaginary part of weave, then capsize and castering.
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
    const auto found = at_speed(bicycle, row[0]).eigenvalues;
    for (const std::complex<double> value :
         {std::complex(row[1], row[2]), std::complex(row[1], -row[2]), std::complex(row[3], 0.0),
          std::complex(row[4], 0.0)})
      EXPECT_LT(nearest(found, value), 1e-8) << row[0];
  }
}

TEST(Bicycle, WeavesAndCapsizesAtThePublishedSpeeds) {
  std::vector<double> speeds;
  for (int i = 0; i <= 14; ++i) speeds.push_back(1 + 0.5 * i);
  const SteadySweep sweep =
      sweep_steady(registry(), speeds, [](double v) { return simulate("bicycle").speed(v); });
  ASSERT_EQ(sweep.crossings.size(), 2u);
  EXPECT_TRUE(sweep.crossings[0].pair);
  EXPECT_NEAR(sweep.crossings[0].value, 4.29238253634111, 1e-9);
  EXPECT_EQ(sweep.crossings[0].kind, Bifurcation::hopf);
  EXPECT_FALSE(sweep.crossings[1].pair);
  EXPECT_NEAR(sweep.crossings[1].value, 6.02426201538837, 1e-9);
  // Hands off on a circle: slower than the capsize speed (Basu-Mandal, Chatterjee, Papadopoulos
  // 2007).
  EXPECT_EQ(sweep.crossings[1].kind, Bifurcation::pitchfork);
  ASSERT_TRUE(sweep.crossings[1].other);
  EXPECT_LT(sweep.crossings[1].other->value, sweep.crossings[1].value);
  for (const SteadyCrossing& crossing : sweep.crossings) EXPECT_LT(crossing.round_off, 1e-8);
}

// Rates of the modes in signals at equal distances d (Prony): every signal satisfies one recursion
// of `order`, whose roots are exp(l d).
std::vector<std::complex<double>> rates_in(const std::vector<std::vector<double>>& signals,
                                           int order, double d) {
  Eigen::MatrixXd past(0, order);
  Eigen::VectorXd now(0);
  for (const auto& s : signals) {
    for (size_t k = static_cast<size_t>(order); k < s.size(); ++k) {
      const Eigen::Index row = past.rows();
      past.conservativeResize(row + 1, Eigen::NoChange);
      now.conservativeResize(row + 1);
      now[row] = s[k];
      for (int j = 0; j < order; ++j) past(row, j) = s[k - 1 - static_cast<size_t>(j)];
    }
  }
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(order, order);
  companion.row(0) = dense::solve_pivoted(past, now).transpose();
  companion.bottomLeftCorner(order - 1, order - 1).setIdentity();
  std::vector<std::complex<double>> out;
  const Eigen::VectorXcd roots = dense::eigenvalues(companion);
  for (const auto& z : roots) out.push_back(std::log(z) / d);
  return out;
}

// The nonlinear bicycle, upright and disturbed by 1e-6.
TEST(Bicycle, NonlinearMotionGrowsAndDecaysAtThePublishedRates) {
  for (const double speed : {3.0, 5.0, 7.0}) {
    Start start = model("bicycle").start_at_speed(speed, 0);
    start.velocity[0] = 1e-6;  // roll rate
    const Result result = simulate("bicycle")
                              .start(start)
                              .compose("kahan_li6")
                              .step(0.005)
                              .until(1.5)
                              .every(10)
                              .run();
    ASSERT_TRUE(result.status.ok);
    std::vector<std::vector<double>> signals;
    for (const char* column : {"steer.angle", "xi1", "xi7"})
      signals.push_back(result.trajectory.column(column));
    const auto found = rates_in(signals, 4, 0.05);
    const Eigen::VectorXcd rates = published(speed);
    for (const auto& value : rates) EXPECT_LT(nearest(found, value), 1e-3) << speed << " " << value;
  }
}

/// Parts of a mode are velocities under their own names: the capsize of a bicycle yaws and rolls.
/// The unstable mode of a cart on a swivel caster turns the wheels against each other.

}  // namespace
}  // namespace hamel
