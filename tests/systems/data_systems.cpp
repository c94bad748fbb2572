// Systems by data against the same systems as C++ structs, along trajectories: every formula that a
// file may state.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include <hamel/framework/check/system_laws.hpp>
#include <hamel/framework/mechanics/coordinate_rates.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/systems/contact_oscillator.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/segway.hpp>
#include <hamel/systems/simulate_typed.hpp>
#include <hamel/systems/snakeboard.hpp>

#include "written_in_cpp.hpp"

namespace hamel {
namespace {

std::string example(const std::string& name) {
  const char* root = std::getenv("HAMEL_SOURCE");
  EXPECT_NE(root, nullptr) << "set HAMEL_SOURCE to the source tree (ctest does)";
  std::ifstream in(std::string(root == nullptr ? "." : root) + "/tests/examples/" + name);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

Simulation by_data(const std::string& text) {
  return {registry(), "data", OwnSystem{data_system_maker(registry(), "data.toml", text)}};
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = a.size() == b.size() ? 0 : 1e300;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    most = std::max(most, std::abs(a[i] - b[i]) / (1 + std::abs(a[i])));
  return most;
}

struct Options {
  const char* scheme = "lift";
  double until = 3;
  InputSignals inputs = {};
  double bound = 1e-11;
};

// The largest difference over the whole trajectory: coordinates, velocities, momenta, multipliers,
// energy.
void same(Simulation hers, Simulation ours, const Options& o) {
  SCOPED_TRACE(o.scheme);
  for (Simulation* s : {&hers, &ours}) {
    s->scheme(o.scheme).step(0.01).until(o.until);
    for (const auto& [name, signal] : o.inputs) s->input(name, std::get<double>(signal));
  }
  const Result a = hers.run();
  const Result b = ours.start(a.config.start).run();
  ASSERT_TRUE(a.status.ok && b.status.ok) << a.status.reason << b.status.reason;
  ASSERT_EQ(a.trajectory.rows(), b.trajectory.rows());
  const size_t before = a.trajectory.index("iterations"), lambda = 1;
  for (size_t row = 0; row < a.trajectory.rows(); ++row) {
    for (size_t j = lambda; j < before - 2; ++j) {  // not the residuals and the solver's figures
      EXPECT_NEAR(a.trajectory.at(row, j), b.trajectory.at(row, j),
                  o.bound * (1 + std::abs(a.trajectory.at(row, j))))
          << "row " << row << ", column " << j;
    }
  }
  EXPECT_LT(apart(a.last.velocity, b.last.velocity), o.bound);
  for (size_t k = 1; k <= static_cast<size_t>(a.system->mechanics->constraint_count()); ++k) {
    const std::string name = "lambda" + std::to_string(k);
    EXPECT_LT(apart(a.trajectory.column(name), b.trajectory.column(name)), 100 * o.bound) << name;
  }
  EXPECT_EQ(a.system->mechanics->has_force(), b.system->mechanics->has_force());
  EXPECT_EQ(a.system->mechanics->has_drift(), b.system->mechanics->has_drift());
  EXPECT_EQ(a.system->mechanics->autonomous(), b.system->mechanics->autonomous());
  EXPECT_EQ(a.system->mechanics->constant_constraints(),
            b.system->mechanics->constant_constraints());
  EXPECT_EQ(a.system->mechanics->constant_inertia(), b.system->mechanics->constant_inertia());
}

// ---- the examples -------------------------------------------------------------------------------

TEST(DataSystems, ContactOscillator) {
  for (const char* scheme : {"lift", "balance", "rkmk4"}) {
    ContactOscillator system;
    system.ratio = 0.2;
    system.spring = 1.3;
    same(simulate(system), by_data(example("contact_oscillator.toml")), {.scheme = scheme});
  }
  // Another ratio and spring, set.
  ContactOscillator system;
  system.ratio = -0.4;
  system.spring = 2.5;
  same(simulate(system),
       by_data(example("contact_oscillator.toml")).set("ratio", -0.4).set("k", 2.5), {});
}

TEST(DataSystems, ParticleInAPotential) {
  const std::string text = example("particle_in_potential.toml");
  for (const char* scheme : {"lift", "balance", "dopri5"})
    same(simulate(Particle{}), by_data(text), {.scheme = scheme});
  same(simulate(Particle{}), by_data(text), {.inputs = {{"push", 0.3}}});
}

TEST(DataSystems, KickScooter) {
  const std::string text = example("scooter_by_rows.toml");
  for (const char* scheme : {"lift", "balance"})
    same(simulate(Scooter{}), by_data(text), {.scheme = scheme});
  same(simulate(Scooter{}), by_data(text), {.inputs = {{"torque", 0.05}}});
}

// ---- what the examples do not have: I(g), phi(g), b(t, g), contacts, events, invariants
// --------------

TEST(DataSystems, InertiaThatDependsOnTheConfiguration) {
  same(simulate("segway"), by_data(R"toml(
group = "se2*so2^3"
coordinates = ["theta", "x", "y", "right", "left", "pitch"]
inertia = [
  ["(I1 + m*b^2)*sin(pitch)^2 + I3*cos(pitch)^2 + 2*(5*c^2 + 0.08)", 0, "m*b*sin(pitch)", 0, 0, 0],
  [0, "m + 10", 0, 0, 0, "m*b*cos(pitch)"],
  ["m*b*sin(pitch)", 0, "m + 10", 0, 0, 0],
  [0, 0, 0, 0.15, 0, 0],
  [0, 0, 0, 0, 0.15, 0],
  [0, "m*b*cos(pitch)", 0, 0, 0, "7 + m*b^2"]]
constraints = [[0, 0, 1, 0, 0, 0], ["c", 1, 0, -0.25, 0, 0], ["-c", 1, 0, 0, -0.25, 0]]
potential = "m*9.81*b*cos(pitch)"
force = [0, 0, 0, "right_torque", "left_torque", "-right_torque - left_torque"]
[parameters]
m = 60
b = 0.9
c = 0.3
I1 = 8
I3 = 2
[inputs]
right_torque = {}
left_torque = {}
)toml"),
       {.until = 1, .inputs = {{"right_torque", 1.5}, {"left_torque", -0.5}}});
}

constexpr const char* kDisk = R"toml(
name = "disk"
group = "se3"
inertia = [0.0625, 0.0625, 0.125, 1, 1, 1]
# v + omega x r = 0 along e3 x gamma and across, seen from the body; gamma = (R31, R32, R33)
constraints = [[0, 0, "-rho", "-R32/sqrt(R31^2 + R32^2)", "R31/sqrt(R31^2 + R32^2)", 0],
  ["-rho*R32", "rho*R31", 0,
   "-R33*R31/sqrt(R31^2 + R32^2)", "-R33*R32/sqrt(R31^2 + R32^2)", "sqrt(R31^2 + R32^2)"]]
holonomic = ["z - rho*sqrt(R31^2 + R32^2)"]
potential = "9.81*z"
contacts = [3]
[parameters]
rho = 0.5
[events]
fallen = { value = "z - 0.1*rho", meaning = "lower than a tenth of the radius", direction = -1 }
[invariants]
energy = "0.5*(0.0625*(omega1^2 + omega2^2) + 0.125*omega3^2 + v1^2 + v2^2 + v3^2) + 9.81*z"
)toml";

TEST(DataSystems, HolonomicRows) {
  same(simulate("falling_disk"), by_data(kDisk), {.until = 1});
  const Start start = FallingDisk{}.rolling(1, {0.1, 0.1, 0.5});  // too slow to stay up
  const auto both = [&](Simulation s) {
    return s.start(start).step(0.002).until(5).stop_at({"fallen"}).run();
  };
  const Result hers = both(simulate("falling_disk")), ours = both(by_data(kDisk));
  EXPECT_NEAR(hers.last.time, ours.last.time, 1e-8);
  EXPECT_LT(ours.last.time, 4.9) << "it has fallen";
  ASSERT_EQ(ours.invariants.size(), 1u);
  EXPECT_NEAR(hers.invariants[0].start, ours.invariants[0].start, 1e-13);
  EXPECT_NEAR(hers.invariants[0].drift_max, ours.invariants[0].drift_max, 1e-9);
}

TEST(DataSystems, MovingRowsAndInputsInThem) {
  const std::string board = R"toml(
group = "se2*so2^3"
coordinates = ["theta", "x", "y", "psi", "front", "back"]
inertia = [[0.24, 0, 0, 0.12, 0.006, 0.006], [0, 6, 0, 0, 0, 0], [0, 0, 6, 0, 0, 0],
           [0.12, 0, 0, 0.12, 0, 0], [0.006, 0, 0, 0, 0.006, 0], [0.006, 0, 0, 0, 0, 0.006]]
constraints = [["0.2*cos(front)", "-sin(front)", "cos(front)", 0, 0, 0],
               ["-0.2*cos(back)", "-sin(back)", "cos(back)", 0, 0, 0],
               [0, 0, 0, 1, 0, 0], [0, 0, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1]]
drift = [0, 0, "2*0.7*cos(2*t) + rotor_rate", "2*0.3*cos(2*t) + front_rate",
         "-2*0.3*cos(2*t) + back_rate"]
[inputs]
rotor_rate = {}
front_rate = {}
back_rate = {}
)toml";
  same(simulate("snakeboard"), by_data(board), {});
  same(simulate("snakeboard"), by_data(board),
       {.inputs = {{"rotor_rate", 0.2}, {"front_rate", 0.02}, {"back_rate", -0.03}}});
}

// ---- laws ---------------------------------------------------------------------------------------

TEST(DataSystems, KeepTheLawsOfASystem) {
  for (const char* name : {"contact_oscillator.toml", "particle_in_potential.toml",
                           "scooter_by_rows.toml", "skate_in_a_bowl.toml"}) {
    const SystemModel model = data_system(registry(), example(name), name);
    const auto geometry = registry().geometry(model.group.name, "exp");
    for (const LawResult& law : check_system(model, 3, geometry.get()))
      EXPECT_TRUE(law.passed()) << name << ": " << law.law << " " << law.measured;
  }
}

/// db/dt - (dA/dt) xi and (dI/dt) xi of formulas, against differences along the motion.
TEST(DataSystems, RatesAlongTheMotion) {
  const SystemModel model = data_system(registry(), R"toml(
group = "se3*so2*se2"
coordinates = ["R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33", "x", "y", "z",
               "angle", "theta", "x_3", "y_3"]
inertia = ["1 + z^2", 1, 1, 1, 1, "2 + sin(angle)", 1, 1, 1, "3 + R12*x_3"]
constraints = [[0, "R23*y + t", "sin(angle)*t^2", 1, 0, 0, 0, 0, 0, 0],
               [0, 0, 0, 0, "cos(theta) - x*y_3", 0, "exp(t)*R31", 0, 0, 1]]
drift = ["sin(3*t)*R11", "x_3*theta"]
)toml",
                                        "rates.toml");
  const auto geometry = registry().geometry(model.group.name, "exp");
  const Mechanics& mechanics = *model.mechanics;
  const int n = mechanics.dim(), k = mechanics.constraint_count();
  Eigen::VectorXd xi(n), g(geometry->size()), moved(geometry->size()), b(k), rows(k), momentum(n);
  Eigen::MatrixXd a(k, n), inertia(n, n);
  for (int i = 0; i < n; ++i) xi[i] = std::sin(1.7 * i + 0.4);
  geometry->tau(xi.data(), g.data());
  ASSERT_TRUE(mechanics.exact_rates());
  mechanics.rates(*geometry, 0.3, g.data(), xi, rows, momentum);
  const auto all = [&](double e) {
    const Eigen::VectorXd step = e * xi;
    geometry->tau(step.data(), moved.data());
    geometry->compose(g.data(), moved.data(), moved.data());
    mechanics.constraints(0.3 + e, moved.data(), a, b);
    mechanics.inertia(moved.data(), inertia);
  };
  const auto rows_at = [&](double e) -> Eigen::VectorXd {
    all(e);
    return b - a * xi;
  };
  const auto momentum_at = [&](double e) -> Eigen::VectorXd {
    all(e);
    return inertia * xi;
  };
  EXPECT_LT((rows - check::derivative(rows_at, 4e-3)).lpNorm<Eigen::Infinity>(), 2e-9);
  EXPECT_LT((momentum - check::derivative(momentum_at, 4e-3)).lpNorm<Eigen::Infinity>(), 2e-9);
}

