// Studies from C++: combinations, references of the cells, orders, stopping and continuing.
#include <atomic>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/framework/study/parts.hpp>

#include "studies.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// With one step size every state is compared: the error is that of a run with every step recorded.
TEST(Study, MeasuresWhatARunMeasures) {
  StudyConfig config = small();
  config.axes["step"] = {0.05};
  config.axes["scheme"] = {"boxed"};
  const StudyResult study = run(config);
  const Result one = simulate("suslov")
                         .set("inertia", kFull.parameters.at("inertia"))
                         .start(kFull.start)
                         .scheme("boxed")
                         .step(0.05)
                         .until(2)
                         .run();
  ASSERT_EQ(study.metrics.size(), 1u);
  const StudyMetrics& m = study.metrics.front();
  EXPECT_NEAR(m.error, one.exact_error_max, 1e-13);  // times k T/K and k h: an ulp apart
  EXPECT_NEAR(m.error_final, one.exact_error_final, 1e-13);
  EXPECT_NEAR(m.velocity_error, one.exact_velocity_error_max, 1e-13);
  EXPECT_EQ(m.energy_error, one.energy_error_max);
  EXPECT_EQ(m.constraint, one.constraint_max);
  EXPECT_EQ(m.group_defect, one.group_defect_max);
  EXPECT_EQ(m.iterations, one.stats.iterations);
  EXPECT_EQ(m.evaluations, one.stats.evaluations);
  EXPECT_EQ(m.residual, one.stats.residual_max);
  EXPECT_EQ(m.steps, 40);
  EXPECT_EQ(m.nanoseconds.size(), 1u);
  EXPECT_GT(m.nanoseconds_median(), 0);
}

/// The claims of the schemes on a system without special symmetry; within 0.15 on these steps.
// Also where an input jumps within a step: its node is one of the quadrature of the work.
TEST(Study, BalancesTheWorkOfAJumpAsARunDoes) {
  const InputTable push = {{0, 0.37, 1}, {1, -1, -1}, true};
  StudySystem drive{.label = "drive", .name = "differential_drive"};
  drive.inputs = {{"left_torque", push}, {"right_torque", push}};
  StudyConfig config;
  config.until = 1;
  config.repeats = 1;
  config.systems = {drive};
  config.axes = {{"scheme", {"lift", "rkmk4"}}, {"step", {0.1, 0.05}}};
  const StudyResult result = Study(registry(), config).run();
  ASSERT_EQ(result.cells.size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    const Config cell = result.cells[i].config();
    const Result run = simulate("differential_drive")
                           .scheme(cell.scheme)
                           .step(*cell.step)
                           .until(1)
                           .input("left_torque", push)
                           .input("right_torque", push)
                           .run();
    EXPECT_GT(run.energy_balance_error_max, 0);
    EXPECT_NEAR(result.metrics[i].energy_error / run.energy_balance_error_max, 1, 1e-6) << i;
  }
}

TEST(Study, MeasuresOrders) {
  StudyConfig config = small();
  config.axes["scheme"] = {"lift", "balance", "boxed", "unadapted"};
  config.axes["s"] = {0, 0.5};
  for (const StudyResult study = run(config); const StudyCell& cell : study.cells) {
    if (!cell.runs()) continue;
    const StudyMetrics& m = study.metrics[static_cast<size_t>(&cell - &study.cells.front())];
    const std::string scheme = cell.config().scheme;
    const int order = scheme == "unadapted"                            ? 0
                      : scheme == "lift" || cell.axes.at("s") == "0.5" ? 2
                                                                       : 1;
    EXPECT_EQ(cell.claimed_order, order) << scheme << cell.axes.at("s");
    if (order > 0) {
      EXPECT_NEAR(m.order, order, 0.15) << scheme << " s = " << cell.axes.at("s");
    }
    EXPECT_EQ(m.order_of, 3);
  }
}

/// Order 6 and 8 reach round-off within these steps: points on the floor must not enter the slope.
TEST(Study, OrdersAreFittedAboveTheFloor) {
  StudyConfig config = small();
  config.axes["compose"] = {"kahan_li6", "suzuki_umeno8"};
  config.axes["step"] = {0.2, 0.1, 0.05, 0.025, 0.0125, 0.00625};
  const StudyResult study = run(config);
  for (const size_t i : {size_t{0}, size_t{6}}) {
    const StudyMetrics& m = study.metrics[i];
    EXPECT_GT(m.order, study.cells[i].claimed_order - 0.5);
    EXPECT_GE(m.order_points, 2);
    EXPECT_LT(m.order_points, m.order_of);
  }
  EXPECT_EQ(study.cells[0].claimed_order, 6);
  EXPECT_EQ(study.cells[6].claimed_order, 8);
}

