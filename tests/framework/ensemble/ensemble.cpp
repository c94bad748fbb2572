// Ensembles: a member is its index, statistics are those of its closed form, failures are listed.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/framework/ensemble/random.hpp>
#include <hamel/hamel.hpp>

#include "../run/refusal.hpp"
#include "ensembles.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;
using testing::ElementsAre;
using testing::HasSubstr;
using Law = Variation::Law;

/// kat_vectors of Random123 (Salmon and others 2011).
TEST(Philox, KnownAnswers) {
  using ensemble::philox;
  EXPECT_THAT(philox({0, 0, 0, 0}, {0, 0}),
              ElementsAre(0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8));
  constexpr uint32_t all = 0xffffffff;
  EXPECT_THAT(philox({all, all, all, all}, {all, all}),
              ElementsAre(0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd));
  EXPECT_THAT(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              ElementsAre(0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1));
}

/// A point on a spring, x'' = -x: linear in its start.
EnsembleConfig spring() {
  EnsembleConfig config;
  config.run.system = "spring.toml";
  config.data = "group = 'r1'\ninertia = [1]\npotential = '0.5*x1^2'\nvelocity = [0]\n";
  config.run.until = 2;
  config.run.scheme = "dop853";
  config.run.rtol = 1e-10;
  config.members = 5000;
  config.seed = 11;
  config.vary = {{"start.x1", Law::normal, {1, 0.5}}, {"start.xi1", Law::normal, {0, 0.3}}};
  config.keep = {{"", "end.x1"}, {"sum", "end.x1 + at(1).x1"}};
  return config;
}

/// Restarted, and built anew for each member because of a parameter.
TEST(Ensemble, AMemberIsItsIndex) {
  EnsembleConfig both = body();
  both.vary.push_back({"inertia3", Law::uniform, {0.3, 0.6}});
  EnsembleConfig driven;  // its inputs are set, and the run restarted
  driven.run.system = "segway";
  driven.run.step = 0.01;
  driven.run.until = 0.3;
  driven.members = 100;
  driven.vary = {{"left_torque", Law::uniform, {-2, 2}}, {"start.v1", Law::uniform, {-1, 1}}};
  driven.keep = {{"end.omega1", "end.v1"}, {"", "at(0.123).pitch"}};
  EnsembleConfig pushed = driven;  // inputs alone
  pushed.vary.pop_back();
  for (const EnsembleConfig& config : {body(), both, driven, pushed}) {
    const Ensemble whole(registry(), config);
    const EnsembleResult one = Ensemble(whole).threads(1).run();
    expect_same(one, Ensemble(whole).threads(2).run());
    for (const long k : {0L, 17L, 99L}) {
      const Member alone = whole.member(k);
      for (const auto& [name, value] : alone.kept)
        EXPECT_EQ(value, column(one, name)[static_cast<size_t>(k)]) << name;
      for (const auto& [name, value] : alone.varied)
        EXPECT_EQ(value, column(one, name)[static_cast<size_t>(k)]) << name;
    }
    EnsembleConfig longer = config;
    longer.members = 150;
    const EnsembleResult more = Ensemble(registry(), longer).run();
    EXPECT_EQ(column(more, "end.omega1")[99], column(one, "end.omega1")[99]);
  }
}

/// The member as a run: the same motion, the projection of its start included.
TEST(Ensemble, AMemberIsARun) {
  EnsembleConfig config;
  config.run.system = "rattleback";
  config.run.until = 5;
  config.grid = true;
  config.vary = {{"start.omega3", Law::values, {-1.5, -1}}, {"skew", Law::values, {0.3, 0.4, 0.5}}};
  config.keep = {{"", "end.omega3"},
                 {"", "event.reversed.count"},
                 {"omega3", "start.omega3"},
                 {"", "max.energy_error"}};
  const Ensemble whole(registry(), config);
  EXPECT_EQ(whole.members(), 6);
  const EnsembleResult result = Ensemble(whole).run();
  EXPECT_THAT(column(result, "skew"), ElementsAre(0.3, 0.4, 0.5, 0.3, 0.4, 0.5));
  for (const long k : {1L, 5L}) {
    Simulation run = simulate("rattleback").config(whole.member(k).config).events({"reversed"});
    const Result alone = run.run();
    const auto at = static_cast<size_t>(k);
    EXPECT_NEAR(alone.last.velocity[2], column(result, "end.omega3")[at], 1e-9);
    EXPECT_EQ(static_cast<double>(alone.events.size()), column(result, "event.reversed.count")[at]);
    EXPECT_NEAR(column(result, "omega3")[at], column(result, "omega3")[at < 3 ? 0 : 3], 1e-12);
    EXPECT_NEAR(alone.energy_error_max, column(result, "max.energy_error")[at], 1e-10);
  }
  EXPECT_NEAR(column(result, "omega3")[0], -1.5, 1e-12);  // given, and kept by the projection
}

