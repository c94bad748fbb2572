// Wheels turn by addition: straight ahead their angles are v t / r by every scheme, whatever the
// step. And the starts at a speed: the root turns only where the rows leave nothing else.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

using testing::HasSubstr;

SystemModel model(const std::string& name) { return registry().system(name)->make({}); }

// Straight ahead without the push of the file.
Simulation straight(const std::string& name, double speed, double until) {
  Simulation run = simulate(name);
  run.start(model(name).start_at_speed(speed, 0)).until(until);
  return run;
}

struct Vehicle {
  const char* name;
  std::vector<double> radii;  // of the wheels, in the order of their columns, the last ones
};
const Vehicle kVehicles[] = {{"skateboard", {0.03, 0.03, 0.03, 0.03}}, {"bicycle", {0.3, 0.35}}};

double off(const Vehicle& vehicle, const Result& result, double way) {
  const std::vector<double>& g = result.last.coordinates;
  const size_t first = g.size() - vehicle.radii.size();
  double sum = 0;
  for (size_t i = 0; i < vehicle.radii.size(); ++i)
    sum += std::pow(g[first + i] - way / vehicle.radii[i], 2);
  return std::sqrt(sum);
}

TEST(Wheels, TurnByAdditionWithEveryRetraction) {
  for (const Vehicle& vehicle : kVehicles) {
    for (const char* retraction : {"cayley", "exp", "second_kind_symmetric"}) {
      const Result lift =
          straight(vehicle.name, 2, 5).scheme("lift").step(0.01).retraction(retraction).run();
      ASSERT_TRUE(lift.status.ok) << lift.status.reason;
      EXPECT_LT(off(vehicle, lift, 10), 1e-10) << vehicle.name << " " << retraction;
    }
  }
  const Result literal =
      straight("skateboard", 2, 5).scheme("lift").step(0.01).retraction("cayley_literal").run();
  const double step = 2 / 0.03 * 0.01;  // a wheel's, short by step^3/48 + O(step^5)
  EXPECT_NEAR(off(kVehicles[0], literal, 10), 2 * 500 * std::pow(step, 3) / 48, 0.02);
}

/// Ten steps where the domain of exp on a circle, half a turn, had asked for hundreds.
TEST(Wheels, LeaveChosenStepsAsLongAsTheMotionAllows) {
  for (const Vehicle& vehicle : kVehicles) {
    const Result r =
        straight(vehicle.name, 2, 5).scheme("dop853").tolerance({.relative = 1e-8}).run();
    ASSERT_TRUE(r.status.ok) << r.status.reason;
    EXPECT_LT(r.steps + r.stats.rejected, 25) << vehicle.name;
    EXPECT_LT(off(vehicle, r, 10), 1e-7) << vehicle.name;
  }
}

// A frame whose lone root joint is on the ground, below the wheel's axle: least energy alone would
// pitch it.
Mechanism unicycle() {
  Mechanism m("unicycle");
  m.body("frame", {.mass = 10, .at = {0, 0, 0.9}, .inertia = {0.5, 0.5, 0.1}});
  m.body("wheel", {.mass = 1, .at = {0, 0, 0.3}, .cylinder = {0.3, 0.02}, .axis = {0, 1, 0}});
  m.free("space", "frame");
  m.hinge("axle", "frame", "wheel", {.at = {0, 0, 0.3}, .axis = {0, 1, 0}});
  m.wheel("wheel", "wheel", {.at = {0, 0, 0.3}, .radius = 0.3});
  return m;
}

