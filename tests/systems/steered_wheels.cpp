// Vehicles whose wheels are steered one by one: their axles meet in one point, or they cannot move.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

struct SteeredWheel {
  std::string name;
  double x, y;  // of its steering axis
  bool steered = true;
  std::vector<double> beside = {0};  // wheels on its axle, to the left of the axis
};

constexpr double kRadius = 0.3;

// A base on wheels, all but one of which do not slip sideways.
Mechanism vehicle(const std::vector<SteeredWheel>& wheels, const std::string& rolls_only = "") {
  Mechanism m("vehicle");
  m.body("base", {.mass = 100, .at = {0.8, 0.03, 0.5}, .inertia = {10, 30, 45}});
  m.planar("road", "base");
  const Point axle = {0, 1, 0};
  for (const SteeredWheel& w : wheels) {
    const Point at = {w.x, w.y, kRadius};
    if (w.steered) {
      m.body("knuckle " + w.name, {.mass = 3, .at = at, .inertia = {0.2, 0.2, 0.15}});
      m.hinge(w.name, "base", "knuckle " + w.name, {.at = at});
    }
    for (size_t i = 0; i < w.beside.size(); ++i) {
      const Point centre = {w.x, w.y + w.beside[i], kRadius};
      const std::string name = fmt::format("{} wheel{}", w.name, i == 0 ? "" : std::to_string(i));
      m.body(name, {.mass = 5, .at = centre, .cylinder = {kRadius, 0.1}, .axis = axle});
      m.hinge(name, w.steered ? "knuckle " + w.name : "base", name, {.at = centre, .axis = axle});
      if (w.name == rolls_only) m.roller(name, name, {.at = centre, .radius = kRadius});
      else m.wheel(name, name, {.at = centre, .radius = kRadius});
    }
  }
  m.redundant("drop");
  return m;
}

const std::vector<SteeredWheel> kCar = {{"left", 2.5, 0.7, true},
                                        {"right", 2.5, -0.7, true},
                                        {"rear left", 0, 0.7, false},
                                        {"rear right", 0, -0.7, false}};
const std::vector<SteeredWheel> kFour = {
    {"fl", 0.9, 0.6}, {"fr", 0.9, -0.6}, {"rl", -0.7, 0.6}, {"rr", -0.7, -0.6}};
const std::vector<SteeredWheel> kTwins = {{"fl", 0.9, 0.6, true, {0.1, -0.1}},
                                          {"fr", 0.9, -0.6, true, {0.1, -0.1}},
                                          {"rl", -0.7, 0.6, true, {0.1, -0.1}},
                                          {"rr", -0.7, -0.6, true, {0.1, -0.1}}};

// Slip of wheel w along its axle in a recorded row, from pose and velocity of the base.
double slip(const Result& run, size_t row, const SteeredWheel& w) {
  const auto value = [&](const std::string& column) {
    return run.trajectory.at(row, run.trajectory.index(column));
  };
  const double angle = w.steered ? value(w.name + ".angle") : 0;
  return -std::sin(angle) * (value("v1") - value("omega") * w.y) +
         std::cos(angle) * (value("v2") + value("omega") * w.x);
}

void expect_no_slip(const Result& run, const std::vector<SteeredWheel>& wheels) {
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  for (size_t row = 0; row < run.trajectory.rows(); ++row)
    for (const SteeredWheel& w : wheels)
      ASSERT_NEAR(slip(run, row, w), 0, 1e-11) << w.name << " in row " << row;
}

// cot(right) = cot(left) + 1.4/2.5: the coordinate that is not given follows; the circle about a
// point of the rear axle.
TEST(SteeredWheels, CarTurnsAboutThePointWhereItsAxlesMeet) {
  Mechanism m = vehicle(kCar);
  m.start({{"speed", 5}, {"left.angle", 0.2}});
  const Result run = simulate(m).tolerance({.relative = 1e-11}).until(3).run();
  expect_no_slip(run, kCar);
  const double to_centre = 0.7 + 2.5 / std::tan(0.2);  // from the middle of the rear axle
  const auto last = [&](const std::string& name) { return run.trajectory.column(name).back(); };
  EXPECT_NEAR(last("right.angle"), std::atan(1 / (1 / std::tan(0.2) + 1.4 / 2.5)), 1e-12);
  const double angle = last("theta");
  EXPECT_NEAR(last("x"), to_centre * std::sin(angle), 1e-9);
  EXPECT_NEAR(last("y"), to_centre * (1 - std::cos(angle)), 1e-9);
  EXPECT_NEAR(angle, 5 / to_centre * 3, 1e-9);
}

