// Notes of a run where the other diagnostics are silent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <hamel/hamel.hpp>

namespace {

using namespace hamel;
using testing::Contains;
using testing::HasSubstr;

// Rolls at 1000 rad/s: 10 rad a step of 0.01 s, which Cayley takes as 2 atan 5.
Simulation racing_disk() {
  return simulate("falling_disk")
      .start({.configuration = {1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 0.5},
              .velocity = {0, 0, 1000, -500, 0, 0}});
}

TEST(Diagnostics, ATurnByRadiansIsMeasuredAndNoted) {
  const Result fast = racing_disk().step(0.01).until(1).run();
  ASSERT_TRUE(fast.status.ok);
  EXPECT_GT(fast.rotation_per_step_max, 2 * std::atan(5.0) - 0.1);  // Cayley's 10 rad
  EXPECT_LT(fast.rotation_per_step_max, std::numbers::pi);
  EXPECT_THAT(fast.notes, Contains(HasSubstr("a step turns by up to 2.")));
  const Result slow = racing_disk().step(1e-4).until(0.01).run();
  EXPECT_NEAR(slow.rotation_per_step_max, 0.1,
              0.1 * 0.1 * 0.1 / 4);  // the error of a step, of order 2
  EXPECT_THAT(slow.notes, Not(Contains(HasSubstr("rad"))));
}

TEST(Diagnostics, AStepThatTheReversibleControlDoesNotTakeIsNoted) {
  const auto notes = [](const char* scheme) {
    return simulate("rattleback")
        .scheme(scheme)
        .step(0.05)
        .tolerance({.relative = 1e-5})
        .until(1)
        .run()
        .notes;
  };
  EXPECT_THAT(notes("lift"), Contains(HasSubstr("step is not the first one")));
  EXPECT_THAT(notes("dop853"), Not(Contains(HasSubstr("step"))));
}

TEST(Diagnostics, RotationOfEveryKindOfGroup) {
  const auto rotation = [](const char* system) {
    return simulate(system).step(0.01).until(0.1).run().rotation_per_step_max;
  };
  const Result sleigh = simulate("chaplygin_sleigh").step(0.01).until(0.01).run();
  EXPECT_NEAR(rotation("suslov"), 0.01 * std::hypot(1.0, 1.0), 0.01);
  EXPECT_NEAR(sleigh.rotation_per_step_max, std::abs(sleigh.last.coordinates[0]), 1e-15);  // se2
  EXPECT_GT(rotation("rolling_disk"), 0);  // se2*so2
  EXPECT_TRUE(std::isnan(rotation("heisenberg_particle")));
  EXPECT_TRUE(std::isnan(rotation("nonholonomic_particle")));  // r3
}

TEST(Diagnostics, TheRotationIsThatOfASubstep) {
  const auto run = [](const char* compose) {
    return simulate("suslov").compose(compose).step(0.05).until(1).run().rotation_per_step_max;
  };
  EXPECT_NEAR(run("suzuki4") / run("none"), 0.4145, 0.01);  // the last substep's coefficient
}

TEST(Diagnostics, TheHolonomicResidualIsAColumn) {
  const Result run = simulate("falling_disk").step(0.01).until(1).scheme("rkmk4").run();
  const std::vector<double> phi = run.trajectory.column("holonomic");
  EXPECT_EQ(*std::max_element(phi.begin(), phi.end()), run.holonomic_max);
  EXPECT_GT(run.holonomic_max, 0);
  EXPECT_THAT(run.report(), HasSubstr("holonomic residual"));
  EXPECT_FALSE(simulate("suslov").until(1).run().trajectory.has("holonomic"));
}

TEST(Diagnostics, CheckEstimatesTheErrorAndTheOrder) {
  const auto run = [](const char* scheme) {
    return simulate("chaplygin_sleigh")
        .scheme(scheme)
        .step(0.02)
        .until(2)
        .with(&Config::check, true)
        .run();
  };
  const Result second = run("lift"), fourth = run("rkmk4");
  EXPECT_NEAR(second.estimated_error / second.exact_error_final, 1, 0.02);
  EXPECT_NEAR(second.observed_order, 2, 0.05);
  EXPECT_NEAR(fourth.estimated_error / fourth.exact_error_final, 1, 0.05);
  EXPECT_NEAR(fourth.observed_order, 4, 0.2);
  EXPECT_THAT(second.report(), HasSubstr("estimated error"));
  EXPECT_TRUE(std::isnan(simulate("suslov").until(1).run().estimated_error));  // not asked for
}

/// Ends that agree to round-off show no order: a bound, and no error of 0.
TEST(Diagnostics, CheckGivesABoundWhereNoOrderIsSeen) {
  const auto run = [](Simulation cart) {
    return cart.start({.velocity = {0, 0.5, 0, 5, 5}}).until(1).with(&Config::check, true).run();
  };
  for (const Result& r :
       {run(simulate("differential_drive").step(0.01)), run(simulate("differential_drive"))}) {
    EXPECT_TRUE(std::isnan(r.observed_order));
    EXPECT_GT(r.estimated_error, 1e-12);
    EXPECT_LT(r.estimated_error, 1e-10);
    EXPECT_THAT(r.report(), HasSubstr("no order was observed"));
    EXPECT_THAT(r.report(), testing::Not(HasSubstr("0.00e+00 of the configuration")));
  }
  const Result chosen = simulate("chaplygin_sleigh")
                            .scheme("dopri5")
                            .tolerance({.relative = 1e-6})
                            .until(2)
                            .with(&Config::check, true)
                            .run();
  EXPECT_THAT(chosen.report(), HasSubstr(" in the tolerance"));
}

/// The largest step that is chosen, by the error and by the reversible control.
TEST(Diagnostics, ChosenStepsHaveALargestSize) {
  for (const char* scheme : {"dop853", "lift"}) {
    for (const double sign : {1.0, -1.0}) {
      const Result r = simulate("chaplygin_sleigh")
                           .scheme(scheme)
                           .tolerance({.relative = 1e-3})
                           .with(&Config::step_max, 0.01)
                           .until(sign)
                           .run();
      ASSERT_TRUE(r.status.ok) << r.status.reason;
      const std::vector<double> t = r.trajectory.column("t");
      EXPECT_GE(r.steps, 100) << scheme;
      for (size_t i = 1; i < t.size(); ++i) EXPECT_LE(std::abs(t[i] - t[i - 1]), 0.01 + 1e-15);
    }
  }
}

/// The ends of the three runs are of one time, that of the event where the first one stopped.
TEST(Diagnostics, CheckOfARunThatStopsAtAnEvent) {
  const auto run = [](Simulation sleigh) {
    return sleigh.stop_at({"theta=1"}).until(20).with(&Config::check, true).run();
  };
  const Result lift = run(simulate("chaplygin_sleigh").step(0.02));
  EXPECT_TRUE(lift.stopped_by_event);
  EXPECT_NEAR(lift.estimated_error / lift.exact_error_final, 1, 0.05);
  EXPECT_NEAR(lift.observed_order, 2, 0.1);
  const Result pair =
      run(simulate("chaplygin_sleigh").scheme("dopri5").tolerance({.relative = 1e-6}));
  EXPECT_NEAR(pair.estimated_error / pair.exact_error_final, 1, 0.3);
  EXPECT_NEAR(run(simulate("chaplygin_sleigh").step(0.02).every(7)).estimated_error,
              lift.estimated_error, 1e-15);
}

/// Measured from the start to the end, whatever the rows: none at the start, none at the end.
TEST(Diagnostics, DoNotDependOnTheRows) {
  for (const char* system : {"chaplygin_sleigh", "snakeboard", "ball_on_turntable", "segway"}) {
    const auto of = [&](auto rows) {
      Simulation s = simulate(system);
      s.until(5).step(0.01);
      rows(s);
      return s.run();
    };
    const Result all = of([](Simulation&) {});
    for (const std::vector<double>& times : std::vector<std::vector<double>>{{1, 2}, {3}}) {
      const Result some = of([&](Simulation& s) { s.output(times); });
      ASSERT_TRUE(some) << system;
      EXPECT_EQ(some.trajectory.rows(), times.size());
      if (std::isfinite(all.exact_error_final)) {
        EXPECT_NEAR(some.exact_error_final, all.exact_error_final, 1e-9) << system;
      }
      EXPECT_LE(some.energy_error_max, all.energy_error_max * (1 + 1e-6) + 1e-15) << system;
      EXPECT_GT(some.energy_error_max, 0) << system;
      if (std::isfinite(all.work)) {
        EXPECT_NEAR(some.work, all.work, 1e-9) << system;
      }
      for (size_t i = 0; i < all.invariants.size(); ++i)
        EXPECT_NEAR(some.invariants[i].start, all.invariants[i].start, 1e-12) << system;
    }
  }
}

/// A sum over few rows is reported as one.
TEST(Diagnostics, TheWorkOfReactionsOfFewRows) {
  const auto notes = [](long every) {
    return simulate("snakeboard").step(0.01).until(10).every(every).run().notes;
  };
  EXPECT_THAT(notes(1), Not(Contains(HasSubstr("work of reactions"))));
  EXPECT_THAT(notes(250), Contains(HasSubstr("the work of reactions is summed over the rows")));
}

/// Without the constraint the limit of the steps is another motion.
TEST(Diagnostics, CheckKnowsNothingOfAnotherMotion) {
  const Result run = simulate("suslov")
                         .set("inertia", {2, 0.3, 0.5, 3, 0.4, 4})
                         .start({.velocity = {1, 0.5, 0}})
                         .scheme("unadapted")
                         .until(4)
                         .with(&Config::check, true)
                         .run();
  EXPECT_GT(run.exact_error_final, 1);
  EXPECT_TRUE(std::isnan(run.estimated_error));
  EXPECT_THAT(run.notes, Contains(HasSubstr("its limit is another motion")));
}

/// A run is not lost by the runs that would check it.
TEST(Diagnostics, CheckOfARunThatEndsAtOnce) {
  const Result run = simulate("chaplygin_sleigh")
                         .step(0.01)
                         .stop_at({"x=-0.001"})
                         .until(20)
                         .with(&Config::check, true)
                         .run();
  EXPECT_TRUE(run.stopped_by_event);
  EXPECT_TRUE(std::isnan(run.estimated_error));
  EXPECT_THAT(run.notes, Contains(HasSubstr("ended within its first step")));
  EXPECT_THAT(simulate("suslov")
                  .scheme("dopri5")
                  .tolerance({.relative = 1e-14})
                  .until(5)
                  .with(&Config::check, true)
                  .run()
                  .report(),
              Not(HasSubstr("order nan")));
}

/// The finer runs meet the walls as well.
TEST(Diagnostics, CheckOfARunWithImpacts) {
  int hits = 0;
  const auto lane = [&] {
    const auto wall = [&](EventState& at) { ++hits, at.velocity[1] *= -1; };
    return simulate("chaplygin_sleigh")
        .start({.velocity = {1.5, 0.5, 0}})
        .on_event("y=1", wall)
        .on_event("y=-1", wall)
        .until(8);
  };
  const Result run = lane().step(0.01).with(&Config::check, true).run();
  EXPECT_GE(hits, 3);
  const Result exact = lane()
                           .scheme("dop853")
                           .tolerance({.relative = 1e-12})
                           .until(run.last.time)  // whole steps from the last wall on
                           .run();
  const double error = euclidean_distance(run.last.coordinates, exact.last.coordinates);
  EXPECT_NEAR(run.estimated_error / error, 1, 0.3);
}

/// Long work reports progress and can be ended: the finer runs too.
TEST(Diagnostics, CheckReportsItsProgress) {
  double last = 0;
  int late = 0;
  const auto check = [&](double stop_at) {
    simulate("suslov")
        .until(40)
        .every(1000)
        .with(&Config::check, true)
        .progress([&](double done) {
          EXPECT_GE(done, last);
          EXPECT_LE(done, 1);
          last = done;
          late += done > 1.0 / 7;
          if (done > stop_at) throw std::runtime_error("enough");
        })
        .run();
  };
  check(2);
  EXPECT_GT(late, 0);
  last = 0;
  EXPECT_THROW(check(0.3), std::runtime_error);
}

/// Three ends that agree on nothing give no number.
TEST(Diagnostics, CheckSaysWhenItKnowsNothing) {
  const Result run = racing_disk().step(0.01).until(1).with(&Config::check, true).run();
  EXPECT_TRUE(std::isnan(run.estimated_error) || run.estimated_error > 1);
  EXPECT_TRUE(std::isnan(run.observed_order) || run.observed_order > 0.5);
}

TEST(Diagnostics, AnExplicitStepThroughASingularityFails) {
  // From rest the disk falls flat at about 0.63 s, where the contact is no point any more.
  const auto fall = [](const char* scheme) {
    return simulate("falling_disk")
        .start({.velocity = {0, 0, 0, 0, 0, 0}})
        .scheme(scheme)
        .step(0.01)
        .until(1)
        .run();
  };
  for (const char* scheme : {"rkmk4", "rk4_projected"}) {
    const Result run = fall(scheme);
    EXPECT_FALSE(run.status.ok) << scheme;
    EXPECT_NEAR(run.status.time, 0.63, 0.011) << scheme;
    EXPECT_THAT(run.status.reason, HasSubstr("constraints do not hold at the end of the step"))
        << scheme;
    EXPECT_LT(run.holonomic_max, 1e-6) << scheme;  // of the good steps
    EXPECT_LT(run.energy_error_max, 1e-4) << scheme;
  }
}

TEST(Diagnostics, TheLastStateOfARunIsAStart) {
  for (const char* scheme : {"rkmk4", "reversible", "lift"}) {
    const Result first = simulate("falling_disk").scheme(scheme).step(0.02).until(5).run();
    ASSERT_TRUE(first.status.ok) << scheme;
    const Start end = {.configuration = first.last.coordinates, .velocity = first.last.velocity};
    const Result second = simulate("falling_disk").start(end).step(0.02).until(1).run();
    EXPECT_TRUE(second.status.ok) << scheme;
    const bool off = first.last.holonomic > 1e-9;
    EXPECT_EQ(off, !second.notes.empty() &&
                       second.notes[0].find("moved onto the holonomic") != std::string::npos)
        << scheme << " " << first.last.holonomic;
    EXPECT_LT(second.holonomic_max, 1e-12) << scheme;
  }
  const Start far = {.configuration = {1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0, 0.6},
                     .velocity = {0, 0, 1, 0, 0, 0}};
  EXPECT_THROW(simulate("falling_disk").start(far).run(), ConfigError);
}

TEST(Diagnostics, ACompositionWantsAReversibleStep) {
  const auto mistakes = [](const char* scheme, double s, const char* tau) {
    return simulate("suslov").scheme(scheme).s(s).retraction(tau).compose("yoshida4").mistakes();
  };
  EXPECT_THAT(mistakes("lift", 0, "second_kind"), Contains(HasSubstr("reversible")));
  EXPECT_THAT(mistakes("balance", 0.3, "cayley"), Contains(HasSubstr("reversible")));
  EXPECT_THAT(mistakes("gni", 0.5, "cayley"), Contains(HasSubstr("reversible")));
  EXPECT_THAT(mistakes("boxed", 0, "cayley"), Contains(HasSubstr("reversible")));
  EXPECT_TRUE(mistakes("lift", 0, "cayley").empty());
  EXPECT_TRUE(mistakes("balance", 0.5, "second_kind").empty());
  EXPECT_TRUE(simulate("suslov")
                  .scheme("boxed")
                  .compose("yoshida4")
                  .with(&Config::force, true)
                  .mistakes()
                  .empty());
}

}  // namespace
