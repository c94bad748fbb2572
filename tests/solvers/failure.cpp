// A step that fails: stop, retry with another solver, halve; and the record of it.
#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/systems/simulate_typed.hpp>

namespace {

using namespace hamel;
using testing::HasSubstr;

/// A Newton that refuses its calls number first..last, so that the steps to be rescued are known.
class Moody final : public Solver {
 public:
  Moody(int first, int last) : first_(first), last_(last) {}
  SolveReport solve(const Equation& equation, std::span<double> x, double tolerance) override {
    ++calls_;
    if (calls_ >= first_ && calls_ <= last_) return {Reason::stagnated, 0.5, 7, 9};
    return inner_->solve(equation, x, tolerance);
  }

 private:
  std::shared_ptr<Solver> inner_ = registry().solver("hybrid")->make();
  int first_, last_, calls_ = 0;
};

Registry with_moody(int first, int last) {
  Registry mine = registry();
  mine.add(SolverInfo{"moody", "", "", [=] { return std::make_shared<Moody>(first, last); }});
  return mine;
}

Result run(const Registry& all, const std::string& policy, const std::string& compose = "none") {
  return Simulation(all, "chaplygin_sleigh")
      .solver("moody")
      .on_failure(policy)
      .compose(compose)
      .step(0.05)
      .until(1)
      .run();
}

TEST(OnFailure, StopKeepsTheGoodSteps) {
  const Result r = run(with_moody(5, 5), "stop");
  EXPECT_FALSE(r.status.ok);
  EXPECT_EQ(r.status.step, 5);
  EXPECT_EQ(r.steps, 4);
  EXPECT_EQ(r.status.reason, to_string(Reason::stagnated));
  EXPECT_EQ(r.stats.fallbacks, 0);
}

TEST(OnFailure, RetrySolvesTheSameStep) {
  const Result good = run(with_moody(0, 0), "stop"), r = run(with_moody(5, 7), "retry:newton");
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_EQ(r.steps, 20);
  EXPECT_EQ(r.stats.fallbacks, 3);
  ASSERT_EQ(r.stats.first_fallbacks.size(), 3u);
  EXPECT_EQ(r.stats.first_fallbacks[0].step, 5);
  EXPECT_DOUBLE_EQ(r.stats.first_fallbacks[0].time, 0.2);
  EXPECT_EQ(r.stats.first_fallbacks[0].action, "solved by newton");
  EXPECT_GE(r.stats.iterations, 21);  // what failed is counted too
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(r.last.coordinates[i], good.last.coordinates[i], 1e-12);
  }
  EXPECT_THAT(r.report(),
              HasSubstr("3 of 20 steps; the first, step 5 (t = 0.2): solved by newton"));
  EXPECT_THAT(
      r.record(-1),
      HasSubstr(
          R"("fallbacks":{"count":3,"first":[{"step":5,"time":0.2,"action":"solved by newton"})"));
}

TEST(OnFailure, HalveKeepsTheTimeGrid) {
  const Result good = run(with_moody(0, 0), "stop"), r = run(with_moody(5, 6), "halve");
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_EQ(r.steps, 20);
  EXPECT_DOUBLE_EQ(r.last.time, good.last.time);
  EXPECT_EQ(r.trajectory.column("t"), good.trajectory.column("t"));
  // Call 5 fails, the first half (call 6) too: its quarters and the second half are three parts.
  ASSERT_EQ(r.stats.first_fallbacks.size(), 1u);
  EXPECT_EQ(r.stats.first_fallbacks[0].action, "taken in 3 parts");
  // One step in three parts is another step, and no worse.
  EXPECT_LT(r.exact_error_final, 1.01 * good.exact_error_final);
  EXPECT_NE(r.exact_error_final, good.exact_error_final);
}

/// The halves are steps of half the size: one step of 0.05 that is always halved is two of 0.025.
TEST(OnFailure, AHalvedStepIsTwoStepsOfHalfTheSize) {
  const Registry mine = with_moody(1, 1);
  const Result halved = Simulation(mine, "chaplygin_sleigh")
                            .solver("moody")
                            .on_failure("halve")
                            .step(0.05)
                            .until(0.05)
                            .run();
  const Result two = simulate("chaplygin_sleigh").solver("hybrid").step(0.025).until(0.05).run();
  ASSERT_TRUE(halved.status.ok);
  EXPECT_EQ(halved.steps, 1);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(halved.last.coordinates[i], two.last.coordinates[i], 1e-14);
    EXPECT_NEAR(halved.last.velocity[i], two.last.velocity[i], 1e-13);
  }
  EXPECT_LE(halved.constraint_max, 1e-13);
}

