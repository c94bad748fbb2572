// One driver: a run stepped by hand has the events, impacts, rows, files and measurements of one
// that runs to its end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <hamel/simulate.hpp>

#include "refusal.hpp"

namespace hamel {
namespace {

using testing::HasSubstr;

struct Case {
  const char* name;
  Simulation simulation;
};

// The pitch bounces at 0.1 rad.
void bounce(EventState& state) { state.velocity[5] = -0.8 * state.velocity[5]; }

std::vector<Case> cases() {
  Simulation lift = simulate("falling_disk").step(0.01).until(1).events({"z=0.48"});
  Simulation pair = simulate("chaplygin_sleigh").scheme("dop853").tolerance({1e-9}).until(3);
  Simulation segway = simulate("segway").step(0.001).until(1).every(7);
  return {{"every step, energy balance",
           simulate("segway").input("left_torque", 0.4).step(0.01).until(1).keep_rows(5000)},
          {"chosen steps", pair.keep_rows(5000)},
          {"output times", pair.output({0, 0.4, 1.1, 2.9})},
          {"events", lift.keep_rows(5000)},
          {"an impact between nodes", segway.on_event("2_theta=0.1", bounce).keep_rows(5000)},
          {"stops", simulate("chaplygin_sleigh").step(0.01).stop_at({"theta=1"}).keep_rows(5000)},
          {"an observer stops", simulate("chaplygin_sleigh")
                                    .step(0.01)
                                    .observe([](const Snapshot& s) { return s.time < 0.5; })
                                    .keep_rows(5000)}};
}

void expect_same(const Result& a, const Result& b) {
  ASSERT_EQ(a.trajectory.columns(), b.trajectory.columns());
  EXPECT_TRUE(std::ranges::equal(a.trajectory.values(), b.trajectory.values()));
  EXPECT_EQ(a.status.ok, b.status.ok);
  EXPECT_EQ(a.status.reason, b.status.reason);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.stats.evaluations, b.stats.evaluations);
  EXPECT_EQ(a.last.time, b.last.time);
  EXPECT_EQ(a.last.coordinates, b.last.coordinates);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (size_t i = 0; i < a.events.size(); ++i) {
    EXPECT_EQ(a.events[i].name, b.events[i].name);
    EXPECT_EQ(a.events[i].time, b.events[i].time);
  }
  Measurements::fields([&](const Quantity& quantity, const char*, auto member) {
    const double x = a.*member, y = b.*member;
    EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << quantity.name << x << " " << y;
  });
}

TEST(Driver, ByHandIsAsToTheEnd) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Result whole = c.simulation.run();
    hamel::Run run = c.simulation.build();
    const double until = c.simulation.config().until;
    if (c.simulation.config().chooses_steps()) {
      ASSERT_TRUE(run.advance_to(until));
    } else {
      while (run.state().time < until - 1e-9) {
        const Status status = run.step();
        ASSERT_TRUE(status) << status.reason;
        if (!status.reason.empty()) break;  // stopped
      }
    }
    const Result by_hand = run.finish();
    ASSERT_GT(whole.trajectory.rows(), 2u);
    // (An impact lies between nodes: by hand the last step may pass the end time by a part of a
    // step.)
    if (std::string(c.name) == "an impact between nodes") {
      ASSERT_GE(whole.events.size(), 1u);
      EXPECT_EQ(whole.events.size(), by_hand.events.size());
      EXPECT_EQ(whole.events[0].time, by_hand.events[0].time);
      continue;
    }
    expect_same(whole, by_hand);
  }
}

// Steps after advance_to() go on: its end is no limit of theirs.
TEST(Driver, StepsOnBehindATime) {
  hamel::Run run = simulate("suslov").scheme("dop853").tolerance({1e-8}).build();
  ASSERT_TRUE(run.advance_to(1));
  EXPECT_EQ(run.state().time, 1);
  ASSERT_TRUE(run.step());
  EXPECT_GT(run.state().time, 1);
}

