// Events: located where the motion is known in closed form, stopped at, changed at.
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hamel/framework/io/output_file.hpp>
#include <hamel/framework/io/table.hpp>
#include <hamel/hamel.hpp>

namespace hamel {
namespace {

using testing::HasSubstr;

// v = U tanh(kappa t + c) with J omega^2 + m v^2 kept, J about the blade: it stops at t = -c/kappa.
TEST(Events, AreLocatedOnTheSleigh) {
  const double m = 1, a = 0.2, moment = 0.1 + m * a * a, omega = 0.9, v = -1;
  const double twice = moment * omega * omega + m * v * v, u = std::sqrt(twice / m);
  const double kappa = a * (twice / moment) / u, time = -std::atanh(v / u) / kappa;
  for (const std::string scheme : {"dopri5", "tsit5", "dop853"}) {
    const Result r = simulate("chaplygin_sleigh")
                         .scheme(scheme)
                         .tolerance({.relative = 1e-13})
                         .events({"cusp"})
                         .until(20)
                         .run();
    ASSERT_TRUE(r) << r.status.reason;
    ASSERT_EQ(r.events.size(), 1u) << scheme;
    EXPECT_NEAR(r.events[0].time, time, 1e-11) << scheme;
    EXPECT_NEAR(r.events[0].velocity[1], 0, 1e-12);
    EXPECT_DOUBLE_EQ(r.last.time, 20);
  }
}

// x = asinh-shaped: from (0, 0, 0) with x' = c, y' = w it is x = c/w asinh(w t), so that x = 1 at t
// = sinh(w/c)/w.
TEST(Events, AreLocatedOnTheParticleAndStopTheRun) {
  const double c = 1, w = 0.7, time = std::sinh(w / c) / w;
  for (const std::string scheme : {"dopri5", "dop853"}) {
    const Result r = simulate("nonholonomic_particle")
                         .start({.configuration = {0, 0, 0}, .velocity = {c, w, 0}})
                         .scheme(scheme)
                         .tolerance({.relative = 1e-13})
                         .stop_at({"x1=1"})
                         .until(20)
                         .run();
    ASSERT_TRUE(r);
    ASSERT_EQ(r.events.size(), 1u);
    EXPECT_NEAR(r.events[0].time, time, 1e-11);
    EXPECT_EQ(r.last.time, r.events[0].time);
    EXPECT_EQ(r.status.reason, "stopped at x1=1");
    EXPECT_EQ(r.trajectory.column("t").back(), r.events[0].time);
    EXPECT_THAT(r.record(), HasSubstr("\"name\": \"x1=1\""));
  }
}

// The centre of the ball circles with the rate Omega I/(I + m r^2); from (d, 0) at speed y' = rate
// d it crosses x = 0 after a quarter of a turn.
TEST(Events, AreLocatedOnTheTurntable) {
  const Result r = simulate("ball_on_turntable")
                       .scheme("dop853")
                       .tolerance({.relative = 1e-13})
                       .events({"2_x1=0", "xi4=0"})
                       .until(40)
                       .run();
  ASSERT_TRUE(r);
  ASSERT_GE(r.events.size(), 3u);
  std::vector<double> crossings;
  for (const EventMet& e : r.events)
    if (e.name == "xi4=0") crossings.push_back(e.time);
  ASSERT_GE(crossings.size(), 2u);
  const auto parameter = [&](const char* name) { return r.config.parameters.at(name)[0]; };
  const double inertia = parameter("inertia");
  const double rate = parameter("table_rate") * inertia /
                      (inertia + parameter("mass") * std::pow(parameter("radius"), 2));
  for (size_t i = 1; i < crossings.size(); ++i)
    EXPECT_NEAR(crossings[i] - crossings[i - 1], M_PI / std::abs(rate), 1e-10);
}

// With a scheme of order 2 and steps of one size the same event is met to its order, on the group
// and in the constraint.
TEST(Events, AreLocatedWithGeometricSteps) {
  const Result exact = simulate("rattleback")
                           .scheme("dop853")
                           .tolerance({.relative = 1e-12})
                           .stop_at({"reversed"})
                           .until(60)
                           .run();
  ASSERT_EQ(exact.events.size(), 1u);
  double before = 0;
  for (const double h : {0.004, 0.002}) {
    const Result r = simulate("rattleback").step(h).stop_at({"reversed"}).until(60).run();
    ASSERT_EQ(r.events.size(), 1u);
    const double error = std::abs(r.events[0].time - exact.events[0].time);
    EXPECT_LT(error, 0.2);
    if (before > 0) {
      EXPECT_NEAR(before / error, 4, 1.2);
    }
    before = error;
    EXPECT_LT(r.last.holonomic, 1e-12);
    EXPECT_LT(r.last.group_defect, 1e-14);
  }
}

// "fallen" crosses zero downwards as time runs on, so upwards along a run back.
TEST(Events, HaveTheDirectionOfTimeInRunsBack) {
  const auto disk = [](const Start& start) {
    return simulate("falling_disk").start(start).scheme("dop853").tolerance({1e-11});
  };
  const Result there =
      disk({.velocity = {0.5, 0, 0, 0, 0, 0}}).events({"fallen"}).until(0.65).run();
  ASSERT_TRUE(there) << there.status.reason;
  ASSERT_EQ(there.events.size(), 1u);
  const Result back =
      disk({.configuration = there.last.coordinates, .velocity = there.last.velocity})
          .events({"fallen"})
          .from(0.65)
          .step(-0.001)
          .until(0.5)
          .run();
  ASSERT_TRUE(back) << back.status.reason;
  ASSERT_EQ(back.events.size(), 1u);
  EXPECT_NEAR(back.events[0].time, there.events[0].time, 1e-8);
}

// A ball thrown from a slope: at y = 0 its velocity turns round; it comes back to its height, and
// the times are known.
TEST(Events, LetTheCallerChangeTheState) {
  int met = 0;
  const Result r = simulate("nonholonomic_particle")
                       .start({.configuration = {0, 0.5, 0}, .velocity = {0, -0.25, 0}})
                       .scheme("dopri5")
                       .tolerance({.relative = 1e-10})
                       .on_event("x2=0",
                                 [&](EventState& state) {
                                   ++met;
                                   EXPECT_NEAR(state.time, 2, 1e-9);
                                   state.velocity[1] = -state.velocity[1];
                                 })
                       .until(6)
                       .run();
  ASSERT_TRUE(r);
  EXPECT_EQ(met, 1);
  EXPECT_NEAR(r.last.coordinates[1], 1.0, 1e-9);
  EXPECT_DOUBLE_EQ(r.last.time, 6);
}

// A ball that falls under g and comes back from the floor x2 = 0: rows within the step of an impact
// are of the motion before it, the last state is a row, and there is no comparison with the motion
// without a floor.
TEST(Events, RowsAroundAnImpact) {
  const auto bounce = [] {
    return simulate("nonholonomic_particle")
        .start({.configuration = {0, 0.5, 0}, .velocity = {0, -0.25, 0}})
        .step(0.3)
        .on_event("x2=0", [](EventState& state) { state.velocity[1] *= -0.5; });
  };
  const Result rows = bounce().output(0.1).until(3).run();
  ASSERT_TRUE(rows);
  const std::vector<double> t = rows.trajectory.column("t"), x2 = rows.trajectory.column("x2");
  for (size_t i = 0; i < t.size(); ++i)
    EXPECT_NEAR(x2[i], t[i] < 2 ? 0.5 - 0.25 * t[i] : 0.125 * (t[i] - 2), 1e-12) << t[i];
  const Result last = bounce().until(2.1).run();  // a whole step does not follow
  ASSERT_TRUE(last);
  EXPECT_DOUBLE_EQ(last.trajectory.column("t").back(), last.last.time);
  EXPECT_NEAR(last.last.time, 2, 1e-9);
  EXPECT_NEAR(last.last.velocity[1], 0.125, 1e-12);
  EXPECT_TRUE(std::isnan(last.exact_error_max));
  EXPECT_THAT(last.notes, testing::Contains(testing::HasSubstr("1 impact changed the state")));
  EXPECT_THAT(last.notes, Not(testing::Contains(testing::HasSubstr("nothing does work"))));
}

// What an impact makes of the state is looked at before the run continues from it.
TEST(Events, ImpactsThatNoRunCanGoOnFrom) {
  const auto says = [](const std::string& system, const std::string& event, Impact impact) {
    try {
      simulate(system).scheme("dop853").tolerance({1e-8}).on_event(event, impact).until(5).run();
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  EXPECT_THAT(says("chaplygin_sleigh", "theta=1", [](EventState& s) { s.velocity.clear(); }),
              testing::HasSubstr("on_event theta=1: at t = "));
  EXPECT_THAT(
      says("chaplygin_sleigh", "theta=1", [](EventState& s) { s.velocity[1] = std::nan(""); }),
      testing::HasSubstr("is not finite"));
  EXPECT_THAT(says("chaplygin_sleigh", "theta=1", [](EventState& s) { s.coordinates.pop_back(); }),
              testing::HasSubstr("on_event theta=1: at t = "));
  EXPECT_THAT(says("falling_disk", "x=0.01", [](EventState& s) { s.coordinates[11] += 0.3; }),
              testing::HasSubstr("the holonomic constraints do not hold, |phi| = 0.3"));
}

// What changed the state is no part of a file: a run is not gone on with without it.
TEST(Events, FilesOfRunsWithImpacts) {
  namespace fs = std::filesystem;
  if (hdf5_version().empty()) GTEST_SKIP() << "built without HDF5";
  const fs::path file =
      fs::temp_directory_path() / ("hamel_impacts_" + std::to_string(::getpid()) + ".h5");
  const auto lane = [&] {
    return simulate("chaplygin_sleigh").until(100).resume(file.string()).record_to(file.string());
  };
  const auto wall = [](EventState& s) { s.velocity[1] *= -1; };
  int rows = 0;
  Simulation first = simulate("chaplygin_sleigh").until(100).on_event("y=-1", wall);
  first.record_to(file.string()).observe([&](const Snapshot&) -> bool {
    if (++rows > 6000) throw std::runtime_error("enough");
    return true;
  });
  EXPECT_THROW(first.run(), std::runtime_error);
  EXPECT_THAT(lane().mistakes(), testing::Contains(testing::HasSubstr("on_event: y=-1")));
  EXPECT_THAT(lane().on_event("y=-1", wall).mistakes(), testing::IsEmpty());
  fs::remove(part_of(file.string()));
}

// Of its energy and its invariants an impact is no error.
TEST(Events, ImpactsAreNoErrors) {
  const Result r = simulate("chaplygin_sleigh")
                       .start({.velocity = {0.5, 1, 0}})
                       .scheme("dop853")
                       .tolerance({1e-10})
                       .on_event("x=0.3", [](EventState& s) { s.velocity[1] *= 0.5; })
                       .until(5)
                       .run();
  ASSERT_TRUE(r);
  EXPECT_LT(r.energy_error_max, 1e-8);
  for (const InvariantDrift& i : r.invariants) EXPECT_LT(i.drift_max, 1e-8) << i.name;
  Simulation driven = simulate("segway").input("left_torque", 0.3).input("right_torque", 0.3);
  const Result work = driven.scheme("dop853")
                          .tolerance({1e-11})
                          .on_event("1_x=0.01", [](EventState& s) { s.velocity[0] += 0.5; })
                          .until(0.6)
                          .run();
  ASSERT_TRUE(work) << work.status.reason;
  EXPECT_THAT(work.notes, testing::Contains(testing::HasSubstr("1 impact changed the state")));
  EXPECT_LT(work.energy_balance_error_max, 1e-6);
}

// By hand: times that lie behind, or between no two nodes of the last step.
TEST(RunByHand, KnowWhereTheyAre) {
  for (const double tolerance : {0.0, 1e-6}) {
    Simulation s = simulate("chaplygin_sleigh");
    if (tolerance > 0) s.scheme("tsit5").tolerance({tolerance});
    hamel::Run run = s.build();
    EXPECT_TRUE(run.advance_to(0.7).ok);
    EXPECT_TRUE(run.advance_to(0.7).ok);
    const Status behind = run.advance_to(0.3), none = run.advance_to(std::nan(""));
    EXPECT_FALSE(behind.ok);
    EXPECT_THAT(behind.reason, testing::HasSubstr("lies behind"));
    EXPECT_FALSE(none.ok);
    EXPECT_THAT(none.reason, testing::HasSubstr("expected a finite time"));
    EXPECT_NEAR(run.at(0.699).time, 0.699, 1e-15);
    for (const double t : {0.1, 5.0, -3.0, std::nan("")})
      EXPECT_THROW(run.at(t), std::runtime_error) << t;
  }
}

// Steps of 2 over an event of period 2 pi, which is above 0 for 0.62 of it.
TEST(Events, TwoCrossingsWithinALongStep) {
  Simulation run = simulate("nonholonomic_particle").scheme("dop853").step(2).until(20);
  run.start({.configuration = {0, -5, 0}, .velocity = {0, 1, 0}});
  const Result r = run.events({"1.05*cos(x2)=1"}).run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  const double half = std::acos(1 / 1.05);
  std::vector<double> found;
  for (const EventMet& e : r.events) found.push_back(e.time);
  ASSERT_GE(found.size(), 2U);
  EXPECT_NEAR(found[0], 5 - half, 1e-10);
  EXPECT_NEAR(found[1], 5 + half, 1e-10);
}

TEST(Events, WhatWasToStopTheRunAndDidNotIsNoted) {
  using testing::Contains, testing::Not;
  const auto run = [](std::vector<std::string> names, double until) {
    return simulate("falling_disk").stop_at(std::move(names)).until(until).run();
  };
  EXPECT_THAT(run({"x=5"}, 0.5).notes,
              Contains("stop_at: x=5 was not met before the end, t = 0.5"));
  EXPECT_THAT(run({"x=5", "y=5"}, 0.5).notes,
              Contains("stop_at: none of x=5, y=5 was met before the end, t = 0.5"));
  const Result met = run({"x=0.1"}, 5);
  EXPECT_TRUE(met.stopped_by_event);
  EXPECT_THAT(met.notes, Not(Contains(HasSubstr("stop_at"))));
}

TEST(Mistakes, OfEventsAndOutputAreFoundBeforeTheRun) {
  const auto said = [](Simulation s) {
    std::string all;
    for (const std::string& m : s.mistakes()) all += m + "\n";
    return all;
  };
  EXPECT_THAT(said(simulate("falling_disk").events({"falen"})), HasSubstr("did you mean 'fallen'"));
  EXPECT_THAT(said(simulate("falling_disk").stop_at({"q=1"})),
              HasSubstr("stop_at: 'q=1': unknown name 'q'"));
  EXPECT_THAT(said(simulate("suslov").output({0, 30}).until(20)),
              HasSubstr("output_times: got 30"));
  EXPECT_THAT(said(simulate("suslov").output({0, 2, 1})), HasSubstr("beyond the one before"));
  EXPECT_THAT(said(simulate("suslov").output(-1)), HasSubstr("output_step"));
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    EXPECT_THAT(said(simulate("suslov").scheme("dopri5").tolerance({.relative = bad})),
                HasSubstr("rtol: got"));
    EXPECT_THAT(
        said(simulate("suslov").scheme("dopri5").tolerance({.relative = 1e-6, .absolute = bad})),
        HasSubstr("atol: got"));
  }
  EXPECT_THAT(said(simulate("suslov").scheme("rkmk4").tolerance({.relative = 1e-6})),
              HasSubstr("steps of one size"));
  EXPECT_THAT(said(simulate("falling_disk").scheme("lift").s(0).tolerance({.relative = 1e-6})),
              HasSubstr("s = 0.5"));
}

// y = cos t beyond -cos(half) for 2 half about each pi (2 k + 1): less than a step of dop853, of
// which a run has some 0.4 s, so that the event has the same sign at nodes about it.
TEST(Events, TwoCrossingsWithinAStepAreFound) {
  for (const double half : {0.1, 0.03, 0.01}) {
    const std::string event = "x2=-cos(" + std::to_string(half) + ")";
    const auto found = [&](const std::string& scheme, double until) {
      Simulation run = simulate("nonholonomic_particle").scheme(scheme).events({event});
      run.set("spring", {1}).start({.configuration = {0, 1, 0}, .velocity = {0, 0, 0}});
      return run.tolerance({.relative = 1e-9}).until(until).run();
    };
    for (const std::string scheme : {"dopri5", "tsit5", "dop853"}) {
      for (const double until : {200.0, -200.0}) {
        const Result r = found(scheme, until);
        ASSERT_TRUE(r) << r.status.reason;
        ASSERT_EQ(r.events.size(), 64u) << scheme << half;  // at pi, 3 pi, ..., 63 pi
        for (int k = 0; k < 64; ++k) {
          const double middle = M_PI * (2 * (k / 2) + 1);
          const double exact = k % 2 == 0 ? middle - half : middle + half;
          EXPECT_NEAR(std::abs(r.events[static_cast<size_t>(k)].time), exact, 2e-5);
        }
      }
    }
  }
}

}  // namespace
}  // namespace hamel