/// A solver that refuses every step of more than a part in 2^depth of the first: it follows the
/// tree of halvings, whose leaves, in order, have the numbers leaf_.
class Halved final : public Solver {
 public:
  Halved(int depth, long* calls) : depth_(depth), calls_(calls) {}
  SolveReport solve(const Equation& equation, std::span<double> x, double tolerance) override {
    ++*calls_;
    if (level_++ < depth_) return {Reason::stagnated, 0.5, 7, 9};
    level_ = depth_ - std::countr_zero(++leaf_);
    return inner_->solve(equation, x, tolerance);
  }

 private:
  std::shared_ptr<Solver> inner_ = registry().solver("hybrid")->make();
  int depth_, level_ = 0;
  unsigned leaf_ = 0;
  long* calls_;
};

/// A step is halved ten times and not once more: into 1,024 parts at most, in 2,047 solves.
TEST(OnFailure, HalvingHasABound) {
  long calls = 0;
  const auto in_parts_of = [&](int depth) {
    calls = 0;
    Registry mine = registry();
    mine.add(SolverInfo{"halved", "", "",
                        [&, depth] { return std::make_shared<Halved>(depth, &calls); }});
    return Simulation(mine, "chaplygin_sleigh")
        .solver("halved")
        .on_failure("halve")
        .step(0.05)
        .until(0.05)
        .run();
  };
  const Result most = in_parts_of(10);
  ASSERT_TRUE(most.status.ok) << most.status.reason;
  EXPECT_EQ(calls, 2047);
  ASSERT_EQ(most.stats.first_fallbacks.size(), 1u);
  EXPECT_EQ(most.stats.first_fallbacks[0].action, "taken in 1024 parts");
  EXPECT_EQ(most.last.time, 0.05);
  const Result more = in_parts_of(11);
  EXPECT_FALSE(more.status.ok);
  EXPECT_THAT(more.status.reason, HasSubstr("in halved steps too"));
  EXPECT_EQ(calls, 11);  // the step, and the first part of each of ten halvings
  EXPECT_EQ(more.steps, 0);
}

/// A composed step that fails in its third substep is taken back whole before it is rescued.
TEST(OnFailure, ComposedStepsAreRescuedWhole) {
  const Result good = run(with_moody(0, 0), "stop", "suzuki4");
  for (const char* policy : {"retry:newton", "halve"}) {
    const Result r = run(with_moody(13, 13), policy, "suzuki4");
    ASSERT_TRUE(r.status.ok) << policy;
    ASSERT_EQ(r.stats.first_fallbacks.size(), 1u);
    EXPECT_EQ(r.stats.first_fallbacks[0].step, 3) << policy;
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(r.last.coordinates[i], good.last.coordinates[i], 1e-6) << policy;
    }
  }
}

TEST(OnFailure, WhereNothingHelpsTheGoodStepsStay) {
  for (const char* policy : {"retry:hopeless", "halve"}) {
    Registry mine = with_moody(5, 1 << 20);
    mine.add_solver("hopeless", "", [](const Equation&, std::span<double>, double) {});
    const Result r = run(mine, policy), stopped = run(mine, "stop");
    EXPECT_FALSE(r.status.ok);
    EXPECT_EQ(r.status.step, 5) << policy;
    EXPECT_EQ(r.last.coordinates, stopped.last.coordinates) << policy;
    EXPECT_EQ(r.last.velocity, stopped.last.velocity) << policy;
    EXPECT_EQ(r.stats.fallbacks, 0);
    EXPECT_THAT(r.status.reason, HasSubstr(policy == std::string("halve") ? "in halved steps too"
                                                                          : "hopeless failed too"));
  }
}

/// A step of four seconds leaves the domain of exp; halved it does not.
TEST(OnFailure, HalvingRescuesStepsThatLeaveTheDomain) {
  const auto suslov = [](const char* policy) {
    return simulate("suslov")
        .set("inertia", {2, .3, .5, 3, .4, 4})
        .start({.velocity = {1, 0.5, 0}})
        .retraction("exp")
        .step(4)
        .until(40)
        .on_failure(policy)
        .run();
  };
  EXPECT_FALSE(suslov("stop").status.ok);
  const Result r = suslov("halve");
  EXPECT_TRUE(r.status.ok) << r.status.reason;
  EXPECT_EQ(r.steps, 10);
  EXPECT_GE(r.stats.fallbacks, 1);
  EXPECT_LE(r.constraint_max, 1e-12);
}