/// A converged reference measures the errors that the exact motion does, to its bound.
TEST(Study, ConvergedReferenceAgreesWithTheExact) {
  const Registry all = with_forgetful();
  StudyConfig config = small();
  config.axes["scheme"] = {"lift", "boxed"};
  config.systems.push_back({.label = "forgetful", .name = "forgetful", .start = kFull.start});
  const StudyResult study = Study(all, config).run();
  EXPECT_EQ(study.references[0].kind, "exact");
  EXPECT_THAT(study.references[1].kind, HasSubstr("converged: lift, s = 0.5, exp, kahan_li6"));
  const double bound = study.references[1].bound;
  EXPECT_GT(bound, 0);
  EXPECT_LT(bound, 1e-12);
  const size_t half = study.cells.size() / 2;
  for (size_t i = 0; i < half;
       ++i) {  // the quadrature behind the exact motion has its round-off too
    EXPECT_NEAR(study.metrics[i].error, study.metrics[half + i].error, 1e-12 + bound);
    EXPECT_GT(study.metrics[i].error, 1e-5);
  }
}

TEST(Study, ZippedListsRunTogether) {
  StudyConfig config = small();
  config.zipped = true;
  config.axes["scheme"] = {"lift", "boxed", "balance"};
  std::vector<std::string> names;
  const Study study(registry(), config);
  for (const StudyCell& cell : study.cells())
    names.push_back(cell.config().scheme + " " + cell.axes.at("step"));
  EXPECT_THAT(names, ElementsAre("lift 0.1", "boxed 0.05", "balance 0.025"));
  config.axes["scheme"].pop_back();
  EXPECT_THAT(mistakes_of(config), ElementsAre(HasSubstr("scheme: 2 values, but step has 3")));
}

TEST(Study, SaysWhatIsWrong) {
  StudyConfig config = small();
  config.axes["scheme"] = {"lfit"};
  config.axes["step"] = {0.1, -1, 0.1};
  config.systems.push_back(kFull);
  config.until = 2;
  config.repeats = 0;
  const auto mistakes = mistakes_of(config);
  for (const char* piece : {"did you mean 'lift'", "step: got -1", "step: 0.1 is listed twice",
                            "two systems are called 'full inertia'", "repeats: got 0"}) {
    EXPECT_THAT(mistakes, Contains(HasSubstr(piece)));
  }
  config = small();
  config.exclude = {{{{"scheme", {"lift"}}}, "nothing is good enough"}};
  EXPECT_THAT(mistakes_of(config), ElementsAre("nothing is left to run"));
}

/// on_failure is an axis: steps beyond the domain of exp fail, or are rescued in parts.
TEST(Study, RescuesWhatFails) {
  StudyConfig config;
  config.until = 12;
  config.repeats = 1;
  config.systems = {
      {.label = "sleigh", .name = "chaplygin_sleigh", .start = {.velocity = {3, 1, 0}}}};
  config.axes["retraction"] = {"exp"};
  config.axes["step"] = {6};
  config.axes["on_failure"] = {"stop", "halve", "retry:newton"};
  const StudyResult study = run(config);
  EXPECT_FALSE(study.metrics[0].ok);
  EXPECT_TRUE(study.metrics[1].ok) << study.metrics[1].reason;
  EXPECT_GT(study.metrics[1].fallbacks, 0);
  EXPECT_EQ(study.cells[2].skipped, "impossible");
  config.axes["on_failure"] = {"hlave"};
  EXPECT_THAT(mistakes_of(config), ElementsAre(HasSubstr("did you mean 'halve'")));
}

