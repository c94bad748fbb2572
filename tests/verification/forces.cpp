// Where lift takes the forces (M43): half of them at each node, or all at the base point.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <hamel/hamel.hpp>

#include "../framework/distances.hpp"

namespace {

using namespace hamel;
using hamel::test::distance;

const char* const kPlaces[] = {"nodes", "base"};
/// Those with a potential or a force.
const char* const kForced[] = {"contact_oscillator",    "falling_disk", "knife_edge_on_incline",
                               "nonholonomic_particle", "rattleback",   "roller_racer",
                               "routh_sphere",          "segway",       "suslov_in_potential"};

Result run(const std::string& system, const Start& start, const char* place, double step,
           double until) {
  Simulation simulation = simulate(system);
  if (!start.velocity.empty()) simulation.start(start);
  return simulation.with(&Config::force_at, std::string(place)).step(step).until(until).run();
}

/// A blade that slides straight down the slope: at the base point the force across it leaves a
/// moment of O(h^2) in every step, and it turns. The stored angles are those of the program before
/// the nodes.
TEST(Forces, ABladeSlidesStraightWithForcesAtTheNodes) {
  const Start down = {.configuration = {0.3, 0, 0}, .velocity = {0, 1, 0}};
  const double turned[] = {-0.049, -0.0148, -0.0039};
  double step = 0.02;
  for (const double angle : turned) {
    EXPECT_NEAR(run("knife_edge_on_incline", down, "nodes", step, 10).last.coordinates[0], 0.3,
                1e-14);
    EXPECT_NEAR(run("knife_edge_on_incline", down, "base", step, 10).last.coordinates[0] - 0.3,
                angle, 6e-4);
    step /= 2;
  }
}

TEST(Forces, OrderTwoAtEitherPlace) {
  for (const char* system : kForced) {
    for (const char* place : kPlaces) {
      // The reference: composed to order 6 with an eighth of the step.
      const double h = 0.01, until = 0.4;
      const Result reference = simulate(system).compose("kahan_li6").step(h / 8).until(until).run();
      const double coarse = distance(run(system, {}, place, h, until), reference);
      const double fine = distance(run(system, {}, place, h / 2, until), reference);
      EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1)
          << system << ", " << place << ": " << coarse << ", " << fine;
    }
  }
}

TEST(Forces, ReversibleAtEitherPlace) {
  for (const char* system : kForced) {
    for (const char* place : kPlaces) {
      const Result there = run(system, {}, place, 0.01, 0.2);
      const Start end = {.configuration = there.last.coordinates, .velocity = there.last.velocity};
      const Result back = simulate(system)
                              .start(end)
                              .with(&Config::force_at, std::string(place))
                              .with(&Config::from, there.last.time)
                              .step(-0.01)
                              .until(0)
                              .run();
      const auto start = there.trajectory.row(0);
      for (size_t i = 0; i < back.last.coordinates.size(); ++i) {
        EXPECT_NEAR(back.last.coordinates[i], start[1 + i], 1e-11) << system << ", " << place;
      }
    }
  }
}

/// Constant inertia and rows: order 2 at every s, as without forces; at the base point 1.
TEST(Forces, AtTheNodesTheOrderDoesNotDependOnS) {
  const SystemModel model = registry().system("suslov_in_potential")->make({});
  const SchemeInfo& lift = *registry().scheme("lift");
  const Result reference =
      simulate("suslov_in_potential").compose("kahan_li6").step(0.00125).until(0.4).run();
  for (const char* place : kPlaces) {
    const auto error = [&](double h) {
      return distance(simulate("suslov_in_potential")
                          .s(0.2)
                          .with(&Config::force_at, std::string(place))
                          .step(h)
                          .until(0.4)
                          .run(),
                      reference);
    };
    const int claimed = lift.claim(0.2, {true, true}, *model.mechanics, place).order;
    EXPECT_EQ(claimed, std::string(place) == "nodes" ? 2 : 1);
    EXPECT_NEAR(std::log2(error(0.005) / error(0.0025)), claimed, 0.15) << place;
  }
}

TEST(Forces, AnOptionOfLiftOnly) {
  const std::string base = "base";
  const Result balance =
      simulate("falling_disk").scheme("balance").with(&Config::force_at, base).until(0.1).run();
  EXPECT_THAT(balance.notes, testing::Contains("force_at is not used by balance"));
  EXPECT_NE(balance.record().find("\"force_at\": null"), std::string::npos);
  const Result lift =
      simulate("falling_disk").with(&Config::force_at, base).step(0.01).until(0.1).run();
  EXPECT_NE(lift.record().find("\"force_at\": \"base\""), std::string::npos);
  const Result unnamed = simulate("falling_disk").scheme("balance").until(0.1).run();
  EXPECT_THAT(unnamed.notes, testing::Not(testing::Contains(testing::HasSubstr("is not used"))));
  EXPECT_EQ(
      simulate("falling_disk").with(&Config::force_at, std::string("noods")).mistakes().size(), 1u);
}

}  // namespace