/// Against the energy at its own start, also where nothing else of the start is kept.
TEST(Ensemble, AnEnergyErrorAloneIsThatOfTheMember) {
  EnsembleConfig config = body();
  config.members = 1;
  config.keep = {{"", "end.energy_error"}, {"both", "(end.energy - start.energy)/start.energy"}};
  EnsembleConfig alone = config;
  alone.keep.pop_back();
  const EnsembleResult with = Ensemble(registry(), config).threads(1).run(),
                       without = Ensemble(registry(), alone).threads(1).run();
  EXPECT_EQ(column(without, "end.energy_error")[0], column(with, "end.energy_error")[0]);
  EXPECT_NEAR(column(with, "end.energy_error")[0], column(with, "both")[0], 1e-15);
}

/// x(t) = x0 cos t + v0 sin t: mean and deviation of normal starts.
TEST(Ensemble, ALinearCaseAgreesWithItsClosedForm) {
  EnsembleConfig config = spring();
  config.statistics_at = {1};
  config.covariance = true;
  const EnsembleResult result = Ensemble(registry(), config).run();
  const double n = 5000;
  const auto agrees = [&](const Moments& m, double a, double b, const std::string& what) {
    const double deviation = std::hypot(0.5 * a, 0.3 * b);
    EXPECT_NEAR(m.mean, a, 4 * deviation / std::sqrt(n)) << what;
    EXPECT_NEAR(m.deviation(), deviation, 4 * deviation / std::sqrt(2 * n)) << what;
  };
  agrees(result.moments.at("end.x1"), std::cos(2), std::sin(2), "end");
  agrees(result.moments.at("sum"), std::cos(2) + std::cos(1), std::sin(2) + std::sin(1), "sum");
  ASSERT_EQ(result.statistics.size(), 1u);
  ASSERT_EQ(result.statistics[0].quantities.size(), 2u);  // x1 and xi1
  agrees(result.statistics[0].quantities[0].second, std::cos(1), std::sin(1), "x1 at 1");
  agrees(result.statistics[0].quantities[1].second, -std::sin(1), std::cos(1), "xi1 at 1");
  const double end = result.moments.at("end.x1").deviation();
  EXPECT_NEAR(result.covariance.matrix[0][0], end * end, 1e-12);
}

/// A quantity that a third of the members lack takes no member from the pairs of the others.
TEST(Ensemble, CovarianceIsOverTheMembersThatHaveBothValues) {
  EnsembleConfig config = spring();
  config.covariance = true;
  config.keep.push_back({"late", "end.x1 > 0 ? end.x1 : 0/0"});
  const EnsembleResult result = Ensemble(registry(), config).run();
  const size_t n = result.kept.size();
  for (size_t i = 0; i < n; ++i) {
    const Moments& moments = result.moments.at(result.kept[i]);
    EXPECT_EQ(result.covariance.members[i][i], moments.count) << result.kept[i];
    EXPECT_NEAR(result.covariance.matrix[i][i], std::pow(moments.deviation(), 2), 1e-12);
  }
  const std::vector<double> x = column(result, "end.x1"), late = column(result, "late");
  double count = 0, mean_x = 0, mean_late = 0, sum = 0;
  for (size_t k = 0; k < x.size(); ++k) {
    if (std::isnan(late[k])) continue;
    ++count;
    mean_x += x[k];
    mean_late += late[k];
  }
  ASSERT_LT(count, 0.9 * static_cast<double>(x.size()));
  for (size_t k = 0; k < x.size(); ++k)
    if (!std::isnan(late[k])) sum += (x[k] - mean_x / count) * (late[k] - mean_late / count);
  EXPECT_EQ(static_cast<double>(result.covariance.members[n - 1][0]), count);
  EXPECT_NEAR(result.covariance.matrix[n - 1][0], sum / (count - 1), 1e-12);
}

