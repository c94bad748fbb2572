// Equations of a system at any state: closed forms, and the motion of every registered system.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <hamel/framework/analysis/equations.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace {

using hamel::Equations;
using hamel::NumberMatrix;
using testing::HasSubstr;

// The coordinates of g tau(e_j x).
std::vector<double> element_moved(const std::string& system, const std::vector<double>& from, int j,
                                  double x) {
  const auto geometry =
      hamel::registry().geometry(hamel::simulate(system).build().system().group.name, "exp");
  std::vector<double> g(static_cast<size_t>(geometry->size())), moved(g);
  std::vector<double> eta(static_cast<size_t>(geometry->dim())), out(from);
  eta[static_cast<size_t>(j)] = x;
  geometry->from_coordinates(from, g.data());
  geometry->tau(eta.data(), moved.data());
  geometry->compose(g.data(), moved.data(), moved.data());
  geometry->coordinates(moved.data(), out.data());
  return out;
}

/// I w' = (I w) x w + lambda e3, w3 = 0: by hand.
TEST(Equations, OfTheSuslovProblem) {
  const double a = 1, b = 10, c = 100, u = 0.7, v = -1.3;
  const Equations e(hamel::simulate("suslov").set("inertia", {a, b, c}));
  const hamel::Start state = {.velocity = {u, v, 0}};
  EXPECT_EQ(e.velocities(), (std::vector<std::string>{"omega1", "omega2", "omega3"}));
  const std::vector<double> rate = e.rate(0, state), lambda = e.reactions(state);
  for (const double x : rate) EXPECT_NEAR(x, 0, 1e-15);
  ASSERT_EQ(lambda.size(), 1u);
  EXPECT_NEAR(lambda[0], -(a - b) * u * v, 1e-13);
  EXPECT_NEAR(e.energy(state), (a * u * u + b * v * v) / 2, 1e-13);
  EXPECT_NEAR(e.momentum(state)[1], b * v, 1e-14);
  const hamel::RowsOfState rows = e.rows(state);
  EXPECT_EQ(rows.a.values, (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(rows.b, std::vector<double>{0});
  EXPECT_TRUE(rows.holonomic.empty());
  const NumberMatrix inertia = e.inertia();
  EXPECT_EQ(inertia.values, (std::vector<double>{a, 0, 0, 0, b, 0, 0, 0, c}));

  const hamel::JacobianOfState by_velocity = e.jacobian("reactions", "velocity", state);
  const std::vector<double> closed = {-(a - b) * v, -(a - b) * u, 0};
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(by_velocity.values(0, j), closed[static_cast<size_t>(j)], 1e-11);
    EXPECT_LE(std::abs(by_velocity.values(0, j) - closed[static_cast<size_t>(j)]),
              by_velocity.errors(0, j) + 1e-15);
  }
  const hamel::JacobianOfState by_inertia = e.jacobian("reactions", "inertia", state);
  ASSERT_EQ(by_inertia.values.columns, 3);
  EXPECT_NEAR(by_inertia.values(0, 0), -u * v, 1e-11);
  EXPECT_NEAR(by_inertia.values(0, 1), u * v, 1e-11);
  EXPECT_NEAR(by_inertia.values(0, 2), 0, 1e-11);
}

/// xi' is the rate of the velocity along a motion, and satisfies the rows; with inputs too.
TEST(Equations, AreThoseOfTheMotion) {
  constexpr double h = 1e-4;
  int systems = 0;
  for (const std::string& name : hamel::systems()) {
    SCOPED_TRACE(name);
    hamel::Simulation simulation = hamel::simulate(name);
    const auto run = [&](double end) {
      hamel::Run one = hamel::Simulation(simulation)
                           .scheme("dop853")
                           .tolerance({.relative = 1e-13})
                           .step(std::copysign(h, end))
                           .until(end)
                           .build();
      EXPECT_TRUE(one.complete().ok);
      return one.state().velocity;
    };
    if (name == "segway") simulation.input("left_torque", 0.7);
    const Equations e(simulation);
    const std::vector<double> rate = e.rate(0), before = run(-h), after = run(h);
    double size = 0;
    for (const double x : rate) size = std::max(size, std::abs(x));
    for (size_t i = 0; i < rate.size(); ++i)
      EXPECT_NEAR((after[i] - before[i]) / (2 * h), rate[i], 1e-5 * (1 + size)) << i;
    const hamel::RowsOfState rows = e.rows();
    for (int i = 0; i < rows.a.rows; ++i) {
      double off = -rows.b[static_cast<size_t>(i)];
      for (int j = 0; j < rows.a.columns; ++j)
        off += rows.a(i, j) * e.start().velocity[static_cast<size_t>(j)];
      EXPECT_NEAR(off, 0, 1e-12) << rows.names[static_cast<size_t>(i)];
    }
    EXPECT_EQ(e.reactions().size(), static_cast<size_t>(rows.a.rows));
    ++systems;
  }
  EXPECT_GT(systems, 20);
}

/// The torque of an input enters linearly; gravity's own derivative is the potential over gravity.
TEST(Equations, ByInputsAndParameters) {
  const Equations e(hamel::simulate("segway").input("left_torque", 0.2));
  const hamel::JacobianOfState by_torque = e.jacobian("rate", "left_torque");
  const std::vector<double> here = e.rate(0),
                            more = Equations(hamel::simulate("segway").input("left_torque", 1.2))
                                       .rate(0);
  for (size_t i = 0; i < here.size(); ++i)
    EXPECT_NEAR(by_torque.values(static_cast<int>(i), 0), more[i] - here[i], 1e-9) << i;
  const Equations bicycle(hamel::simulate("bicycle").speed(5));
  const double rest = Equations(hamel::simulate("bicycle").set("gravity", 5).speed(5)).energy(),
               usual = bicycle.energy();
  EXPECT_NEAR(bicycle.jacobian("energy", "gravity").values(0, 0), (usual - rest) / (9.81 - 5),
              1e-6);
}

/// Without dissipation xi' is quadratic in xi: a difference over any step is its derivative.
TEST(Equations, ByVelocities) {
  const Equations e(hamel::simulate("bicycle").start("steer.angle", 0.2).speed(5));
  const hamel::JacobianOfState found = e.jacobian("rate", "velocity");
  for (size_t j = 0; j < e.velocities().size(); ++j) {
    hamel::Start less = e.start(), more = e.start();
    less.velocity[j] -= 1;
    more.velocity[j] += 1;
    const std::vector<double> low = e.rate(0, less), high = e.rate(0, more);
    for (size_t i = 0; i < low.size(); ++i) {
      const auto row = static_cast<int>(i), column = static_cast<int>(j);
      EXPECT_NEAR(found.values(row, column), (high[i] - low[i]) / 2,
                  found.errors(row, column) + 1e-11)
          << e.velocities()[i] << " by " << e.velocities()[j];
      EXPECT_LT(found.errors(row, column), 1e-10);
    }
  }
}

/// Exact derivatives of formulas are those of differences.
TEST(Equations, ExactDerivativesAreThoseOfDifferences) {
  for (const std::string name : {"bicycle", "falling_disk", "segway", "suslov_in_potential"}) {
    SCOPED_TRACE(name);
    const Equations e(hamel::simulate(name));
    for (const std::string of : {"velocity", "configuration", "time"}) {
      SCOPED_TRACE(of);
      const hamel::JacobianOfState found = e.jacobian("rate", of);
      const hamel::Start here = e.start();
      constexpr double h = 1e-4;
      for (int j = 0; j < found.values.columns; ++j) {
        hamel::Start less = here, more = here;
        double t = 0;
        if (of == "velocity") {
          less.velocity[static_cast<size_t>(j)] -= h;
          more.velocity[static_cast<size_t>(j)] += h;
        } else if (of == "configuration") {
          const auto moved = [&](double x) {
            return element_moved(name, here.configuration, j, x);
          };
          less.configuration = moved(-h);
          more.configuration = moved(h);
        } else {
          t = h;
        }
        const std::vector<double> low = e.rate(-t, less), high = e.rate(t, more);
        for (size_t i = 0; i < low.size(); ++i) {
          const double difference = (high[i] - low[i]) / (2 * h);
          EXPECT_NEAR(found.values(static_cast<int>(i), j), difference,
                      1e-5 * (1 + std::abs(difference)))
              << i << ", " << j;
        }
      }
    }
  }
}

TEST(Equations, RefusesStatesThatAreNone) {
  const Equations e(hamel::simulate("suslov"));
  const auto refused = [](auto&& call) {
    try {
      call();
    } catch (const hamel::ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_THAT(refused([&] {
                e.rate(0, {.velocity = {1, 2}});
              }),
              HasSubstr("velocity: got 2 numbers, expected 3"));
  EXPECT_THAT(refused([&] {
                e.rate(0, {.configuration = {1, 0, 0, 0, 1, 0, 0, 0, 2}});
              }),
              HasSubstr("configuration: "));
  EXPECT_THAT(refused([&] {
                e.rate(0, {.velocity = {1, 2, 0}, .momentum = {1, 2, 0}});
              }),
              HasSubstr("not both"));
  EXPECT_THAT(refused([&] { e.rate(std::nan("")); }), HasSubstr("expected a finite time"));
  EXPECT_THAT(
      refused([&] { e.jacobian("rates", "inertai"); }),
      testing::AllOf(HasSubstr("did you mean 'rate'"), HasSubstr("did you mean 'inertia'")));
}

}  // namespace
