// Names and units of the components of xi, and the coordinates that are their integrals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/systems/rolling_disk.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace {

using namespace hamel;

TEST(Components, EverySystemHasOneNameForEachComponent) {
  for (const std::string& name : registry().systems()) {
    const SystemModel system = simulate(name).build().system();
    std::set<std::string> names;
    for (const Component& c : components_of(system)) {
      EXPECT_FALSE(c.name.empty()) << name;
      EXPECT_FALSE(c.unit.empty()) << name << ": " << c.name;
      EXPECT_TRUE(names.insert(c.name).second) << name << ": " << c.name << " twice";
    }
    EXPECT_EQ(names.size(), static_cast<size_t>(system.group.dim)) << name;
  }
}

TEST(Components, ThoseOfAProductAreToldApart) {
  const auto names = [](const std::string& system) {
    std::string out;
    for (const Component& c : components_of(simulate(system).build().system().group))
      out += c.name + " ";
    return out;
  };
  EXPECT_EQ(names("rolling_ball"), "omega1 omega2 omega3 x' y' ");
  EXPECT_EQ(names("differential_drive"), "omega v1 v2 angle_2' angle_3' ");
}

TEST(Components, UnitsOfTheElement) {
  for (const std::string& name : registry().systems()) {
    const GroupInfo group = simulate(name).build().system().group;
    EXPECT_EQ(units_of_element(group).size(), group.columns.size()) << name;
  }
  const auto units = [](const std::string& system) {
    return units_of_element(simulate(system).build().system().group);
  };
  std::vector<std::string> ball(9), disk(9);  // rotations have no units
  ball.insert(ball.end(), {"m", "m"});
  disk.insert(disk.end(), {"m", "m", "m"});
  EXPECT_EQ(units("rolling_ball"), ball);
  EXPECT_EQ(units("falling_disk"), disk);
  EXPECT_EQ(units("differential_drive"), (std::vector<std::string>{"rad", "m", "m", "rad", "rad"}));
}

TEST(Components, BySystemsThatNameTheirShape) {
  const auto names = [](const std::string& system) {
    std::string out;
    for (const Component& c : components_of(simulate(system).build().system())) out += c.name + " ";
    return out;
  };
  EXPECT_EQ(names("segway"), "omega v1 v2 right' left' pitch' ");
  EXPECT_EQ(names("n_trailer"), "omega v1 v2 hitch1' hitch2' hitch3' ");
  EXPECT_EQ(names("suslov"), "omega1 omega2 omega3 ");
}

struct TooManyNames : RollingDisk {
  static std::vector<std::string> shape() { return {"roll", "yaw"}; }
};
TEST(Components, AWrongShapeIsRefusedBeforeTheRun) {
  try {
    simulate(TooManyNames()).build();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("shape of rolling_disk: expected 1 names, got 2"));
  }
}

// A shape coordinate is the integral of its component: over one small step of the exact flow of the segway's
// wheels, theta(h) - theta(0) = h theta' + O(h^2).
TEST(Components, ShapeCoordinatesAreIntegrals) {
  const Result run = simulate("segway").step(1e-4).until(1e-4).run();
  const auto shape = shape_of(run.system->group, components_of(run.system->group));
  ASSERT_EQ(shape.size(), 3);
  EXPECT_EQ(shape[2].name, "angle_4");
  EXPECT_EQ(shape[2].unit, "rad");
  for (const ShapeCoordinate& s : shape) {
    const auto column = static_cast<size_t>(s.column) + 1;
    const double moved = run.trajectory.at(1, column) - run.trajectory.at(0, column);
    const double rate = run.trajectory.column("xi" + std::to_string(s.component + 1))[0];
    EXPECT_NEAR(moved / 1e-4, rate, 1e-2) << s.name;
  }
}

}  // namespace
