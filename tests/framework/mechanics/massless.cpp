// Links without mass: I is semidefinite and definite on ker A. What moves is what moves with any
// mass that the constraint holds still.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

std::string skate(const char* mass_across) {
  return std::string("group = \"se2\"\ninertia = [0.1, 1, ") + mass_across +
         "]\nconstraints = [[0, 0, 1]]\nvelocity = [1.2, 0.5, 0]\n";
}
Simulation of(const std::string& text) {
  return {registry(), "skate", OwnSystem{data_system_maker(registry(), "skate", text)}};
}
void expect_equal(const Result& a, const Result& b, double tolerance, const std::string& what) {
  ASSERT_TRUE(a.status.ok && b.status.ok) << what << ": " << a.status.reason << b.status.reason;
  for (size_t i = 0; i < a.last.coordinates.size(); ++i)
    EXPECT_NEAR(a.last.coordinates[i], b.last.coordinates[i], tolerance) << what;
  for (size_t i = 0; i < a.last.velocity.size(); ++i)
    EXPECT_NEAR(a.last.velocity[i], b.last.velocity[i], tolerance) << what;
}

/// v2 = 0: the mass in that direction does not move, in systems with constant rows and in others.
TEST(Massless, IsTheMotionOfAMassThatDoesNotMove) {
  for (const char* more : {"", "potential = '-0.5*x'\n"}) {
    for (const char* scheme : {"lift", "balance"}) {
      const auto run = [&](const char* mass) {
        return of(skate(mass) + more).scheme(scheme).step(0.01).until(2).run();
      };
      expect_equal(run("0"), run("1e-7"), 1e-7, std::string(scheme) + more);
    }
    // The equations of motion, and the reactions from them.
    const auto run = [&](const char* mass) {
      return of(skate(mass) + more).scheme("lift").step(0.001).until(1).run();
    };
    const Result without = run("0"), with = run("1");
    const size_t lambda = without.trajectory.index("lambda1");
    for (size_t i = 0; i < with.trajectory.rows(); ++i)
      EXPECT_NEAR(without.trajectory.at(i, lambda), with.trajectory.at(i, lambda), 1e-5) << more;
  }
}

/// Trailers without mass follow; their equation is the limit of those with little.
TEST(Massless, TrailersFollow) {
  const auto run = [](double mass, const char* scheme) {
    return simulate("n_trailer")
        .set("trailer_mass", mass)
        .set("trailer_inertia", 0.1 * mass)
        .scheme(scheme)
        .until(2)
        .run();
  };
  for (const char* scheme : {"lift", "balance"})
    expect_equal(run(0, scheme), run(1e-8, scheme), 1e-6, scheme);
}

TEST(Massless, IsRefusedWhereItMoves) {
  const auto refused = [](const std::string& inertia, const char* scheme) {
    const auto mistakes = of("group = \"se2\"\ninertia = " + inertia +
                             "\nconstraints = [[0, 0, 1]]\nvelocity = [1.2, 0.5, 0]\n")
                              .scheme(scheme)
                              .mistakes();
    return mistakes.empty() ? std::string() : mistakes[0];
  };
  EXPECT_THAT(refused("[0, 1, 1]", "lift"), testing::HasSubstr("not on the admissible velocities"));
  EXPECT_THAT(refused("[0.1, 1, -1]", "lift"), testing::HasSubstr("not positive definite"));
  EXPECT_THAT(refused("[0.1, 1, 0]", "reversible"), testing::HasSubstr("needs a definite inertia"));
  EXPECT_EQ(refused("[0.1, 1, 0]", "lift"), "");
}

}  // namespace
}  // namespace hamel
