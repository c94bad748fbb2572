// A run that is stepped by hand: inputs from the caller's loop, times to advance to, and another
// start.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <hamel/hamel.hpp>
#include <hamel/systems/falling_disk.hpp>
#include <hamel/systems/n_trailer.hpp>

#include "refusal.hpp"

namespace hamel {
namespace {

using testing::HasSubstr;

// A torque of the caller's, held over five steps, is the table that is held there.
TEST(RunByHand, TakesInputsBetweenSteps) {
  InputTable table{{}, {}, true};
  for (const std::string scheme : {"lift", "balance", "rkmk4", "rk4_projected"}) {
    hamel::Run run = simulate("segway").scheme(scheme).step(0.01).input("left_torque", 0).build();
    table.times.clear(), table.values.clear();
    for (int k = 0; k < 20; ++k) {
      const double torque = 3 * std::sin(0.4 * k);
      table.times.push_back(0.05 * k);
      table.values.push_back(torque);
      run.input("left_torque", torque);
      ASSERT_TRUE(run.advance_to(0.05 * (k + 1)));
    }
    table.times.push_back(1);
    table.values.push_back(0);
    EXPECT_EQ(run.state().step, 100);
    Simulation same = simulate("segway").scheme(scheme).step(0.01).until(1);
    const Result result = same.input("left_torque", table).run();
    for (size_t i = 0; i < 6; ++i)
      EXPECT_NEAR(run.state().velocity[i], result.last.velocity[i], 1e-11) << scheme;
  }
}

TEST(RunByHand, AdvancesByWholeSteps) {
  hamel::Run run = simulate("chaplygin_sleigh").step(0.1).build();
  EXPECT_TRUE(run.advance_to(0.3));
  EXPECT_EQ(run.state().step, 3);
  EXPECT_TRUE(run.advance_to(0.3));  // there already
  EXPECT_TRUE(run.advance_to(0.53));
  EXPECT_EQ(run.state().step, 5);
  hamel::Run back = simulate("chaplygin_sleigh").step(-0.1).until(-1).build();
  EXPECT_TRUE(back.advance_to(-0.3));
  EXPECT_EQ(back.state().step, 3);
}

TEST(RunByHand, RefusesBadInputs) {
  hamel::Run run = simulate("segway").input("left_torque", 0).build();
  EXPECT_THAT(refusal([&] { run.input("left_torqe", 1); }),
              HasSubstr("did you mean 'left_torque'?"));
  EXPECT_THAT(refusal([&] { run.input("left_torque", std::nan("")); }), HasSubstr("got nan"));
  EXPECT_EQ(refusal([&] { run.input("right_torque", 1); }), "accepted");
  hamel::Run undriven = simulate("segway").build();
  EXPECT_THAT(refusal([&] { undriven.input("left_torque", 1); }),
              HasSubstr(".input(\"left_torque\", 0)"));
  EXPECT_THAT(refusal([&] { simulate("suslov").build().input("torque", 1); }),
              HasSubstr("suslov has no inputs"));
}

// Beyond its table an input is not known.
TEST(RunByHand, EndsWithItsTables) {
  Simulation made = simulate("segway").step(0.01).until(1);
  hamel::Run run = made.input("left_torque", InputTable{{0, 1}, {0, 1}}).build();
  EXPECT_TRUE(run.step(100));
  const Status status = run.step();
  EXPECT_FALSE(status);
  EXPECT_THAT(status.reason, HasSubstr("does not cover t = 1.01"));
  EXPECT_EQ(status.step, 101);
  run.input("left_torque", 0);
  EXPECT_TRUE(run.step());
}

// Another start gives what a run that is built for it gives, to the last bit: nothing is left of
// the motion before.
TEST(RunByHand, StartsAgain) {
  struct Case {
    std::string system, scheme, compose;
    Start start;
  };
  const Start disk = FallingDisk{}.rolling(1.1, {0.3, -0.2, 6});
  std::vector<Case> cases = {{"suslov", "balance", "kahan_li6", {.momentum = {0.3, -0.8, 0}}},
                             {"falling_disk", "lift", "suzuki4", disk},
                             {"falling_disk", "rkmk4", "none", disk},
                             {"falling_disk", "reversible", "none", disk},
                             {"falling_disk", "unadapted", "none", disk},
                             {"n_trailer", "lift", "none", NTrailer{}.circling(5, 1)}};
  for (const std::string& scheme : registry().schemes()) {  // whose problems are kept
    cases.push_back({"suslov", scheme, "none", {.velocity = {0.3, -0.8, 0}}});
    cases.push_back({"chaplygin_sleigh", scheme, "none", {.velocity = {0.1, 1, 0}}});
  }
  for (const Case& c : cases) {
    SCOPED_TRACE(std::string(c.system) + ", " + c.scheme + ", " + c.compose);
    const auto made = [&] {
      Simulation simulation = simulate(c.system);
      return simulation.scheme(c.scheme).compose(c.compose).step(0.01);
    };
    hamel::Run again = made().build(), fresh = made().start(c.start).build();
    ASSERT_TRUE(again.step(37));
    (void)again.state();
    again.restart(c.start);
    EXPECT_EQ(again.state().time, 0);
    EXPECT_EQ(again.state().coordinates, fresh.state().coordinates);
    EXPECT_EQ(again.config().start.velocity, fresh.config().start.velocity);
    ASSERT_TRUE(again.step(100));
    ASSERT_TRUE(fresh.step(100));
    EXPECT_EQ(again.state().coordinates, fresh.state().coordinates);
    EXPECT_EQ(again.state().velocity, fresh.state().velocity);
    EXPECT_EQ(again.state().constraint, fresh.state().constraint);
    EXPECT_EQ(again.stats().iterations, fresh.stats().iterations);
    EXPECT_EQ(again.state().step, 100);
  }
  hamel::Run run = simulate("suslov").build();
  EXPECT_THAT(refusal([&] {
                run.restart({.velocity = {1, 2}});
              }),
              HasSubstr("velocity: got 2 values"));
}

}  // namespace
}  // namespace hamel
