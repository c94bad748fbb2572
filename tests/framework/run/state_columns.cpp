// Numbers of a state by name, and states of which only some parts are wanted.
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <hamel/hamel.hpp>

#include <hamel/framework/run/record/state_columns.hpp>

namespace {

using namespace hamel;

// Systems with rows, without, by parts, with holonomic ones, where work is done.
const char* const systems[] = {"suslov", "falling_disk", "bicycle", "snakeboard", "segway"};

TEST(StateColumns, AreThoseOfRows) {
  for (const char* name : systems) {
    auto run = simulate(name).step(0.01).until(0.1).every(1).keep_rows(0).build();
    const SystemModel model = run.system();
    const StateColumns columns(
        model, {.holonomic = model.mechanics->holonomic_rows() > 0,
                .work = model.mechanics->has_force() || model.mechanics->has_drift(),
                .reactions = model.mechanics->constraint_count() > 0,
                .reaction_power = model.mechanics->constraint_count() > 0,
                .exact = static_cast<bool>(model.exact)});
    ASSERT_TRUE(run.step(10).ok);
    const Snapshot state = run.state();
    const Trajectory rows = run.finish().trajectory;
    ASSERT_EQ(columns.size(), rows.columns().size()) << name;
    for (size_t i = 0; i < columns.size(); ++i) {
      using Of = StateColumns::Of;
      EXPECT_EQ(columns.name(i), rows.columns()[i]) << name;
      const Of of = columns.of(i);
      if (of == Of::energy_error || of == Of::work || of == Of::reaction ||
          of == Of::reaction_power || of == Of::exact_error || of == Of::exact_velocity_error)
        continue;  // not of the state alone
      EXPECT_EQ(columns.value(i, state, {}), rows.at(rows.rows() - 1, i))
          << name << " " << columns.name(i);
    }
  }
}

TEST(StateColumns, ReactionsOfOnePartAreTogether) {
  const SystemModel model = *simulate("bicycle").system();
  const StateColumns columns(model, {.reactions = true});
  const Eigen::Index rows = model.mechanics->constraint_count();
  std::vector<double> lambda;
  for (Eigen::Index i = 0; i < rows; ++i) lambda.push_back(static_cast<double>(i));
  const size_t first = *columns.find(StateColumns::Of::reaction);
  std::string before;
  std::vector<std::string> parts;
  for (size_t i = first; i < first + lambda.size(); ++i) {
    const auto row = static_cast<size_t>(columns.value(i, {}, {.reactions = lambda}));
    EXPECT_EQ(columns.name(i), model.reactions.at(row));
    const std::string part = columns.name(i).substr(0, columns.name(i).rfind('.'));
    if (part != before) parts.push_back(part);
    before = part;
  }
  EXPECT_EQ(std::set<std::string>(parts.begin(), parts.end()).size(), parts.size());
}

TEST(StateParts, AreThoseOfTheWholeState) {
  for (const char* name : systems) {
    for (const char* scheme : {"lift", "dop853"}) {
      auto run = simulate(name).scheme(scheme).step(0.01).until(1).build();
      ASSERT_TRUE(run.step(3).ok);
      const Snapshot all = run.state();
      for (const bool coordinates : {false, true}) {
        for (const bool energy : {false, true}) {
          const Snapshot part = run.state({.coordinates = coordinates,
                                           .element = coordinates,
                                           .momentum = !energy,
                                           .energy = energy,
                                           .measures = false});
          EXPECT_EQ(part.time, all.time);
          EXPECT_EQ(part.velocity, all.velocity) << name;
          EXPECT_EQ(part.coordinates, coordinates ? all.coordinates : std::vector<double>());
          EXPECT_EQ(part.element, coordinates ? all.element : std::vector<double>());
          EXPECT_EQ(part.momentum, energy ? std::vector<double>() : all.momentum);
          EXPECT_EQ(energy ? part.energy : all.energy, all.energy);
        }
      }
      const Snapshot measured =
          run.state({.coordinates = false, .element = false, .momentum = false, .energy = false});
      EXPECT_EQ(measured.constraint, all.constraint) << name;
      EXPECT_EQ(measured.group_defect, all.group_defect);
      EXPECT_EQ(run.state().coordinates, all.coordinates) << "nothing was lost";
    }
  }
}

int potentials = 0;

struct Counted {
  using Group = Rn<3>;
  static std::string name() { return "counted"; }
  static Mat<3, 3> inertia() { return Vec<3>(1, 2, 3).asDiagonal(); }
  static Mat<1, 3> constraints() { return Mat<1, 3>{{0.1, 0, 1}}; }
  static double potential(const Vec<3>& q) {
    ++potentials;
    return q[0];
  }
  static Vec<3> potential_differential(const Vec<3>& /*q*/) { return {1, 0, 0}; }
  static Start start() { return {.velocity = {1, 1, -0.1}}; }
};

TEST(StateParts, ThatAreNotWantedAreNotComputed) {
  auto run = simulate(Counted{}).scheme("lift").step(0.01).build();
  ASSERT_TRUE(run.step().ok);
  potentials = 0;
  EXPECT_EQ(run.state({.energy = false, .measures = false}).coordinates.size(), 3u);
  EXPECT_EQ(potentials, 0);
  EXPECT_TRUE(std::isfinite(run.state().energy));
  EXPECT_EQ(potentials, 1);
}

}  // namespace
