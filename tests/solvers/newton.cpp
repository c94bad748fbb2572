// Newton on equations made for it: iterations, tolerance, the round-off floor, and every way to
// fail.
#include <gtest/gtest.h>

#include <limits>

#include <hamel/solvers/newton.hpp>
#include <hamel/systems/chaplygin_sleigh.hpp>
#include <hamel/systems/simulate_typed.hpp>
#include <hamel/systems/suslov.hpp>

namespace {

using namespace hamel;

/// An equation from two functions.
template <int N>
struct Made {
  using Unknown = Vec<N>;
  using Jacobian = Mat<N, N>;
  std::function<Unknown(const Unknown&)> f;
  std::function<Jacobian(const Unknown&)> j;
  double size = 1;
  double scale_squared() const { return size * size; }
  void residual(const Unknown& x, Unknown& out) const { out = f(x); }
  void linearise(const Unknown& x, Unknown& out, Jacobian& jacobian) const {
    out = f(x);
    jacobian = j(x);
  }
};

/// As the kernels call it.
template <class Step>
SolveReport solve(const Step& step, typename Step::Unknown& x, double tolerance,
                  Newton::Memory<typename Step::Unknown>& memory) {
  SolveReport report;
  Newton::solve(step, x, tolerance, memory, report);
  return report;
}
/// A first solve, nothing remembered.
template <int N>
SolveReport solve(const Made<N>& step, Vec<N>& x, double tolerance) {
  Newton::Memory<Vec<N>> memory;
  return solve(step, x, tolerance, memory);
}

Made<1> square_root(double a) {
  return {[a](const Vec<1>& x) { return Vec<1>(x[0] * x[0] - a); },
          [](const Vec<1>& x) { return Mat<1, 1>(2 * x[0]); }};
}

TEST(Newton, FindsARoot) {
  const Made<1> step = square_root(2);
  Vec<1> x(1.5);
  const SolveReport report = solve(step, x, 1e-13);
  EXPECT_TRUE(report.ok());
  EXPECT_NEAR(x[0], std::sqrt(2.0), 1e-13);
  EXPECT_LE(report.iterations,
            13);  // a kept Jacobian cuts the residual at least by ten a correction
  // The residual reported is that of the point returned.
  EXPECT_DOUBLE_EQ(report.residual, std::abs(x[0] * x[0] - 2));
}

TEST(Newton, FromFarAwayWithHalvedSteps) {
  // atan: plain Newton diverges from 3.
  const Made<1> step = {[](const Vec<1>& x) { return Vec<1>(std::atan(x[0])); },
                        [](const Vec<1>& x) { return Mat<1, 1>(1 / (1 + x[0] * x[0])); }};
  Vec<1> x(3);
  EXPECT_TRUE(solve(step, x, 1e-13).ok());
  EXPECT_NEAR(x[0], 0, 1e-13);
}

TEST(Newton, MakesOneCorrectionOfAGoodGuess) {
  const Made<1> step = square_root(2);
  Vec<1> x(std::sqrt(2.0) * (1 + 3e-14));  // already within 1e-13
  const SolveReport report = solve(step, x, 1e-13);
  EXPECT_TRUE(report.ok());
  EXPECT_EQ(report.iterations, 1);
  EXPECT_NEAR(x[0], std::sqrt(2.0), 4e-16);
}

TEST(Newton, AnUnreachableToleranceEndsAtRoundOff) {
  const Made<1> step = square_root(2);  // no double squares to 2
  Vec<1> x(1.5);
  const SolveReport report = solve(step, x, 1e-17);
  EXPECT_EQ(report.reason, Reason::round_off);
  EXPECT_TRUE(report.ok());
  EXPECT_LE(report.residual, 4.5e-16);
  EXPECT_LE(report.iterations, 18);
}

TEST(Newton, NoRootStagnates) {
  const Made<1> step = {[](const Vec<1>& x) { return Vec<1>(1 + x[0] * x[0]); },
                        [](const Vec<1>& x) { return Mat<1, 1>(2 * x[0] + 1e-12); }};
  Vec<1> x(1);
  const SolveReport report = solve(step, x, 1e-13);
  EXPECT_FALSE(report.ok());
  EXPECT_TRUE(report.reason == Reason::stagnated || report.reason == Reason::max_iterations)
      << to_string(report.reason);
  EXPECT_LE(report.iterations, Newton::max_iterations);
}

TEST(Newton, ASingularJacobianIsNamed) {
  const Made<2> step = {[](const Vec<2>& x) { return Vec<2>(x[0] + x[1] - 1, x[0] + x[1] - 2); },
                        [](const Vec<2>&) { return Mat<2, 2>::Ones(); }};
  Vec<2> x(0, 0);
  EXPECT_EQ(solve(step, x, 1e-13).reason, Reason::singular);
}

TEST(Newton, NotANumberIsNamed) {
  const Made<1> step = {[](const Vec<1>& x) { return Vec<1>(std::sqrt(x[0] - 5)); },
                        [](const Vec<1>&) { return Mat<1, 1>(1); }};
  Vec<1> x(0);
  EXPECT_EQ(solve(step, x, 1e-13).reason, Reason::not_finite);
}

/// A trial point where the equation is undefined is halved away, not accepted.
TEST(Newton, BacksOutOfAnUndefinedRegion) {
  const Made<1> step = {[](const Vec<1>& x) { return Vec<1>(std::log(x[0])); },
                        [](const Vec<1>& x) { return Mat<1, 1>(1 / x[0]); }};
  Vec<1> x(3);  // the full step goes to 3 - 3 log 3 < 0
  EXPECT_TRUE(solve(step, x, 1e-13).ok());
  EXPECT_NEAR(x[0], 1, 1e-13);
}

/// Broyden's update: the new J takes c to the change of F that it made, and what is orthogonal to c
/// to what it was; a correction that made nothing of F leaves J as it was.
TEST(Newton, AKeptJacobianLearns) {
  const Mat<3, 3> j{{2, 0.3, -0.4}, {0.1, 1.5, 0.2}, {-0.3, 0.5, 3}};
  const Vec<3> f(1, -2, 0.5), left(0.1, 0.2, -0.15);
  Inverse<Mat<3, 3>> kept;
  kept.compute(j);
  Vec<3> c, found;
  kept.solve(f, c);
  kept.update(c, left);
  kept.solve(Vec<3>(f - left), found);
  EXPECT_LT((found - c).norm(), 1e-14);
  const Vec<3> across = c.cross(Vec<3>(1, 2, 3));
  kept.solve(Vec<3>(j * across), found);
  EXPECT_LT((found - across).norm(), 1e-13);
  const Mat<3, 3> before = kept.matrix();
  kept.solve(f, c);
  kept.update(c, f);
  EXPECT_EQ(kept.matrix(), before);
}

TEST(Newton, RestIsAccepted) {
  const Made<2> step = {[](const Vec<2>& x) { return x; },
                        [](const Vec<2>&) { return Mat<2, 2>(Mat<2, 2>::Identity()); }, 0};
  Vec<2> x(0, 0);
  const SolveReport report = solve(step, x, 1e-13);
  EXPECT_TRUE(report.ok());
  EXPECT_LE(report.iterations, 1);
  EXPECT_EQ(report.residual, 0);
}

/// The Jacobian of an earlier step serves while it contracts; a useless one is replaced.
TEST(Newton, ARememberedJacobianServesOrIsReplaced) {
  Newton::Memory<Vec<1>> memory;
  Vec<1> x(1.4142);
  EXPECT_TRUE(solve(square_root(2), x, 1e-13, memory).ok());
  memory.factors.compute(Mat<1, 1>(2 * x[0]));
  memory.valid = true;
  int jacobians = 0;
  Made<1> near = square_root(2.0001);
  near.j = [&](const Vec<1>& at) {
    ++jacobians;
    return Mat<1, 1>(2 * at[0]);
  };
  EXPECT_TRUE(solve(near, x, 1e-13, memory).ok());
  EXPECT_NEAR(x[0], std::sqrt(2.0001), 1e-13);
  EXPECT_LE(jacobians, 1);
  for (const double wrong : {-1.0, 1e-3, 1e6, std::numeric_limits<double>::quiet_NaN()}) {
    memory.factors.compute(Mat<1, 1>(wrong));
    memory.valid = true;
    Vec<1> y(1.5);
    EXPECT_TRUE(solve(near, y, 1e-13, memory).ok()) << wrong;
    EXPECT_NEAR(y[0], std::sqrt(2.0001), 1e-13) << wrong;
  }
}

TEST(Newton, LargerThanFour) {
  Mat<6, 6> a = Mat<6, 6>::Identity() * 3;
  for (int i = 0; i < 5; ++i) a(i, i + 1) = 1;
  const Made<6> step = {[a](const Vec<6>& x) { return Vec<6>(a * x - Vec<6>::Ones()); },
                        [a](const Vec<6>&) { return a; }};
  Vec<6> x = Vec<6>::Zero();
  EXPECT_TRUE(solve(step, x, 1e-13).ok());
  EXPECT_LE((a * x - Vec<6>::Ones()).norm(), 1e-14);
}

/// Many unknowns without a Jacobian: A x - 1, and what its last digits make of it.
struct Many {
  using Unknown = Eigen::VectorXd;
  using Jacobian = Eigen::MatrixXd;
  Eigen::MatrixXd a;
  double noise = 0;  // of each entry
  double scale_squared() const { return 1; }
  void residual(const Unknown& x, Unknown& f) const {
    f = a * x - Unknown::Ones(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) f[i] += noise * std::sin(1e17 * x[i] + double(i));
  }
};

/// The frame of a step makes its Jacobian 1 + O(h): many unknowns begin with 1, which is replaced
/// by a Jacobian of differences where a solve takes many corrections, and kept where it takes few.
TEST(Newton, ManyUnknownsBeginWithOne) {
  constexpr int n = 40, cost = 2 * n + 1;
  Many step = {Eigen::MatrixXd::Identity(n, n)};
  for (int i = 0; i < n; ++i) step.a(i, (i + 1) % n) = 0.02;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  Newton::Memory<Eigen::VectorXd> memory(x);
  SolveReport report = solve(step, x, 1e-13, memory);
  EXPECT_TRUE(report.ok());
  EXPECT_LT(report.evaluations, cost / 2);
  int spent = report.evaluations;
  for (int k = 0; k < 40; ++k) {
    x.setZero();
    report = solve(step, x, 1e-13, memory);
    EXPECT_TRUE(report.ok());
    spent += report.evaluations;
  }
  EXPECT_LT(spent, 40 * 4 + 2 * cost);
  EXPECT_LE(report.iterations, 2);
  step.a = Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i < n; ++i) step.a(i, (i + 1) % n) = 0.002;
  memory.clear_history();
  for (int k = 0; k < 40; ++k) {
    x.setZero();
    report = solve(step, x, 1e-13, memory);
    EXPECT_TRUE(report.ok());
    EXPECT_LE(report.evaluations, 7) << k;
  }
  // Far from 1 it is given up at once.
  for (int i = 0; i < n; ++i) step.a(i, (i + 1) % n) = 0.02;
  step.a *= 3;
  memory.clear_history();
  x.setZero();
  report = solve(step, x, 1e-13, memory);
  EXPECT_TRUE(report.ok());
  EXPECT_LE(report.evaluations, cost + 6);
}