TEST(OnFailure, BadPoliciesAreRefused) {
  const auto refused = [](const std::string& policy) {
    const auto mistakes = simulate("suslov").on_failure(policy).mistakes();
    return mistakes.empty() ? "accepted" : mistakes.front();
  };
  EXPECT_EQ(refused("halve"), "accepted");
  EXPECT_EQ(refused("retry:hybrid"), "accepted");
  EXPECT_THAT(refused("hlave"), HasSubstr("did you mean 'halve'?"));
  EXPECT_THAT(refused(""), HasSubstr("expected one of stop, halve, retry:<solver>"));
  EXPECT_THAT(refused("retry:newtn"), HasSubstr("on_failure: unknown solver 'newtn'"));
  EXPECT_THAT(refused("retry:newton"), HasSubstr("expected another solver than 'newton'"));
}

/// A solver of a package that was not there when hamel was built: absent, and the package is named.
TEST(AbsentSolver, NamesItsPackage) {
  Registry mine = registry();
  SolverInfo info{"kinsol", "Newton-Krylov", "SUNDIALS", nullptr};
  info.package = "libsundials-dev";
  mine.add_absent(info);
  EXPECT_EQ(mine.solver("kinsol"), nullptr);
  EXPECT_THAT(mine.solvers(), testing::Not(testing::Contains("kinsol")));
  EXPECT_THAT(mine.absent_solvers(), testing::Contains("kinsol"));
  const std::string message =
      "solver 'kinsol' needs the package libsundials-dev: install it and build again";
  EXPECT_THAT(Simulation(mine, "suslov").solver("kinsol").mistakes(),
              testing::ElementsAre(message));
  EXPECT_THAT(Simulation(mine, "suslov").on_failure("retry:kinsol").mistakes(),
              testing::ElementsAre("on_failure: " + message));
  // A program's own solver of that name takes its place.
  mine.add_solver("kinsol", "mine", [](const Equation&, std::span<double>, double) {});
  EXPECT_THAT(mine.absent_solvers(), testing::Not(testing::Contains("kinsol")));
  EXPECT_TRUE(Simulation(mine, "suslov").solver("kinsol").mistakes().empty());
}

/// Every name of the library is either there or absent with its package.
TEST(AbsentSolver, NoneIsForgotten) {
  for (const char* name :
       {"ceres", "ceres_tiny", "nlopt", "nlopt:slsqp", "nlopt:lbfgs", "nlopt:var2", "nlopt:tnewton",
        "nlopt:mma", "nlopt:ccsaq", "nlopt:neldermead", "nlopt:sbplx"}) {
    const bool there = registry().solver(name) != nullptr;
    EXPECT_NE(there, registry().absent_solver(name) != nullptr) << name;
    const SolverInfo& info = there ? *registry().solver(name) : *registry().absent_solver(name);
    EXPECT_THAT(info.package, testing::StartsWith("lib")) << name;
  }
}

/// A principal root is not refused where the equation is ill-conditioned: masses of 1 and 1e6, or
/// steps so small that the row of a height hardly sees the velocity.
TEST(Failure, ThePrincipalRootIsTakenWhereTheEquationIsIllConditioned) {
  const Result trailer =
      simulate("n_trailer").set("trailer_mass", 1e6).set("mass", 1).step(1e-4).until(0.01).run();
  EXPECT_TRUE(trailer.status.ok) << trailer.status.reason;
  const Result rattleback =
      simulate("rattleback").compose("kahan_li6").step(1e-6).until(1e-4).run();
  EXPECT_TRUE(rattleback.status.ok) << rattleback.status.reason;
}

/// From rest nothing of a small step is as large as the round-off of a length.
TEST(Failure, ThePrincipalRootIsTakenFromRest) {
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    const Result r =
        simulate("rattleback").start({.velocity = {0, 0, 0, 0, 0, 0}}).step(h).until(20 * h).run();
    EXPECT_TRUE(r.status.ok) << h << ": " << r.status.reason;
  }
}

}  // namespace
