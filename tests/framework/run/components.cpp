// Names and units of the components of xi, and the coordinates that are their integrals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include <fmt/ranges.h>

#include <hamel/framework/lie/group_defaults.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/groups/heisenberg.hpp>
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
  const auto names = [](const std::string& group) {
    SystemModel model;
    model.group = *registry().group_or_product(group);
    name_quantities(model);
    return fmt::format("{} | {}", fmt::join(model.group.columns, " "), fmt::join(model.rates, " "));
  };
  EXPECT_EQ(names("se2*r2"), "theta x y x1 x2 | omega v1 v2 x1' x2'");
  EXPECT_EQ(names("se2*so2*so2"), "1_theta x y 2_theta 3_theta | omega v1 v2 2_theta' 3_theta'");
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

// A shape coordinate is the integral of its component: over one small step of the exact flow of the
// segway's wheels, theta(h) - theta(0) = h theta' + O(h^2).
TEST(Components, ShapeCoordinatesAreIntegrals) {
  const Result run = simulate("segway").step(1e-4).until(1e-4).run();
  const auto shape = shape_of(run.system->group);
  ASSERT_EQ(shape.size(), 3);
  EXPECT_EQ(shape[2].name, "pitch");
  EXPECT_EQ(shape[2].unit, "rad");
  for (const ShapeCoordinate& s : shape) {
    const auto column = static_cast<size_t>(s.column) + 1;
    const double moved = run.trajectory.at(1, column) - run.trajectory.at(0, column);
    const double rate = run.trajectory.column("xi" + std::to_string(s.component + 1))[0];
    EXPECT_NEAR(moved / 1e-4, rate, 1e-2) << s.name;
  }
}

// A group of a user's own: Heisenberg's in place and velocity of other names, or of none.
struct OwnExp;
template <class Own>
struct OwnGroup : GroupDefaults<Own, 3> {
  template <class T>
  using Element = VecT<T, 3>;
  using Retractions = TypeList<OwnExp>;
  template <class T = double>
  static Element<T> identity() {
    return Element<T>::Zero();
  }
  static Vec<3> compose(const Vec<3>& g, const Vec<3>& h) { return Heisenberg::compose(g, h); }
  static Vec<3> inverse(const Vec<3>& g) { return -g; }
  static Mat<3, 3> ad(const Vec<3>& xi) { return Heisenberg::ad(xi); }
  static Mat<3, 3> Ad(const Vec<3>& g) { return Heisenberg::Ad(g); }
};
struct Named : OwnGroup<Named> {
  static std::string name() { return "named"; }
  static std::vector<std::string> columns() { return {"east", "north", "height"}; }
  static std::vector<std::string> units() { return {"m", "m", "m2"}; }
  static std::vector<Component> components() {
    return {{"eastwards", "m/s"}, {"northwards", "m/s"}, {"upwards", "m2/s"}};
  }
  static void coordinate_rates(std::span<const double> x, std::span<const double> xi,
                               std::span<double> out) {
    Heisenberg::coordinate_rates(x, xi, out);
  }
  static void add_pulled_back(std::span<const double> x, std::span<const double> slope,
                              std::span<double> out) {
    Heisenberg::add_pulled_back(x, slope, out);
  }
};
struct Nameless : OwnGroup<Nameless> {
  static std::string name() { return "nameless"; }
};
struct OwnExp : RetractionDefaults<OwnExp, Named> {
  static constexpr bool symmetric = true, one_parameter = true;
  static std::string name() { return "exp"; }
  static Vec<3> tau(const Vec<3>& xi) { return xi; }
  static Vec<3> tau_inverse(const Vec<3>& g) { return g; }
  static Mat<3, 3> dtau_right_inverse(const Vec<3>& xi) {
    return Mat<3, 3>::Identity() - 0.5 * Heisenberg::ad(xi);
  }
  static Mat<3, 3> dtau_right_inverse_transpose_derivative(const Vec<3>&, const Vec<3>& p) {
    return -0.5 * Heisenberg::coad(p);
  }
};
struct Particle {
  using Group = Named;
  Mat<3, 3> inertia() const { return Mat<3, 3>::Identity(); }
};