// The same car whose right wheel rolls only, and whose knuckles a linkage couples.
TEST(SteeredWheels, CarIsThatWithALinkage) {
  Mechanism wheels = vehicle(kCar), linkage = vehicle(kCar, "right");
  linkage.coupling("linkage",
                   {.formula = "sin(right.angle)*(2.5*cos(left.angle) + 0.7*sin(left.angle)) - "
                               "sin(left.angle)*(2.5*cos(right.angle) - 0.7*sin(right.angle))"});
  std::vector<std::vector<double>> ends;
  for (Mechanism* m : {&wheels, &linkage}) {
    m->motor("left", [](const SignalInput& now) { return 3 * std::sin(2 * now.t); });
    m->motor(
        "rear left wheel", [](const SignalInput&) { return 20.0; }, false);
    m->start({{"speed", 2}, {"left.angle", 0.1}});
    const Result run = simulate(*m).tolerance({.relative = 1e-12}).until(3).run();
    ASSERT_TRUE(run.status.ok) << run.status.reason;
    ends.push_back(run.last.coordinates);
    ends.back().insert(ends.back().end(), run.last.velocity.begin(), run.last.velocity.end());
  }
  EXPECT_GT(std::abs(ends[0][3]), 0.1);  // it steers
  for (size_t i = 0; i < ends[0].size(); ++i)
    EXPECT_NEAR(ends[0][i], ends[1][i], 1e-9 * (1 + std::abs(ends[0][i]))) << "number " << i;
}

// Four steered wheels, also as pairs on one axle, in any order: each rolls, none of them slips,
// also those whose rows gave way; the motion is that of another choice of these rows.
TEST(SteeredWheels, FourTurnAboutAnyPoint) {
  std::vector<std::vector<double>> ends;
  for (const auto& wheels : {kFour, kTwins}) {
    for (const bool turned_round : {false, true}) {
      std::vector<SteeredWheel> order = wheels;
      if (turned_round) std::swap(order[0], order[3]);
      Mechanism m = vehicle(order);
      m.motor("fl", [](const SignalInput& now) { return 0.2 * std::cos(2 * now.t); });
      m.motor("rl", [](const SignalInput& now) { return -0.1 * std::cos(2 * now.t); });
      m.start({{"speed", 1}, {"fl.angle", 0.3}, {"fr.angle", 0.2}});
      const Result run = simulate(m).tolerance({.relative = 1e-12}).until(4).run();
      expect_no_slip(run, wheels);
      EXPECT_LE(run.energy_balance_error_max, 1e-10);
      std::vector<double> end;
      for (const char* name : {"x", "y", "theta", "omega", "v1", "v2", "fl.angle", "rr.angle"})
        end.push_back(run.trajectory.column(name).back());
      ends.push_back(end);
    }
  }
  for (const size_t one : {0UL, 2UL})
    for (size_t i = 0; i < ends[one].size(); ++i)
      EXPECT_NEAR(ends[one][i], ends[one + 1][i], 1e-8) << "number " << i;
  EXPECT_GT(std::abs(ends[0][2]), 0.5);  // it turns
}

// The discrete scheme keeps the agreement and has its order.
TEST(SteeredWheels, LiftKeepsTheAgreement) {
  Mechanism m = vehicle(kFour);
  m.motor("fl", [](const SignalInput& now) { return 0.4 * std::cos(now.t); });
  m.start({{"speed", 1}, {"fl.angle", 0.3}, {"fr.angle", 0.2}});
  const double exact =
      simulate(m).tolerance({.relative = 1e-12}).until(2).run().trajectory.column("x").back();
  std::vector<double> errors;
  for (const double step : {0.01, 0.005}) {
    const Result run = simulate(m).scheme("lift").step(step).until(2).run();
    ASSERT_TRUE(run.status.ok) << run.status.reason;
    EXPECT_LE(run.holonomic_max, 1e-12);
    errors.push_back(run.trajectory.column("x").back() - exact);
  }
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.2);
}

// Where the axles of the kept rows, of two wheels, coincide, a run ends and names them.
TEST(SteeredWheels, RunEndsWhereTheKeptAxlesCoincide) {
  Mechanism m = vehicle(kFour);
  m.motor("fl", [](const SignalInput& now) { return 0.4 * std::cos(now.t); });
  m.motor(
      "rl", [](const SignalInput&) { return -0.1; }, false);
  m.start({{"speed", 1}, {"fl.angle", 0.3}, {"fr.angle", 0.2}});
  const Result run = simulate(m).tolerance({.relative = 1e-10}).until(4).run();
  EXPECT_FALSE(run.status.ok);
  EXPECT_THAT(run.status.reason, testing::HasSubstr("fl wheel.reaction2, rl wheel.reaction2"));
}

TEST(SteeredWheels, AnglesThatDoNotAgreeAreNamed) {
  const auto mistakes = [](Mechanism& m) {
    try {
      m.model();
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  Mechanism m = vehicle(kCar);
  m.start({{"left.angle", 0.2}, {"right.angle", 0.1}});
  EXPECT_THAT(mistakes(m), testing::AllOf(testing::HasSubstr("the axles of wheels meet in one "
                                                             "point"),
                                          testing::HasSubstr("right.angle = 0.180073 would do")));
  Mechanism locked = vehicle(kCar);
  locked.hold("left", 0.2);
  locked.hold("right", 0.2);
  EXPECT_THAT(mistakes(locked), testing::HasSubstr("right.angle = 0.180073 would do"));
}

// A tricycle and a bicycle have no such row.
TEST(SteeredWheels, OneOfThemNeedsNoAgreement) {
  const std::vector<SteeredWheel> tricycle = {
      {"front", 1, 0, true}, {"rear left", 0, 0.3, false}, {"rear right", 0, -0.3, false}};
  for (const std::string& row : vehicle(tricycle).model().reactions)
    EXPECT_THAT(row, testing::Not(testing::HasSubstr("agreement")));
}

}  // namespace
}  // namespace hamel