TEST(Ensemble, HistogramsQuantilesAndClassesCount) {
  EnsembleConfig config = spring();
  config.histograms["end.x1"] = {.bins = 7};
  config.histograms["sum"] = {.bins = 4, .from = -1, .until = 1};
  config.quantiles = {0, 0.5, 1};
  config.classes = {"end.x1 > 0 ? 1 : 0", {"left", "right"}};
  const EnsembleResult result = Ensemble(registry(), config).run();
  const std::vector<double> end = column(result, "end.x1"), sum = column(result, "sum");
  const Moments& m = result.moments.at("end.x1");
  std::vector<long> bins(7), given(4);
  for (const double x : end) {
    int bin = 0;
    while (bin < 6 && x >= m.least + (m.most - m.least) * (bin + 1) / 7) ++bin;
    ++bins[static_cast<size_t>(bin)];
  }
  EXPECT_EQ(result.histograms.at("end.x1").counts, bins);
  long below = 0, above = 0;
  for (const double x : sum) {
    if (x < -1) ++below;
    else if (x > 1) ++above;
    else ++given[static_cast<size_t>(std::min(3.0, std::floor((x + 1) * 2)))];
  }
  EXPECT_EQ(result.histograms.at("sum").counts, given);
  EXPECT_EQ(result.histograms.at("sum").below, below);
  EXPECT_EQ(result.histograms.at("sum").above, above);
  EXPECT_EQ(result.quantiles.at("end.x1")[0], m.least);
  EXPECT_EQ(result.quantiles.at("end.x1")[2], m.most);
  const auto right = std::ranges::count_if(end, [](double x) { return x > 0; });
  EXPECT_THAT(result.class_counts, ElementsAre(5000 - right, right));
}

/// Rotations: each entry has mean 0 and variance 1/3. Energy: as requested, for any start.
TEST(Ensemble, StartsOnTheGroupAndOnAnEnergySurface) {
  EnsembleConfig config = body();
  config.members = 3000;
  config.vary = {{"start.configuration", Law::haar, {}}, {"start.velocity", Law::energy, {2.5}}};
  config.keep = {{"", "start.R11"}, {"", "start.R23"}, {"", "start.energy"}, {"", "start.omega1"}};
  const EnsembleResult result = Ensemble(registry(), config).run();
  for (const char* entry : {"start.R11", "start.R23"}) {
    const Moments& m = result.moments.at(entry);
    EXPECT_NEAR(m.mean, 0, 4 * std::sqrt(1.0 / 3 / 3000)) << entry;
    EXPECT_NEAR(m.squares / 3000, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / 3000)) << entry;
  }
  EXPECT_NEAR(result.moments.at("start.energy").least, 2.5, 1e-12);
  EXPECT_NEAR(result.moments.at("start.energy").most, 2.5, 1e-12);
  EXPECT_NEAR(result.moments.at("start.omega1").mean, 0, 0.1);

  config.vary = {{"start.configuration", Law::tau_normal, {0.01}}};
  config.run.retraction = "exp";
  config.keep = {{"angle", "start.R32 - start.R23"}};  // 2 sin of a small angle about x
  const Moments angle = Ensemble(registry(), config).run().moments.at("angle");
  EXPECT_NEAR(angle.mean, 0, 4 * 0.02 / std::sqrt(3000));
  EXPECT_NEAR(angle.deviation(), 0.02, 4 * 0.02 / std::sqrt(2 * 3000));
}

/// A member without a value is in no mean, and has a reason where that is a failure.
TEST(Ensemble, FailedMembersAreCountedAndListed) {
  EnsembleConfig config = body();
  config.members = 40;
  config.keep = {{"", "end.omega1"}, {"bad", "1 / (member - 7)"}};
  const EnsembleResult result = Ensemble(registry(), config).threads(2).run();
  ASSERT_EQ(result.failures.size(), 1u);
  EXPECT_EQ(result.failures[0].member, 7);
  EXPECT_EQ(result.failures[0].reason, "'bad' is infinite");
  EXPECT_THAT(result.record(), HasSubstr("\"start.omega1\""));  // its values
  EXPECT_EQ(result.moments.at("end.omega1").count, 39);
  EXPECT_TRUE(std::isnan(column(result, "end.omega1")[7]));
  EXPECT_THAT(result.table.column("failure").meaning, HasSubstr("1: 'bad' is infinite"));

  config.keep = {{"", "end.omega1"}};
  config.vary[0] = {"start.omega1", Law::values, {1, 1e4}};  // a step of hundreds of radians
  config.members = 0;
  const EnsembleResult steps = Ensemble(registry(), config).run();
  ASSERT_EQ(steps.failures.size(), 1u);
  EXPECT_EQ(steps.failures[0].member, 1);

  EnsembleConfig events = body();
  events.events["turned"] = "R11 < 0.95";
  events.keep = {{"", "event.turned.time"}, {"", "event.turned.count"}};
  const EnsembleResult met = Ensemble(registry(), events).run();
  EXPECT_TRUE(met.failures.empty());
  EXPECT_EQ(static_cast<double>(met.moments.at("event.turned.time").count),
            met.moments.at("event.turned.count").mean * 100);
  EXPECT_LT(met.moments.at("event.turned.time").count, 100);
}

