// Steps of a long chain: their cost in evaluations, which no machine changes.
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/framework/schemes/dynamic_problem.hpp>
#include <hamel/simulate.hpp>

#include "../benchmarks/chains.hpp"
#include "mechanism_systems.hpp"

namespace {

using namespace hamel;

/// A step of lift with 200 bodies makes no Jacobian of differences (411 evaluations), neither in
/// its solve nor on the path to the principal root, which the first steps follow. The path is in no
/// statistics: the rows are counted by the rate of the last hinge.
TEST(LongChain, AStepMakesNoJacobian) {
  constexpr int kBodies = 200;
  long rows = 0;
  Mechanism snake = benchmarks::snake(kBodies);
  std::map<std::string, double> start = {{"v1", 0}};
  for (int i = 1; i + 1 < kBodies; ++i) start[fmt::format("hinge {}.rate", i)] = 0.1 * std::cos(i);
  snake.start(start);
  const auto rate = [&rows](double) {
    ++rows;
    return 0.1;
  };
  snake.prescribe(
      fmt::format("hinge {}", kBodies - 1), rate, [](double t) { return 0.1 * t; },
      [](double) { return 0.0; });
  hamel::Run run = simulate(snake).scheme("lift").step(0.001).build();
  for (int k = 1; k <= 6; ++k) {
    const long evaluations = run.stats().evaluations;
    rows = 0;
    ASSERT_TRUE(run.step()) << k;
    EXPECT_LE(run.stats().evaluations - evaluations, 12) << k;
    EXPECT_LE(rows, k <= 2 ? 60 : 15) << k;
  }
}

/// Six times the bodies take hardly more evaluations where the motion is as slow.
TEST(LongChain, EvaluationsDoNotGrowWithTheBodies) {
  const auto evaluations = [](int bodies) {
    hamel::Run run = simulate(benchmarks::snake(bodies)).scheme("lift").step(0.001).build();
    EXPECT_TRUE(run.step(20));
    const long before = run.stats().evaluations;
    EXPECT_TRUE(run.step(80));
    return static_cast<double>(run.stats().evaluations - before) / 80;
  };
  EXPECT_LE(evaluations(10), 6);
  EXPECT_LE(evaluations(60), 8);
}

/// The aim of a step with 60 trailers is above the round-off of its residual: 8 eps is below it,
/// and took 4.3 evaluations a step.
TEST(LongChain, TheAimIsReached) {
  hamel::Run run = simulate("n_trailer").set("trailers", 60).scheme("lift").step(0.001).build();
  EXPECT_TRUE(run.step(200));
  EXPECT_LE(static_cast<double>(run.stats().evaluations) / 200, 3.5);
}

/// A train of 60 bodies makes no Jacobian of differences (125 evaluations) where J = 1 contracts:
/// 3.0 evaluations a step; 12.2 where 1 was given up once it had cost as much.
TEST(LongChain, ATrainByPartsNeedsNoJacobian) {
  NTrailer train;
  train.trailers = 59;
  Mechanism by_parts = by_parts::train(train);
  by_parts.start({{"v1", 1}, {"hitch 1.angle", 0.3}});
  hamel::Run run = simulate(by_parts).scheme("lift").step(0.01).build();
  ASSERT_TRUE(run.step(220));
  EXPECT_LE(static_cast<double>(run.stats().evaluations) / 220, 3.5);
}

/// With many rows the accelerations are those of a frame: the solution of
///   [I -A^T; A 0] (xi', lambda) = (change, rows)   all the same.
TEST(LongChain, AccelerationsOfManyRowsAreThoseWithMultipliers) {
  NTrailer train;
  train.trailers = 20;
  const SystemModel system = by_parts::train(train).model();
  const auto geometry = registry().geometry(system.group.name, "cayley");
  const Mechanics& mechanics = *system.mechanics;
  const int n = mechanics.dim(), k = mechanics.constraint_count();
  ASSERT_GT(2 * k, n);
  EquationsOfMotion<DynamicProblem> motion(DynamicProblem(geometry, system.mechanics));
  Eigen::VectorXd g(geometry->size()), moved(g), shift(n), xi(n), b(k), rows(k), change(n);
  Eigen::MatrixXd inertia(n, n), a(k, n);
  geometry->from_coordinates(system.start.configuration, g.data());
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < n; ++j) {
      shift[j] = 0.3 * std::sin(1.0 + i + 2.0 * j);
      xi[j] = std::cos(1.0 + 2.0 * i + j);
    }
    geometry->tau(shift.data(), moved.data());
    geometry->compose(g.data(), moved.data(), moved.data());
    motion.solve(0, moved, xi);
    mechanics.motion(*geometry, 0, moved.data(), xi, inertia, a, b, rows, change);
    Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + k, n + k);
    whole << inertia, -a.transpose(), a, Eigen::MatrixXd::Zero(k, k);
    Eigen::VectorXd right(n + k);
    right << change, rows;
    const Eigen::VectorXd expected = whole.fullPivLu().solve(right);
    const double size = expected.head(n).norm(), force = expected.tail(k).norm();
    EXPECT_LE((motion.acceleration() - expected.head(n)).norm(), 1e-11 * size) << i;
    EXPECT_LE((motion.reaction() - expected.tail(k)).norm(), 1e-11 * force) << i;
    // The smallest velocity with these rows: orthogonal to ker A in the metric I.
    Eigen::VectorXd smallest(n);
    const double square = motion.smallest(rows, smallest);
    EXPECT_LE((a * smallest - rows).norm(), 1e-12 * rows.norm()) << i;
    const Eigen::VectorXd mu = inertia * smallest;
    EXPECT_NEAR(square, mu.dot(smallest), 1e-11 * square) << i;
    const Eigen::VectorXd lambda = a.transpose().colPivHouseholderQr().solve(mu);
    EXPECT_LE((a.transpose() * lambda - mu).norm(), 1e-11 * mu.norm()) << i;
  }
}