/// C(g)^T of every group against differences of its coordinates.
TEST(DataSystems, RatesOfCoordinates) {
  for (const std::string name :
       {"so2", "so3", "se2", "se3", "r3", "r6", "heisenberg", "se3*so3*se2^2*r2", "se2*r4"}) {
    const auto group = registry().group_or_product(name);
    const auto geometry = registry().geometry(name, "exp");
    const int n = geometry->dim(), columns = geometry->columns();
    Eigen::VectorXd xi(n), g(geometry->size()), h(geometry->size()), x(columns), slope(columns),
        out = Eigen::VectorXd::Zero(n);
    for (int i = 0; i < n; ++i) xi[i] = std::sin(1.7 * i + 0.4);
    for (int i = 0; i < columns; ++i) slope[i] = std::cos(2.3 * i);
    geometry->tau(xi.data(), g.data());
    geometry->coordinates(g.data(), x.data());
    CoordinateRates(*group, geometry).add_pulled_back(g.data(), x.data(), slope.data(), out);
    for (int i = 0; i < n; ++i) {
      const double derivative = check::derivative(
          [&](double e) {
            const Eigen::VectorXd step = e * Eigen::VectorXd::Unit(n, i);
            geometry->tau(step.data(), h.data());
            geometry->compose(g.data(), h.data(), h.data());
            geometry->coordinates(h.data(), x.data());
            return slope.dot(x);
          },
          4e-3);
      EXPECT_NEAR(out[i], derivative, 1e-10) << name << ", " << i;
    }
  }
}

}  // namespace
}  // namespace hamel