/// Where F is known no better than to some 1e-14, no Jacobian is made to find less of it.
TEST(Newton, LooksForNothingBelowTheFloor) {
  constexpr int n = 40, cost = 2 * n + 1;
  const Many step = {3 * Eigen::MatrixXd::Identity(n, n), 8e-15};
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  Newton::Memory<Eigen::VectorXd> memory(x);
  SolveReport report = solve(step, x, 1e-13, memory);
  EXPECT_TRUE(report.ok());
  EXPECT_GT(report.residual, 1.5e-14);  // above 64 eps
  EXPECT_LE(report.evaluations, 3 * cost);
  int spent = 0;
  for (const double from : {0.3, 0.32, 0.35, 0.31, 0.36, 0.34, 0.37, 0.33}) {
    x.setConstant(from);
    report = solve(step, x, 1e-13, memory);
    EXPECT_TRUE(report.ok());
    spent += report.evaluations;
  }
  EXPECT_LT(spent, cost + 8 * cost / 4) << "one Jacobian finds the floor, and is kept";
}

// ---- in a run -----------------------------------------------------------------------------------

Simulation full_suslov() {
  return simulate("suslov").set("inertia", {2, .3, .5, 3, .4, 4}).start({.velocity = {1, 0.5, 0}});
}

/// With the extrapolated guess the solve is one or two corrections a step.
TEST(NewtonInARun, TakesFewIterations) {
  for (const char* scheme : {"lift", "balance", "boxed", "unadapted"}) {
    for (const char* retraction : {"exp", "cayley"}) {
      const Result r = full_suslov().scheme(scheme).retraction(retraction).until(10).run();
      ASSERT_TRUE(r.status.ok);
      EXPECT_LE(static_cast<double>(r.stats.iterations) / static_cast<double>(r.steps), 2)
          << scheme;
      EXPECT_LE(r.stats.iterations_max, 6) << scheme;
      EXPECT_LE(r.stats.residual_max, 1e-13) << scheme;
    }
  }
}

