// What is kept of reactions, work, and the energy error where work is done: as in a run's rows.
// run have it.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/hamel.hpp>

#include "../run/refusal.hpp"
#include "ensembles.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;
using testing::HasSubstr;
using Law = Variation::Law;

/// keeps of `of` their ends and largest values, at(0.31), and the same of the run of each member.
void expect_as_in_rows(EnsembleConfig config, const std::vector<std::string>& of) {
  config.members = 3;
  config.keep.clear();
  for (const std::string& name : of)
    for (const char* place : {"end.", "max.", "min.", "at(0.31)."})
      config.keep.push_back({"", place + name});
  const Ensemble ensemble(registry(), config);
  const EnsembleResult result = Ensemble(ensemble).threads(1).run();
  ASSERT_TRUE(result.failures.empty()) << result.failures[0].reason;
  for (long k = 0; k < config.members; ++k) {
    const Member member = ensemble.member(k);
    const Result rows = simulate(config.run.system).config(member.config).run();
    Config at = member.config;
    at.every = 1;
    at.output_times = {0, 0.31};
    const Result between = simulate(config.run.system).config(at).run();
    for (size_t i = 0; i < of.size(); ++i) {
      const std::vector<double> all = rows.trajectory.column(of[i]);
      const std::vector<double> expected = {all.back(), *std::ranges::max_element(all),
                                            *std::ranges::min_element(all),
                                            between.trajectory.column(of[i]).back()};
      double size = 1e-3;
      for (const double x : expected) size = std::max(size, std::abs(x));
      for (size_t j = 0; j < 4; ++j) {
        const auto& [name, value] = member.kept[4 * i + j];
        EXPECT_NEAR(value, expected[j], 1e-9 * size) << config.run.system << " " << name;
        EXPECT_EQ(value, column(result, name)[static_cast<size_t>(k)]) << name;
      }
    }
  }
}

EnsembleConfig of(const std::string& system, double until) {
  EnsembleConfig config;
  config.run.system = system;
  config.run.until = until;
  config.seed = 5;
  return config;
}

/// An input, whose value and a parameter vary: members are built anew, and restarted.
TEST(KeptPhysics, TheWorkOfAnInput) {
  EnsembleConfig segway = of("segway", 0.5);
  segway.run.step = 0.01;
  segway.vary = {{"left_torque", Law::uniform, {-1, 1}}};
  expect_as_in_rows(segway, {"work", "energy_error", "lambda1", "lambda3"});
  segway.vary.push_back({"mass", Law::uniform, {40, 80}});
  expect_as_in_rows(segway, {"work", "lambda2"});
}

/// Long steps of an explicit pair: the work is that within the steps.
TEST(KeptPhysics, TheWorkOfAMovingConstraintAndOfAForce) {
  EnsembleConfig turntable = of("ball_on_turntable", 2);
  turntable.run.rtol = 1e-8;
  turntable.vary = {{"table_rate", Law::uniform, {0.5, 2}}};
  expect_as_in_rows(turntable, {"work", "energy_error", "lambda1"});
  EnsembleConfig snakeboard = of("snakeboard", 1);
  snakeboard.run.scheme = "lift";
  snakeboard.run.step = 0.02;
  snakeboard.run.every = 5;
  snakeboard.vary = {{"mass", Law::uniform, {1, 3}}};
  expect_as_in_rows(snakeboard, {"work", "energy_error"});
}

/// A ball that bounces, slides and rolls: the work of its friction, over what strikes take; modes
/// and reactions at a time within the step that a switch ends. Built anew, and restarted.
TEST(KeptPhysics, ContactsThatSwitch) {
  EnsembleConfig ball = of("rolling_ball", 1);
  ball.run.slip = true;
  ball.run.parameters = {{"friction", {0.2}}, {"restitution", {0.4}}};
  ball.run.start.velocity = {3, -20, 5, 2, 0.5, 1};
  ball.run.rtol = 1e-9;
  const std::vector<std::string> kept = {"work", "energy_error", "contact.mode", "lambda2",
                                         "lambda3"};
  ball.vary = {{"friction", Law::uniform, {0.05, 0.5}}};
  expect_as_in_rows(ball, kept);
  ball.vary = {{"start.omega2", Law::uniform, {-30, 30}}};
  expect_as_in_rows(ball, kept);
}

/// Where the energy is kept the reactions still are what the rows have, in formulas too.
TEST(KeptPhysics, ReactionsWhereNoWorkIsDone) {
  EnsembleConfig sleigh = of("chaplygin_sleigh", 1);
  sleigh.run.step = 0.05;
  sleigh.vary = {{"start.omega", Law::uniform, {1, 2}}};
  expect_as_in_rows(sleigh, {"lambda1"});
  sleigh.members = 2;
  sleigh.keep = {{"squared", "max.(lambda1^2)"}, {"largest", "max.(abs(lambda1))"}};
  const EnsembleResult result = Ensemble(registry(), sleigh).run();
  EXPECT_NEAR(column(result, "squared")[0], std::pow(column(result, "largest")[0], 2), 1e-12);
  EXPECT_GT(column(result, "largest")[0], 0.01);
}

/// A run that an event ends within a step.
TEST(KeptPhysics, TheWorkUpToAnEvent) {
  EnsembleConfig segway = of("segway", 5);
  segway.run.step = 0.01;
  segway.run.inputs["left_torque"] = 3.0;
  segway.run.stop_at = {"theta_4 = 0.3", "theta_4 = -0.3"};
  segway.members = 2;
  segway.vary = {{"mass", Law::uniform, {40, 80}}};
  segway.keep = {{"", "end.work"}, {"gain", "end.energy - start.energy"}, {"", "end.t"}};
  const EnsembleResult result = Ensemble(registry(), segway).run();
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_LT(column(result, "end.t")[k], 5);
    EXPECT_NEAR(column(result, "end.work")[k], column(result, "gain")[k],
                1e-3 * std::abs(column(result, "gain")[k]) + 1e-6);
  }
}

TEST(KeptPhysics, WhatIsNotThereIsRefused) {
  const auto refused = [](const std::string& system, const std::string& kept) {
    EnsembleConfig config = of(system, 1);
    config.members = 1;
    config.data = "group = 'r1'\ninertia = [1]\npotential = '0.5*x1^2'\nvelocity = [1]\n";
    config.keep = {{"", kept}};
    return refusal([&] { Ensemble(registry(), config); });
  };
  EXPECT_THAT(refused("chaplygin_sleigh", "end.work"),
              HasSubstr("work: no forces and no moving constraints do work on chaplygin_sleigh"));
  EXPECT_THAT(refused("chaplygin_sleigh", "max.(work^2)"), HasSubstr("do work on"));
  EXPECT_THAT(refused("chaplygin_sleigh", "end.lambda2"), HasSubstr("did you mean 'lambda1'?"));
  EXPECT_THAT(refused("spring.toml", "end.lambda1"),
              HasSubstr("lambda1: spring.toml has no constraints, and no reactions"));
  EnsembleConfig fed = of("segway", 1);
  fed.members = 1;
  fed.keep = {{"", "end.t"}};
  fed.run.step = 0.01;
  fed.feedback = {0.01, {{"left_torque", "work"}}};
  EXPECT_THAT(refusal([&] { Ensemble(registry(), fed); }), HasSubstr("feedback.left_torque"));
}

}  // namespace