TEST(Driver, StopsAndStaysAtAnEvent) {
  hamel::Run run = simulate("chaplygin_sleigh").step(0.01).stop_at({"theta=0.5"}).build();
  Status status;
  for (int k = 0; k < 1000 && status.reason.empty(); ++k) status = run.step();
  ASSERT_TRUE(status);
  EXPECT_EQ(status.reason, "stopped at theta=0.5");
  EXPECT_NEAR(run.state().coordinates[0], 0.5, 1e-10);
  const double at = run.state().time;
  EXPECT_EQ(run.step().reason, "stopped at theta=0.5");  // takes none
  EXPECT_EQ(run.state().time, at);
  EXPECT_EQ(run.finish().last.time, at);
}

TEST(Driver, RestartsWithRowsAndEvents) {
  Simulation made = simulate("chaplygin_sleigh").step(0.01).events({"theta=0.5"});
  hamel::Run again = made.keep_rows(1000).build(), fresh = made.build();
  ASSERT_TRUE(again.step(150));
  again.restart(again.config().start);
  ASSERT_TRUE(again.step(200));
  ASSERT_TRUE(fresh.step(200));
  expect_same(again.finish(), fresh.finish());
}

// A file of a run by hand has the rows of the file of a run to its end.
TEST(Driver, WritesFilesByHand) {
  const auto folder = std::filesystem::temp_directory_path() / "hamel_driver";
  std::filesystem::create_directories(folder);
  const auto rows = [](const std::filesystem::path& path) {
    std::ifstream in(path);
    std::ostringstream out;
    for (std::string line; std::getline(in, line);)
      if (!line.starts_with('#')) out << line << "\n";
    return out.str();
  };
  const std::string a = folder / "a.csv", b = folder / "b.csv";
  const Simulation made = simulate("suslov").step(0.01).until(2);
  (void)Simulation(made).record_to(a).run();
  hamel::Run run = Simulation(made).record_to(b).build();
  ASSERT_TRUE(run.step(200));
  EXPECT_FALSE(std::filesystem::exists(b));  // b.csv.part
  EXPECT_THAT(refusal([&] { run.restart(run.config().start); }), HasSubstr("rows"));
  (void)run.finish();
  EXPECT_EQ(rows(a), rows(b));
  EXPECT_GT(rows(a).size(), 10000u);
  std::filesystem::remove_all(folder);
}

// Without rows the ends are measured; what needs every node is not known, and the result notes
// that.
TEST(Driver, MeasuresTheEndsWithoutRows) {
  hamel::Run run = simulate("suslov").set("inertia", {2, 0.3, 0.5, 3, 0.4, 4}).step(0.05).build();
  ASSERT_TRUE(run.step(100));
  const Result free = run.finish();
  EXPECT_EQ(free.steps, 100);
  EXPECT_EQ(free.trajectory.rows(), 0u);
  EXPECT_GT(free.energy_error_max, 0);
  EXPECT_LT(free.exact_error_final, 0.1);
  EXPECT_GT(free.exact_error_final, 1e-12);
  EXPECT_TRUE(std::isnan(free.seconds));  // no clock is read between such steps
  EXPECT_THAT(free.record(), HasSubstr("\"seconds\": null"));
  hamel::Run forced = simulate("segway").input("left_torque", 1).step(0.01).build();
  ASSERT_TRUE(forced.step(20));
  const Result driven = forced.finish();
  EXPECT_TRUE(std::isnan(driven.energy_error_max));
  EXPECT_THAT(driven.notes, testing::Contains(HasSubstr("energy balance is not known")));
}

// A run that is moved from and let go, as user code does.
TEST(Driver, IsMoved) {
  std::vector<hamel::Run> runs;
  for (int k = 0; k < 3; ++k) runs.push_back(simulate("falling_disk").step(0.01).build());
  for (hamel::Run& run : runs) ASSERT_TRUE(run.step(3));
  runs[0] = std::move(runs[2]);
  EXPECT_TRUE(runs[0].step(2));
  EXPECT_EQ(runs[0].state().step, 5);
}

}  // namespace
}  // namespace hamel