TEST(NewtonInARun, ToleranceBelowRoundOffEndsAtTheFloor) {
  const Result r = full_suslov().solver("newton", {.tolerance = 1e-17}).until(10).run();
  EXPECT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_LE(r.stats.residual_max, 64 * 2.3e-16);
  EXPECT_LE(r.stats.iterations_max, 10);
}

TEST(NewtonInARun, ALooseToleranceIsHonoured) {
  const Result r = full_suslov().solver("newton", {.tolerance = 1e-3}).step(0.1).until(10).run();
  EXPECT_TRUE(r.status.ok);
  EXPECT_LE(r.stats.residual_max, 1e-3);
}

/// A step of some radians leaves the domain of the retraction: the run stops there with the reason,
/// and the state is the last good one.
TEST(NewtonInARun, AStepOutsideTheDomainKeepsTheGoodSteps) {
  const Result r = full_suslov().retraction("exp").step(4).until(40).run();
  ASSERT_FALSE(r.status.ok);
  EXPECT_FALSE(r.status.reason.empty());
  EXPECT_EQ(r.status.step, r.steps + 1);
  EXPECT_EQ(r.status.time, static_cast<double>(r.steps) * 4);
  EXPECT_EQ(r.trajectory.rows(), static_cast<size_t>(r.steps) + 1);
  for (const double x : r.last.coordinates) EXPECT_TRUE(std::isfinite(x));
  for (const double x : r.last.velocity) EXPECT_TRUE(std::isfinite(x));
}

/// The sleigh turns faster and faster until it is reversed: with h = 1.2 some good steps come
/// first.
TEST(NewtonInARun, FailsInTheMiddle) {
  Simulation simulation = simulate("chaplygin_sleigh")
                              .start({.velocity = {0.02, -3, 0}})
                              .scheme("lift")
                              .retraction("exp")
                              .step(0.5)
                              .until(50);
  const Result r = simulation.run();
  ASSERT_FALSE(r.status.ok);
  EXPECT_GE(r.steps, 1);
  EXPECT_EQ(r.last.step, r.steps);
  // Stepped by hand it fails in the same step, and stays at the last good state.
  hamel::Run run = simulation.build();
  EXPECT_TRUE(run.step(r.steps).ok);
  const Snapshot good = run.state();
  EXPECT_FALSE(run.step().ok);
  EXPECT_EQ(run.state().coordinates, good.coordinates);
  EXPECT_EQ(run.state().step, good.step);
}

}  // namespace
