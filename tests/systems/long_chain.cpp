// Steps of a long chain: their cost in evaluations, which no machine changes.
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include <hamel/simulate.hpp>

#include "../benchmarks/chains.hpp"

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

}  // namespace