/// At the same residual every solver gives the same trajectory, to 1e-10.
TEST(Study, SolversAgree) {
  StudyConfig config = small();
  config.axes["solver"] = {"newton", "hybrid"};
  for (const char* more : {"ceres", "ceres_tiny", "nlopt"})
    if (registry().solver(more) != nullptr) config.axes["solver"].push_back(more);
  config.axes["s"] = {0, 0.5};
  const StudyResult study = run(config);
  size_t compared = 0;
  for (const StudyMetrics& m : study.metrics) {
    EXPECT_TRUE(m.ok) << m.reason;
    EXPECT_LE(m.residual, 1e-13);
    if (std::isnan(m.solver_difference)) continue;
    ++compared;
    EXPECT_LE(m.solver_difference, 1e-10);
  }
  EXPECT_EQ(compared, (config.axes["solver"].size() - 1) * 2 * 3);
}

/// A stopped study returns its finished cells; continued in the same folder it equals one that was
/// not stopped.
TEST(Study, StopsAndGoesOn) {
  const TemporaryFolder folder;
  StudyConfig config = small();
  config.axes["retraction"] = {"cayley", "exp", "polar"};
  config.repeats = 3;
  std::atomic<bool> stop = false;
  Study study(registry(), config);
  const StudyResult part = study.threads(1)
                               .folder(folder.path())
                               .stop(&stop)
                               .progress([&](double fraction) { stop = fraction > 0.2; })
                               .run();
  EXPECT_FALSE(part.complete);
  stop = false;
  const StudyResult rest = study.progress({}).run();
  EXPECT_TRUE(rest.complete);
  EXPECT_GT(rest.resumed, 0u);
  const StudyResult whole = run(config);
  for (size_t i = 0; i < whole.metrics.size(); ++i) {
    EXPECT_EQ(rest.metrics[i].error, whole.metrics[i].error);
    EXPECT_EQ(rest.metrics[i].energy_slope, whole.metrics[i].energy_slope);
    EXPECT_EQ(rest.metrics[i].order, whole.metrics[i].order);
    EXPECT_EQ(rest.metrics[i].nanoseconds.size(), 3u);
  }
  const StudyConfig other = small();
  EXPECT_THROW(Study(registry(), other).folder(folder.path()).run(), ConfigError);
}

TEST(Study, SlopeIsThatOfALine) {
  EXPECT_DOUBLE_EQ(study::slope({0, 1, 2, 5}, {1, 3, 5, 11}), 2);
  EXPECT_TRUE(std::isnan(study::slope({1, 1}, {0, 1})));
  EXPECT_TRUE(std::isnan(study::slope({}, {})));
}

TEST(Table, QuotesWhatNeedsIt) {
  const Table table = {
      {{"a,b", "", "", std::vector<std::string>{"say \"x\"", "two\nlines", "plain"}},
       {"x", "s", "", std::vector<double>{0.1, kNotMeasured, 3}}}};
  EXPECT_EQ(table.csv(), "\"a,b\",x\n\"say \"\"x\"\"\",0.1\n\"two\nlines\",\nplain,3\n");
  EXPECT_THROW(table.column("y"), ConfigError);
}

/// Angles that are not wrapped are compared by what is left of full turns; other columns as
/// numbers.
TEST(Study, ComparesAnglesAsAngles) {
  const std::vector<bool> angles = study::angle_columns(*registry().group_or_product("se2*so2*r2"));
  EXPECT_THAT(angles, testing::ElementsAre(true, false, false, true, false, false));
  const std::vector<double> a = {0.1, 1, 2, 100, 7, 8};
  std::vector<double> b = a;
  b[0] += 2 * std::numbers::pi * 1000;
  b[3] -= 2 * std::numbers::pi * 3 + 0.25;
  EXPECT_NEAR(study::distance(angles, a, b), 0.25, 1e-11);
  b[1] += 2 * std::numbers::pi;
  EXPECT_GT(study::distance(angles, a, b), 6);
}

/// A study of times makes no reference and measures no error.
TEST(Study, OfTimesAlone) {
  StudyConfig config;
  config.until = 1;
  config.repeats = 1;
  config.reference = false;
  config.systems = {{"disk", "falling_disk"}};
  config.axes["step"] = {0.1};
  const StudyResult result = Study(registry(), config).threads(1).run();
  ASSERT_TRUE(result.complete);
  EXPECT_TRUE(result.references[0].coordinates.empty());
  EXPECT_THAT(result.references[0].kind, testing::HasSubstr("does not ask for errors"));
  EXPECT_TRUE(std::isnan(result.metrics[0].error));
  EXPECT_GT(result.metrics[0].nanoseconds[0], 0);
}

}  // namespace
