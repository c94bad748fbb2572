// Poincare sections: points against closed forms, one energy for all starts, mistakes.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <hamel/framework/analysis/section.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/systems/by_name.hpp>

namespace hamel {
namespace {

const std::vector<double>& numbers(const Section& section, const std::string& column) {
  return std::get<std::vector<double>>(section.points.column(column).values);
}

// A particle of unit mass between springs of stiffness k along x and y, without rows: x and y
// oscillate by themselves, so that the points x = 0, x' > 0 are known in closed form.
std::string two_oscillators() {
  const std::string path = testing::TempDir() + "two_oscillators.toml";
  std::ofstream(path) << R"(name = "two_oscillators"
group = "r2"
coordinates = ["x", "y"]
inertia = [1, 1]
potential = "0.5*x^2 + 0.5*k*y^2"
configuration = [0.3, 0.4]
velocity = [0.5, -0.2]
[parameters]
k = { value = 2 }
)";
  return path;
}

// x = a sin(t + p), y = b sin(w t + q): at x = 0 upwards t = 2 pi n - p.
TEST(Section, PointsAreThoseOfTheClosedForm) {
  Simulation simulation = simulate(two_oscillators()).tolerance({.relative = 1e-12});
  const Section section = hamel::section(simulation, {.event = "x=0", .direction = 1, .count = 50});
  ASSERT_TRUE(section.complete);
  ASSERT_EQ(section.points.rows(), 50u);
  const double p = std::atan2(0.3, 0.5), w = std::sqrt(2.0), q = std::atan2(0.4 * w, -0.2),
               b = std::hypot(0.4, 0.2 / w), a = std::hypot(0.3, 0.5);
  for (size_t n = 0; n < 50; ++n) {
    const double t = 2 * M_PI * static_cast<double>(n + 1) - p;
    EXPECT_NEAR(numbers(section, "t")[n], t, 1e-8) << n;
    EXPECT_NEAR(numbers(section, "x")[n], 0, 1e-9) << n;
    EXPECT_NEAR(numbers(section, "y")[n], b * std::sin(w * t + q), 1e-8) << n;
    EXPECT_NEAR(numbers(section, "xi1")[n], a, 1e-8) << n;
    EXPECT_NEAR(numbers(section, "xi2")[n], b * w * std::cos(w * t + q), 1e-8) << n;
  }
  EXPECT_LT(section.orbits.front().energy_change, 1e-9);
}

TEST(Section, TheDirectionSelectsCrossings) {
  Simulation simulation = simulate(two_oscillators()).tolerance({.relative = 1e-12});
  const auto first = [&](int direction) {
    return numbers(hamel::section(simulation, {.event = "x=0", .direction = direction, .count = 2}),
                   "xi1");
  };
  EXPECT_GT(first(1)[0], 0);
  EXPECT_LT(first(-1)[0], 0);
  EXPECT_LT(first(-1)[1], 0);
  EXPECT_LT(first(0)[0] * first(0)[1], 0);
}

TEST(Section, StartsOfOneEnergy) {
  Simulation simulation = simulate(two_oscillators());
  SectionRequest request{.event = "x=0", .direction = 1, .count = 3};
  for (const double v : {0.1, 0.7, 1.3})
    request.starts.push_back({.configuration = {0.1, 0.2}, .velocity = {v, 1 - v}, .momentum = {}});
  request.energy = 0.8;
  const Section section = hamel::section(simulation, request);
  ASSERT_EQ(section.orbits.size(), 3u);
  for (const SectionOrbit& orbit : section.orbits) {
    EXPECT_NEAR(orbit.energy, 0.8, 1e-12);
    EXPECT_EQ(orbit.found, 3);
  }
  EXPECT_EQ(section.points.rows(), 9u);
  request.energy = 0.01;  // below the potential energy
  EXPECT_THROW(hamel::section(simulation, request), ConfigError);
}

// The integrals of Routh's sphere hold at every point of its section.
TEST(Section, KeepsWhatTheMotionKeeps) {
  Simulation simulation = simulate("routh_sphere").tolerance({.relative = 1e-11});
  const Section section =
      hamel::section(simulation, {.event = "R33=0.9", .direction = 0, .count = 40, .longest = 500});
  EXPECT_LT(section.orbits.front().energy_change, 1e-7);
  for (const double r33 : numbers(section, "1_R33")) EXPECT_NEAR(r33, 0.9, 1e-9);
}

TEST(Section, WrittenStartsAreRead) {
  Simulation simulation = simulate(two_oscillators()).tolerance({.relative = 1e-12});
  const Section section = hamel::section(simulation, {.event = "x=0", .count = 3});
  const std::string path = testing::TempDir() + "points.csv";
  std::ofstream(path) << section.points.csv();
  const std::vector<Start> starts = read_starts(path, registry(), simulation.config());
  ASSERT_EQ(starts.size(), 3u);
  EXPECT_EQ(starts[2].configuration[1], numbers(section, "y")[2]);
  EXPECT_EQ(starts[2].velocity[0], numbers(section, "xi1")[2]);
  std::ofstream(path) << "x,y,xi1\n1,2,3\n";
  EXPECT_THROW(read_starts(path, registry(), simulation.config()), ConfigError);
}

/// Through impacts: a ball that bounces, by the times at which it is highest, of flights that are e
/// times as long each.
TEST(Section, GoesThroughImpacts) {
  const double e = 0.8, g = 9.81, w = 3;
  Simulation ball = simulate("rolling_ball")
                        .set("friction", 0.2)
                        .set("restitution", e)
                        .start({.velocity = {0, 0, 0, 0, 0, w}})
                        .slip()
                        .tolerance({.relative = 1e-10});
  const Section section = hamel::section(ball, {.event = "z'=0", .direction = -1, .count = 5});
  ASSERT_EQ(section.points.rows(), 5u);
  double before = 0, up = w;
  for (size_t n = 0; n < 5; ++n) {
    EXPECT_NEAR(numbers(section, "t")[n], before + up / g, 1e-8);
    before += 2 * up / g;
    up *= e;
  }
}

TEST(Section, MistakesAreRefused) {
  Simulation simulation = simulate("rattleback");
  EXPECT_THROW(hamel::section(simulation, {.event = "revresed"}), ConfigError);
  EXPECT_THROW(hamel::section(simulation, {.event = "reversed", .count = 0}), ConfigError);
  EXPECT_THROW(hamel::section(simulation, {.event = "reversed", .direction = 2}), ConfigError);
  EXPECT_THROW(hamel::section(simulation, {.event = "contact_lost", .direction = 1}), ConfigError);
}

TEST(Section, AStartThatDoesNotCrossIsGivenUp) {
  Simulation simulation = simulate("suslov").start({.velocity = {1, 0.5, 0}});
  const Section section = hamel::section(simulation, {.event = "xi1=-5", .count = 1, .longest = 2});
  EXPECT_FALSE(section.complete);
  EXPECT_EQ(section.orbits.front().found, 0);
  EXPECT_THAT(section.orbits.front().reason, testing::HasSubstr("2 s have passed"));
}

}  // namespace
}  // namespace hamel