/// The same as a loop by hand; the next member begins with inputs of its own.
TEST(Ensemble, FeedbackActsOnceAPeriod) {
  EnsembleConfig config;
  config.run.system = "segway";
  config.run.scheme = "lift";
  config.run.step = 0.005;
  config.run.until = 1;
  config.run.speed = 0;
  config.vary = {{"start.pitch'", Law::values, {0.3, 0.1, -0.2}}};
  config.feedback = {0.01,
                     {{"right_torque", "(217*pitch + 41*pitch' + 7*v1) / 2"},
                      {"left_torque", "(217*pitch + 41*pitch' + 7*v1) / 2"}}};
  config.keep = {{"", "end.pitch"}, {"rate", "start.pitch'"}};
  const Ensemble whole(registry(), config);
  const EnsembleResult result = Ensemble(whole).threads(1).run();
  for (size_t k = 0; k < 3; ++k) {
    hamel::Run run = simulate("segway").config(whole.member(static_cast<long>(k)).config).build();
    for (int i = 0; i < 100; ++i) {
      const Snapshot& now = run.state();
      const double torque =
          (217 * now.coordinates[5] + 41 * now.velocity[5] + 7 * now.velocity[1]) / 2;
      run.input("right_torque", torque);
      run.input("left_torque", torque);
      ASSERT_TRUE(run.step(2));
    }
    EXPECT_NEAR(run.state().coordinates[5], column(result, "end.pitch")[k], 1e-12);
    EXPECT_NEAR(column(result, "rate")[k], config.vary[0].numbers[k], 1e-12);
  }
  config.feedback.period = 0.007;
  EXPECT_THAT(refusal([&] { Ensemble(registry(), config); }),
              HasSubstr("the period 0.007 is not a multiple of the step, 0.005"));
  config.feedback = {0.01, {{"rihgt_torque", "1"}}};
  EXPECT_THAT(refusal([&] { Ensemble(registry(), config); }),
              HasSubstr("did you mean 'right_torque'?"));
}

/// Times that are no nodes, rows of chosen steps, an event that ends the run.
TEST(Ensemble, ValuesAtTimesAreThoseOfTheMotion) {
  EnsembleConfig config = spring();
  config.members = 20;
  config.keep = {{"a", "at(0.777).x1 - start.x1*cos(0.777) - start.xi1*sin(0.777)"},
                 {"b", "at(0).x1 - start.x1"},
                 {"m", "max.x1"},
                 {"c", "at(2).x1 - end.x1"}};
  for (const char* scheme : {"dop853", "lift"}) {
    config.run.scheme = scheme;
    if (config.run.scheme == "lift") {
      config.run.rtol.reset();
      config.run.step = 0.01;
    }
    const EnsembleResult result = Ensemble(registry(), config).run();
    ASSERT_TRUE(result.failures.empty()) << result.failures[0].reason;
    const double tolerance = config.run.scheme == "lift" ? 1e-4 : 1e-9;
    EXPECT_LT(std::abs(result.moments.at("a").most), tolerance);
    EXPECT_EQ(result.moments.at("b").most, 0);
    EXPECT_NEAR(result.moments.at("c").most, 0, 1e-12);
  }
  config.run.stop_at = {"t=1"};
  config.keep = {{"late", "at(1.5).x1"}, {"end", "end.t"}};
  const EnsembleResult stopped = Ensemble(registry(), config).run();
  EXPECT_EQ(stopped.moments.at("late").count, 0);
  EXPECT_NEAR(stopped.moments.at("end").most, 1, 1e-9);
}

}  // namespace