TEST(StartsAtASpeed, DoNotTurnTheRootWhereTheRowsAllowIt) {
  const SystemModel own = unicycle().model();
  const std::vector<double> velocity = own.start_at_speed(2, 0).velocity;
  for (const int i : {0, 1, 2}) EXPECT_NEAR(velocity[static_cast<size_t>(i)], 0, 1e-12) << i;
  EXPECT_NEAR(velocity[3], 2, 1e-12);
  for (const char* name : {"bicycle", "skateboard", "unicycle_rider", "omni_robot"}) {
    const SystemModel system = model(name);
    const SystemStart start = system.start_at_speed(2, 0);
    const std::vector<Component> components = components_of(system);
    for (size_t i = 0; i < components.size(); ++i) {
      if (components[i].unit != "rad/s" || components[i].name.ends_with(".rate")) continue;
      EXPECT_NEAR(start.velocity[i], 0, 1e-12) << name << " " << components[i].name;
    }
    EXPECT_TRUE(start.notes.empty()) << name << ": " << start.notes.front();
    const hamel::Run run = simulate(name).speed(2).build();
    for (const std::string& note : run.notes())
      EXPECT_THAT(note, testing::Not(HasSubstr("root turns"))) << name;
  }
  const hamel::Run turning =
      simulate("kick_scooter").speed(2).build();  // its steering is at 0.3 rad
  EXPECT_THAT(turning.notes(), testing::Contains(HasSubstr("its root turns: omega = 0.8609")));
}

/// A push in the file is a motion to be seen; the steady motions are those without.
TEST(StartsAtASpeed, ArePushedWhereTheFileHasAPush) {
  const hamel::Run run = simulate("bicycle").speed(5).build();
  EXPECT_NEAR(run.config().start.velocity[0], 0.1, 1e-12);
  EXPECT_NEAR(run.config().start.velocity[3], 5, 1e-12);
  EXPECT_THAT(run.notes(), testing::Contains(HasSubstr("pushed, as the system's file has it: w1")));
  EXPECT_NEAR(model("bicycle").start_at_speed(5, 0).velocity[0], 0, 1e-12);
  Mechanism wrong = unicycle();
  wrong.push("w4", 1);
  EXPECT_THROW((void)wrong.model(), ConfigError);
}

/// Gravity that lifts: the contact pulls from the start on, and no value crosses zero.
TEST(ContactLost, IsMetAtTheStart) {
  Mechanism lifted = unicycle();
  lifted.gravity({0, 0, 3});
  registry().add(system_info(lifted));
  const Result stopped = simulate("unicycle").stop_at({"wheel.contact_lost"}).until(1).run();
  EXPECT_EQ(stopped.steps, 0);
  ASSERT_EQ(stopped.events.size(), 1u);
  EXPECT_EQ(stopped.events[0].time, 0);
  EXPECT_EQ(stopped.status.reason, "stopped at wheel.contact_lost");
  const Result seen =
      simulate("unicycle").events({"wheel.contact_lost"}).step(0.01).until(0.1).run();
  EXPECT_EQ(seen.events.size(), 1u);
  EXPECT_EQ(seen.steps, 10);
}

/// At rest all of a step is round-off, in which its rows are as large as it is: it is taken all the
/// same. (Upright at rest the bicycle is in equilibrium, though unstable.)
TEST(AtRest, EverySchemeStands) {
  for (const Vehicle& vehicle : kVehicles) {
    const std::vector<double> still(model(vehicle.name).mechanics->dim(), 0);
    for (const std::string scheme :
         {"lift", "balance", "reversible", "gni", "rkmk4", "rk4_projected", "dopri5", "dop853"}) {
      SCOPED_TRACE(vehicle.name + (" " + scheme));
      Simulation run = simulate(vehicle.name);
      run.start({.velocity = still}).scheme(scheme).until(0.1);
      for (const double step : {0.01, 0.001}) {
        const Result fixed = Simulation(run).step(step).run();
        EXPECT_TRUE(fixed) << step << ": " << fixed.status.reason;
        for (const double v : fixed.last.velocity) EXPECT_NEAR(v, 0, 1e-10) << step;
      }
      if (!scheme.starts_with("dop")) continue;
      const Result chosen = Simulation(run).tolerance({.relative = 1e-8}).run();
      EXPECT_TRUE(chosen) << chosen.status.reason;
      for (const double v : chosen.last.velocity) EXPECT_NEAR(v, 0, 1e-10);
    }
  }
}

}  // namespace
}  // namespace hamel