std::string names_of(const std::vector<Component>& components) {
  std::string out;
  for (const Component& c : components) out += c.name + " [" + c.unit + "] ";
  return out;
}

TEST(Components, OfAGroupOfAUsersOwn) {
  add_group<Named>(registry());
  const Result run =
      simulate(Particle{}).start({.velocity = {1, 0.5, 0.2}}).retraction("exp").until(1).run();
  ASSERT_TRUE(run);
  const std::string names = "eastwards [m/s] northwards [m/s] upwards [m2/s] ";
  EXPECT_EQ(names_of(components_of(*run.system)), names);
  const std::vector<ColumnGroup>& columns = run.trajectory.groups();
  const auto group = [&](const std::string& name) {
    return *std::ranges::find_if(columns, [&](const auto& g) { return g.name == name; });
  };
  EXPECT_EQ(group("configuration").unit, "m,m,m2");
  EXPECT_EQ(group("xi").columns, (std::vector<std::string>{"eastwards", "northwards", "upwards"}));
  EXPECT_EQ(group("xi").unit, "m/s,m/s,m2/s");
  EXPECT_TRUE(shape_of(run.system->group).empty());

  const auto names_in = [](GroupInfo group_of_model) {
    SystemModel model;
    model.group = std::move(group_of_model);
    name_quantities(model);
    return names_of(components_of(model));
  };
  EXPECT_EQ(names_in(group_info<Nameless>()), "xi1 [] xi2 [] xi3 [] ");
  EXPECT_EQ(names_in(group_info<Product<Rn<1>, Nameless, Rn<1>>>()),
            "1_x1' [m/s] xi2 [] xi3 [] xi4 [] 3_x1' [m/s] ");
}

/// By these names in formulas: m g h of a height above a slope, damped eastwards.
TEST(Components, OfAGroupOfAUsersOwnInFormulas) {
  add_group<Named>(registry());
  const SystemModel model = data_system(registry(), R"toml(
group = "named*so2"
coordinates = ["east", "north", "height", "roll"]
inertia = [1, 1, 1, 2]
constraints = [["north", 0, 1, 0.5]]
potential = "height*east"
force = ["-0.1*eastwards", 0, 0, "-roll'"]
)toml",
                                        "own.toml");
  EXPECT_EQ(names_of(components_of(model)),
            "eastwards [m/s] northwards [m/s] upwards [m2/s] roll' [rad/s] ");
  const auto geometry = registry().geometry("named*so2", "exp");
  const std::vector<double> at = {2, 3, 5, 0.4};
  const Eigen::VectorXd xi = Eigen::Vector4d(1, -1, 0.5, 2);
  std::vector<double> g(static_cast<size_t>(geometry->size()));
  geometry->from_coordinates(at, g.data());
  Eigen::VectorXd force(4), rows(1), momentum(4);
  model.mechanics->force(0, g.data(), xi, force);
  // -C^T (height, 0, east, 0), C as of Heisenberg's group, and the damping.
  EXPECT_TRUE(force.isApprox(Eigen::Vector4d(-5 + 3 - 0.1, -2, -2, -2), 1e-14)) << force;
  // The rate of the row is exact: north' = -1.
  ASSERT_TRUE(model.mechanics->exact_rates());
  model.mechanics->rates(*geometry, 0, g.data(), xi, rows, momentum);
  EXPECT_NEAR(rows[0], 1, 1e-15);
}

struct TooFewUnits : OwnGroup<TooFewUnits> {
  static std::string name() { return "too_few"; }
  static std::vector<std::string> units() { return {"m"}; }
};
TEST(Components, AWrongNumberOfUnitsIsRefused) {
  try {
    group_info<TooFewUnits>();
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "too_few: units: 1 entries, expected 3");
  }
}

}  // namespace
