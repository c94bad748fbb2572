// Mechanisms by parts: their recursions against differences, and against the registered systems
// along trajectories.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include <hamel/framework/check/system_laws.hpp>
#include <hamel/framework/lie/decompositions.hpp>
#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/systems/mechanisms/library.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "../framework/distances.hpp"
#include "mechanism_systems.hpp"

namespace hamel {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::largest_difference;
using testing::HasSubstr;

// The order-6 composition makes the schemes agree to round-off also where the groups are not the
// same.
Result run(Simulation simulation, const Start& start, double h, double until) {
  simulation.start(start).compose("kahan_li6").step(h).until(until);
  Result result = simulation.run();
  EXPECT_TRUE(result.status.ok) << result.status.reason;
  return result;
}

// What the rows do on xi, A^T lambda, whatever the rows are.
VectorXd reaction(const Result& result) {
  const SystemModel& system = *result.system;
  const auto geometry = registry().geometry(system.group.name, "exp");
  const Mechanics& mechanics = *system.mechanics;
  EquationsOfMotion<DynamicProblem> motion(DynamicProblem(geometry, system.mechanics));
  VectorXd g(geometry->size()), b(mechanics.constraint_count());
  MatrixXd a(mechanics.constraint_count(), mechanics.dim());
  geometry->from_coordinates(result.last.coordinates, g.data());
  const VectorXd xi = Eigen::Map<const VectorXd>(result.last.velocity.data(), mechanics.dim());
  motion.solve(result.last.time, g, xi);
  mechanics.constraints(result.last.time, g.data(), a, b);
  return a.transpose() * motion.reaction();
}

// Same group and coordinates.
void same(const std::string& system, const Mechanism& parts, double h = 0.01, double until = 2) {
  SCOPED_TRACE(parts.name());
  const Result hers = run(simulate(system), {}, h, until);
  const Result ours = run(simulate(parts), hers.config.start, h, until);
  EXPECT_LT(largest_difference(hers.last.coordinates, ours.last.coordinates), 1e-10);
  EXPECT_LT(largest_difference(hers.last.velocity, ours.last.velocity), 1e-10);
  const auto energy = [](const Result& r) {
    const auto column = r.trajectory.column("energy");
    return column.back() - column.front();
  };
  EXPECT_NEAR(energy(hers), energy(ours), 1e-10 * (1 + std::abs(hers.last.energy)));
  const VectorXd there = reaction(hers);
  EXPECT_LT((there - reaction(ours)).norm(), 1e-9 * (1 + there.norm()));
}

TEST(Mechanisms, AreTheRegisteredSystems) {
  same("chaplygin_sleigh", by_parts::sleigh({}));
  same("differential_drive", by_parts::drive({}));
  same("segway", by_parts::segway({}), 0.005, 1.5);
  same("roller_racer", by_parts::racer({}));
  same("snakeboard", by_parts::snakeboard({}));
  same("knife_edge_on_incline", by_parts::incline({}));
}

// The system measures the headings of its trailers against the car, the mechanism against the one
// before.
TEST(Mechanisms, AreTheTrain) {
  const auto against_the_last = [](std::vector<double> values, size_t first) {
    for (size_t i = values.size() - 1; i > first; --i) values[i] -= values[i - 1];
    return values;
  };
  const Result hers = run(simulate("n_trailer"), {}, 0.01, 2);
  Start start = hers.config.start;
  start.configuration = against_the_last(start.configuration, 3);
  start.velocity = against_the_last(start.velocity, 3);
  const Result ours = run(simulate(by_parts::train({})), start, 0.01, 2);
  EXPECT_LT(largest_difference(against_the_last(hers.last.coordinates, 3), ours.last.coordinates),
            1e-10);
  EXPECT_LT(largest_difference(against_the_last(hers.last.velocity, 3), ours.last.velocity), 1e-10);
  EXPECT_NEAR(hers.last.energy, ours.last.energy, 1e-10);
  for (int i = 1; i <= 4; ++i) {  // the forces across the axles
    EXPECT_NEAR(hers.trajectory.column("lambda" + std::to_string(i)).back(),
                ours.trajectory.column(fmt::format("axle {}.reaction1", i - 1)).back(), 1e-9);
  }
}

// A body in space: its rotation, drawn as the identity, times r is that of the system; positions
// the same.
std::vector<double> turned(const std::vector<double>& coordinates, const Mat<3, 3>& r) {
  Mat<3, 3> g;
  for (int i = 0; i < 9; ++i) g(i / 3, i % 3) = coordinates[static_cast<size_t>(i)];
  g *= r;
  std::vector<double> out = coordinates;
  for (int i = 0; i < 9; ++i) out[static_cast<size_t>(i)] = g(i / 3, i % 3);
  return out;
}

TEST(Mechanisms, AreTheDiskThatFalls) {
  const FallingDisk disk;
  const double theta = 1.3;
  const Mat<3, 3> r = body_on_plane::leaning(theta).rotation;
  const Result hers = run(simulate("falling_disk"), disk.start(), 0.0025, 1);
  const Vec<3> omega = r * Vec<3>(0.1, 0.4, 5);
  Start start = by_parts::disk(disk, theta).model().start;
  const double height = start.configuration[11];
  const Vec<3> v = -omega.cross(r * Vec<3>(0, -disk.radius, 0));
  EXPECT_NEAR(height, disk.radius * std::sin(theta), 1e-15);
  start.velocity = {omega[0], omega[1], omega[2], v[0], v[1], v[2]};
  const Result ours = run(simulate(by_parts::disk(disk, theta)), start, 0.0025, 1);
  EXPECT_LT(largest_difference(hers.last.coordinates, turned(ours.last.coordinates, r)), 1e-10);
  EXPECT_NEAR(hers.last.energy, ours.last.energy, 1e-10);
  for (int i = 1; i <= 3; ++i) {
    EXPECT_NEAR(hers.trajectory.column("lambda" + std::to_string(i)).back(),
                ours.trajectory.column("disk.reaction" + std::to_string(i)).back(), 1e-9);
  }
}

// The system has the group so3*r2 and its mass centre, the mechanism se3 and the centre of the
// ball.
void same_ball(const std::string& system, const Mechanism& parts) {
  const Result hers = run(simulate(system), {}, 0.002, 1);
  const auto& v = hers.config.start.velocity;
  const auto& g = hers.config.start.configuration;
  Start start = parts.model().start;
  std::copy_n(g.begin(), 11, start.configuration.begin());
  const Vec<3> space(v[3], v[4], 0);
  Mat<3, 3> r;
  for (int i = 0; i < 9; ++i) r(i / 3, i % 3) = g[static_cast<size_t>(i)];
  const Vec<3> body = r.transpose() * space;
  start.velocity = {v[0], v[1], v[2], body[0], body[1], body[2]};
  const Result ours = run(simulate(parts), start, 0.002, 1);
  std::vector<double> place(ours.last.coordinates.begin(), ours.last.coordinates.begin() + 11);
  EXPECT_LT(largest_difference(hers.last.coordinates, place), 1e-10) << parts.name();
  const auto gain = [](const Result& result) {
    const auto column = result.trajectory.column("energy");
    return column.back() - column.front();
  };
  EXPECT_NEAR(gain(hers), gain(ours), 1e-10);
  // lambda1 belongs to x' = rho w_y, lambda2 to y' = -rho w_x: horizontal forces at the contact.
  for (int i = 1; i <= 2; ++i) {
    EXPECT_NEAR(std::abs(hers.trajectory.column("lambda" + std::to_string(i)).back()),
                std::abs(ours.trajectory.column("ball.reaction" + std::to_string(i)).back()), 1e-8);
  }
}

TEST(Mechanisms, AreTheBallsThatRoll) {
  same_ball("rolling_ball", by_parts::ball({}));
  same_ball("routh_sphere", by_parts::routh({}));
  same_ball("ball_on_turntable", by_parts::turntable({}));
}

// All kinds of joints, contacts and forces at once; nothing has to make sense but the calculus.
Mechanism zoo() {
  Mechanism m("zoo");
  m.body("a", {.mass = 2, .at = {0.1, 0.2, 0.6}, .inertia = {0.3, 0.4, 0.5}});
  m.body("b", {.mass = 1, .at = {0.5, 0.1, 0.7}, .inertia = {0.1, 0.02, 0, 0.2, 0.01, 0.15}});
  m.body("c", {.mass = 0.5, .at = {0.9, 0, 0.4}, .cylinder = {0.1, 0.3}, .axis = {1, 1, 0}});
  m.body("d", {.mass = 0.7, .at = {0, -0.4, 0.3}, .sphere = 0.3});
  m.body("e", {.mass = 0.4, .at = {-0.4, 0, 0.5}, .box = {0.1, 0.2, 0.3}});
  m.body("f", {.mass = 0.3, .at = {-0.6, 0.1, 0.5}, .inertia = {0.01, 0.01, 0.015}});
  m.body("g", {.mass = 0.6, .at = {0.3, 0.5, 0.35}, .inertia = {0.02, 0.03, 0.02}});
  m.free("space", "a", {.at = {0, 0, 0.5}});
  m.hinge("h", "a", "b", {.at = {0.3, 0, 0.5}, .axis = {0.3, 0.1, 1}, .stiffness = 3, .rest = 0.1});
  m.slider("s", "b", "c", {.at = {0.7, 0, 0.5}, .axis = {1, 0.2, 0}, .stiffness = 5});
  m.ball_joint("j", "a", "d", {.at = {0, -0.2, 0.4}});
  m.universal("u", "a", "e", {.at = {-0.2, 0, 0.5}, .axis = {0, 0, 1}, .axis2 = {0, 1, 0}});
  m.joint("planar", "p", "e", "f", {.at = {-0.5, 0, 0.5}, .axis = {0, 1, 1}});
  m.hinge("w", "a", "g", {.at = {0.3, 0.5, 0.35}, .axis = {0, 1, 0}});
  m.wheel("w", "g", {.at = {0.3, 0.5, 0.35}, .radius = 0.35});
  m.ball("d", "d", {.at = {0, -0.4, 0.3}, .radius = 0.3});
  m.spring("between", "b", "f",
           {.from = {0.5, 0, 0.7}, .to = {-0.6, 0, 0.5}, .stiffness = 2, .rest = 0.8});
  m.spring("to the wall", "ground", "d",
           {.from = {0, -1, 0.5}, .to = {0, -0.4, 0.5}, .stiffness = 4});
  m.loop("hinge", "f", "d", {.at = {0, 0.3, 0.4}, .axis = {0.6, 0, 0.8}});
  m.loop("ball", "c", "ground", {.at = {0.9, 0, 0.3}});
  m.gravity({0.3, 0.1, -9.7});
  return m;
}

TEST(Mechanisms, DifferentiateAsDifferencesDo) {
  const SystemModel model = zoo().model();
  const Mechanics& mechanics = *model.mechanics;
  const auto geometry = registry().geometry(model.group.name, "exp");
  const int n = mechanics.dim();
  ASSERT_EQ(n, 6 + 1 + 1 + 3 + 2 + 3 + 1);
  const int held = mechanics.holonomic_rows();
  ASSERT_EQ(held, 2 + 5 + 3);
  VectorXd g(geometry->size()), xi(n), direction(n), shift(n), step(n);
  geometry->from_coordinates(model.start.configuration, g.data());
  for (int i = 0; i < n; ++i) {
    xi[i] = std::sin(3.0 * i + 1);
    direction[i] = std::cos(2.0 * i);
    shift[i] = 0.4 * std::sin(5.0 * i + 2);
  }
  VectorXd moved(g.size()), work(n);
  geometry->tau(shift.data(), moved.data());
  geometry->compose(g.data(), moved.data(), g.data());
  VectorXd phi(held), b(mechanics.constraint_count()), force(n), inertial(n),
      phi_slope = VectorXd::Zero(held);
  MatrixXd inertia(n, n), a(mechanics.constraint_count(), n);
  double slope = 0, kinetic_slope = 0;
  const DynamicProblem problem(geometry, model.mechanics);
  differentiate_along(problem, g, direction, step, moved, [&](double, double weight) {
    slope += weight * mechanics.potential(moved.data());
    mechanics.inertia(moved.data(), inertia);
    kinetic_slope += weight * 0.5 * xi.dot(inertia * xi);
    mechanics.holonomic(moved.data(), phi);
    phi_slope += weight * phi;
  });
  mechanics.force(0, g.data(), xi, force);
  mechanics.inertial_force(g.data(), xi, inertial);
  mechanics.constraints(0, g.data(), a, b);
  EXPECT_NEAR(inertial.dot(direction), kinetic_slope, 1e-9);
  EXPECT_NEAR((force - inertial).dot(direction), -slope, 1e-9);
  EXPECT_LT((a.bottomRows(held) * direction - phi_slope).norm(), 1e-9);
  mechanics.inertia(g.data(), inertia);
  EXPECT_GT(dense::symmetric_eigenvalues(inertia).minCoeff(), 0);
}

// Wheels with rollers at +-45 degrees under a cart: r rate = v1 -+ v2 -+ (l + w) omega, as in
// Campion and others 1996.
TEST(Mechanisms, RollAsMecanumWheelsDo) {
  const double r = 0.05, l = 0.3, w = 0.2;
  Mechanism m("mecanum");
  m.body("cart", {.mass = 5, .at = {0, 0, 0.1}, .box = {0.6, 0.4, 0.1}});
  m.planar("floor", "cart");
  m.redundant("drop");
  for (const double x : {l, -l}) {
    for (const double y : {w, -w}) {
      const std::string name =
          fmt::format("{}{}", x > 0 ? "front " : "rear ", y > 0 ? "left" : "right");
      m.body(name, {.mass = 0.5, .at = {x, y, r}, .cylinder = {r, 0.04}, .axis = {0, 1, 0}});
      m.hinge(name, "cart", name, {.at = {x, y, r}, .axis = {0, 1, 0}});
      m.roller(
          name, name,
          {.at = {x, y, r}, .radius = r, .angle = (x * y > 0 ? -1 : 1) * 0.25 * std::numbers::pi});
    }
  }
  m.start({{"v1", 0.7}, {"v2", -0.4}, {"omega", 0.9}});
  const SystemModel model = m.model();
  EXPECT_TRUE(model.mechanics->left_invariant());
  const auto& xi = model.start.velocity;
  size_t i = 3;
  for (const double x : {l, -l}) {
    for (const double y : {w, -w}) {
      const double side = x * y > 0 ? -1 : 1;
      EXPECT_NEAR(r * xi[i++], 0.7 - y * 0.9 + side * (-0.4 + x * 0.9), 1e-14) << x << y;
    }
  }
}

// A damper takes out c l'^2, whichever way it is drawn.
TEST(Mechanisms, AreDamped) {
  Mechanism m("damped");
  m.body("a", {.mass = 1, .sphere = 0.1});
  m.body("b", {.mass = 1, .at = {1, 0, 0}, .sphere = 0.1});
  m.free("a", "a");
  m.free("b", "b", {.at = {1, 0, 0}});
  m.spring("damper", "a", "b", {.from = {0, 0, 0}, .to = {1, 0, 0}, .damping = 3});
  m.gravity({0, 0, 0});
  const SystemModel model = m.model();
  VectorXd g(24), xi = VectorXd::Zero(12);
  registry()
      .geometry(model.group.name, "exp")
      ->from_coordinates(model.start.configuration, g.data());
  xi[3] = 0.2;
  xi[9] = 0.7;
  EXPECT_NEAR(model.mechanics->power(0, g.data(), xi), -3 * 0.5 * 0.5, 1e-15);
}

TEST(Mechanisms, OfTheLibraryObeyTheLawsOfSystems) {
  registry();
  EXPECT_GE(mechanisms::library().size(), 9u);
  for (const auto& [name, text] : mechanisms::library()) {
    for (const LawResult& law : check_system(registry(), name)) {
      EXPECT_TRUE(law.passed()) << name << ": " << law;
    }
  }
}

// A mechanism of one's own is added and found like a system.
TEST(Mechanisms, AreAddedByName) {
  Registry mine = registry();
  mine.add(system_info(by_parts::sleigh({})));
  const Result by_name = Simulation(mine, "sleigh").start({.velocity = {-1}}).until(1).run();
  EXPECT_TRUE(by_name.status.ok);
  EXPECT_EQ(by_name.config.start.velocity, (std::vector<double>{0, -1, 0}));
  EXPECT_EQ(by_name.trajectory.columns()[1], "theta");
}

// A motor and a prescribed joint whose signals are inputs of the run do what the same signals do in
// the mechanism.
TEST(Mechanisms, AreDrivenByInputs) {
  const auto make = [](bool inputs) {
    Mechanism m = by_parts::racer({.stiffness = 0, .torque = 0});
    m.body("flag", {.mass = 0.3, .at = {0.2, 0, 0}, .inertia = {0, 0, 0.01}});
    m.hinge("turret", "rear", "flag", {});
    if (inputs) {
      m.motor("steer", between(-1, 1));
      m.prescribe("turret");
    } else {
      m.motor("steer", [](const SignalInput&) { return 0.2; });
      m.prescribe("turret", [](double t) { return 3 * t; });
    }
    return m;
  };
  const Simulation ours = simulate(make(true));
  const Result driven = Simulation(ours)
                            .input("steer.torque", 0.2)
                            .input("turret.rate", InputTable{{-1, 3}, {-3, 9}})
                            .until(2)
                            .run();
  const Result signals = simulate(make(false)).until(2).run();
  ASSERT_TRUE(driven.status.ok);
  EXPECT_LT(largest_difference(driven.last.coordinates, signals.last.coordinates), 1e-12);
  EXPECT_LT(largest_difference(driven.last.velocity, signals.last.velocity), 1e-12);
  EXPECT_NEAR(driven.last.velocity[4], 6, 1e-12);                        // the turret
  EXPECT_NEAR(driven.energy_error_max, signals.energy_error_max, 1e-9);  // with the work of both
  const Result at_rest =
      Simulation(ours).start({.velocity = std::vector<double>(5)}).until(1).run();
  EXPECT_NEAR(at_rest.last.velocity[4], 0, 1e-15);
  EXPECT_EQ(ours.build().system().inputs[1].unit, "rad/s");
  EXPECT_THAT(Simulation(ours).input("steer.torque", 2).mistakes(),
              testing::Contains(HasSubstr("steer.torque")));
  EXPECT_THAT(Simulation(ours).input("steer.force", 2).mistakes(),
              testing::Contains(HasSubstr("did you mean 'steer.torque'?")));
}

}  // namespace
}  // namespace hamel