// 200 bodies in space, one hinged to the next: a first step of lift, with the path to its root,
// calls the equations of motion some 500 times, which is what one Jacobian of differences takes
// (and not 20 000 times); later steps a few times. A motor that does nothing counts the residuals.
TEST(LongChain, AStepTakesFewResiduals) {
  constexpr int bodies = 200;
  Mechanism m("chain");
  std::string ahead;
  std::map<std::string, double> start = {{"v1", 0.3}};
  for (int i = 0; i < bodies; ++i) {
    const std::string name = "link " + std::to_string(i), hinge = "h" + std::to_string(i);
    m.body(name, {.mass = 1, .at = {-0.3 * i, 0, 0.1}, .box = {0.3, 0.1, 0.05}});
    const Vec<3> axis = i % 2 == 0 ? Vec<3>(0, 1, 0) : Vec<3>(0, 0, 1);
    if (i == 0) m.free("space", name, {.at = {0, 0, 0.1}});
    else
      m.hinge(
          hinge, ahead, name,
          {.at = {-0.3 * i + 0.15, 0, 0.1}, .axis = {axis[0], axis[1], axis[2]}, .stiffness = 50});
    if (i > 0) start[hinge + ".rate"] = 0.1 * std::cos(i);
    ahead = name;
  }
  long residuals = 0;
  m.motor("h1", [&](const mechanisms::SignalInput&) {
    ++residuals;
    return 0.0;
  });
  m.start(start);
  for (const double h : {0.001, 0.01}) {
    hamel::Run run = simulate(m).scheme("lift").step(h).build();
    residuals = 0;
    const Status first = run.step();
    ASSERT_TRUE(first) << first.reason;
    EXPECT_LT(residuals, 1000) << h;
    residuals = 0;
    ASSERT_TRUE(run.step(3));
    EXPECT_LT(residuals, 3 * 1000) << h;
  }
}

}  // namespace
