// One name for each coordinate and velocity of every system, in files, descriptions, events and
// ensembles; the names of earlier releases are read as well.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/mechanics/quantities.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/data/event_formula.hpp>
#include <hamel/systems/by_text.hpp>
#include <hamel/systems/hamel.hpp>

namespace {

using namespace hamel;
using Names = std::vector<std::string>;

Names cells(const std::string& line) {
  Names out;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
  return out;
}

Names all_of(const SystemModel& model) { return QuantityNames(model).all(); }

// One row of a system, and its names.
struct Ran {
  Result result;
  const SystemModel& model() const { return *result.system; }
  double value(const std::string& name) const {
    return result.trajectory.at(0, result.trajectory.index(name));
  }
};
Ran ran(const std::string& system) { return {simulate(system).step(0.01).until(0.01).run()}; }

TEST(QuantityNames, AreTheColumnsOfEveryFile) {
  const std::string path =
      std::filesystem::path(testing::TempDir()) / fmt::format("names_{}.csv", getpid());
  for (const std::string& system : systems()) {
    SCOPED_TRACE(system);
    const Ran run = ran(system);
    run.result.write(path);
    std::string head;
    std::ifstream file(path);
    std::getline(file, head);
    const Names columns = cells(head), names = all_of(run.model());
    EXPECT_EQ(std::set<std::string>(columns.begin(), columns.end()).size(), columns.size()) << head;
    ASSERT_GT(columns.size(), names.size());
    EXPECT_EQ(Names(columns.begin() + 1, columns.begin() + 1 + std::ssize(names)), names);
    EXPECT_EQ(run.result.trajectory.columns(), columns);

    Names described = describe_model(run.model()).coordinates;
    for (const std::string& name : describe_model(run.model()).velocities)
      described.push_back(name);
    EXPECT_EQ(described, names);
  }
  std::filesystem::remove(path);
}

TEST(QuantityNames, OthersAreReadWhereverANameIs) {
  for (const std::string& system : systems()) {
    SCOPED_TRACE(system);
    const Ran run = ran(system);
    const SystemModel& model = run.model();
    const Names names = all_of(model);
    EnsembleConfig config;
    config.run.system = system;
    config.run.step = 0.01;
    config.run.until = 0.01;
    config.members = 1;
    const auto keep = [&](const std::string& name) {
      if (name.find(' ') == std::string::npos)  // of a joint: not in formulas
        config.keep.push_back({"", "start." + name});
    };
    for (const std::string& name : names) keep(name);
    for (const auto& [other, place] : model.other_names) {
      EXPECT_EQ(run.result.trajectory.index(other), 1 + place) << other;
      keep(other);
    }
    const EnsembleResult ensemble = Ensemble(registry(), config).run();
    for (const Kept& kept : config.keep) {
      const std::string name = kept.formula.substr(6);
      // A member's start is projected once more, which moves it by round-off.
      EXPECT_NEAR(ensemble.moments.at(kept.formula).mean, run.value(name), 1e-12) << name;
      std::vector<std::string> mistakes;
      const auto event = event_of_formula(model, name + " = 0", mistakes);
      ASSERT_TRUE(event) << name << ": " << testing::PrintToString(mistakes);
      const Snapshot& last = run.result.last;
      const size_t row = run.result.trajectory.rows() - 1;
      EXPECT_EQ(event->value(last.time, last.coordinates, last.velocity),
                run.result.trajectory.at(row, run.result.trajectory.index(name)))
          << name;
    }
  }
}

TEST(QuantityNames, OfEarlierReleases) {
  const auto place = [](const std::string& system, const std::string& name) {
    const SystemModel model = simulate(system).build().system();
    const auto found = QuantityNames(model).find(name);
    return found ? all_of(model)[*found] : "";
  };
  for (const char* name : {"4_theta", "theta_4", "angle_4"})
    EXPECT_EQ(place("segway", name), "pitch");
  for (const char* name : {"angle_4'", "theta_4'", "xi6", "pitch'"})
    EXPECT_EQ(place("segway", name), "pitch'");
  for (const char* name : {"1_x", "x_1"}) EXPECT_EQ(place("segway", name), "x");
  for (const char* name : {"2_x1", "x1_2", "x"}) EXPECT_EQ(place("rolling_ball", name), "x");
  EXPECT_EQ(place("rolling_ball", "1_R33"), "R33");
  EXPECT_EQ(place("nonholonomic_particle", "y'"), "x2'");
  EXPECT_EQ(place("bicycle", "xi7"), "steer.rate");
  EXPECT_EQ(place("bicycle", "4_theta"), "");
}

// Products of up to five groups, their shape with names that others have, too.
TEST(QuantityNames, OfProductsOfGroups) {
  const Names groups = {"so2", "so3", "se2", "se3", "r1", "r2", "r3", "heisenberg"};
  const Names words = {"x", "x1", "theta", "energy", "mass", "t", "mu1", "xi2", "pitch", "roll"};
  std::mt19937 random(3);
  const auto any = [&](const Names& of) { return of[random() % of.size()]; };
  for (int n = 0; n < 1000; ++n) {
    SystemModel model;
    std::string group = any(groups);
    for (auto more = random() % 5; more > 0; --more) group += "*" + any(groups);
    model.name = "random";
    model.group = *registry().group_or_product(group);
    const GroupInfo plain = model.group;
    for (auto more = random() % 3; more > 0; --more)
      model.fields.push_back({any(words), {1}, "", "", {}});
    size_t shape = 0;
    for (const GroupFactor& factor : model.group.factors)
      if (factor.is_shape) shape += static_cast<size_t>(factor.dim);
    if (random() % 2 == 0)
      for (size_t i = 0; i < shape; ++i) model.shape.push_back(any(words));
    name_quantities(model);

    SCOPED_TRACE(group + ": " + testing::PrintToString(model.shape));
    const Names names = all_of(model);
    std::set<std::string> columns(names.begin(), names.end());
    ASSERT_EQ(columns.size(), names.size()) << testing::PrintToString(names);
    for (const Quantity& quantity : kMeasuredColumns)
      EXPECT_FALSE(columns.contains(quantity.name)) << quantity.name;
    EXPECT_FALSE(columns.contains("mu1"));
    const QuantityNames resolver(model);
    for (size_t i = 0; i < names.size(); ++i) {
      EXPECT_EQ(resolver.find(names[i]), i);
      EXPECT_EQ(resolver.in_formula("2*(" + names[i] + ")"),
                "2*(" + resolver.variables()[1 + i] + ")");
      EXPECT_TRUE(Expression::allows(resolver.variables()[1 + i])) << names[i];
    }
    for (int i = 0; i < model.group.dim; ++i) {
      const std::string number = fmt::format("xi{}", i + 1);
      const size_t velocity = model.group.columns.size() + static_cast<size_t>(i);
      EXPECT_TRUE(resolver.find(number) == velocity || columns.contains(number)) << number;
    }
    if (plain.factors.size() == 1) continue;
    size_t at = 0;
    for (size_t f = 1; f <= plain.factors.size(); ++f) {
      for (const std::string& own : plain.factors[f - 1].names) {
        EXPECT_EQ(resolver.find(fmt::format("{}_{}", f, own)), at);
        EXPECT_EQ(resolver.find(fmt::format("{}_{}", own, f)), at++);
      }
    }
  }
}

// A parameter, an input and a measured column keep their names, and a note has the other one.
TEST(QuantityNames, ThatSomethingElseHas) {
  const SystemModel model = data_system(registry(), R"toml(
group = "se2*so2"
inertia = [1, "m", "m", 1]
potential = "energy + work"
coordinates = ["theta", "energy", "y", "work"]
rates = ["omega", "v1", "mu2", "spin"]
[parameters]
m = 1
)toml",
                                        "own.toml");
  EXPECT_EQ(model.group.columns, (Names{"theta", "1_x", "y", "2_theta"}));
  EXPECT_EQ(model.rates, (Names{"omega", "v1", "xi3", "spin"}));
  EXPECT_EQ(model.notes.size(), 3u);
  EXPECT_EQ(QuantityNames(model).find("energy"), 1u);
}

// Files written for the names of earlier releases: a parameter x, and x_1 for the coordinate.
TEST(QuantityNames, OfAFileOfAnEarlierRelease) {
  const SystemModel model = data_system(registry(), R"toml(
group = "se2*so2"
inertia = [1, 2, 2, 1]
potential = "x*x_1^2 + theta_2"
force = [0, "-omega", 0, "-theta_2' - xi2"]
[parameters]
x = 3
)toml",
                                        "own.toml");
  EXPECT_EQ(model.group.columns, (Names{"1_theta", "1_x", "y", "2_theta"}));
  EXPECT_EQ(model.rates, (Names{"omega", "v1", "v2", "2_theta'"}));
  const auto geometry = registry().geometry("se2*so2", "exp");
  std::vector<double> g(static_cast<size_t>(geometry->size()));
  geometry->from_coordinates({{0, 2, 0, 0.5}}, g.data());
  EXPECT_DOUBLE_EQ(model.mechanics->potential(g.data()), 12.5);
}

}  // namespace
