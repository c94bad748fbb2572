// The growth of brackets (framework/analysis/growth.hpp) where it is known by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <hamel/framework/analysis/analysis.hpp>
#include <hamel/framework/analysis/recorded_rows.hpp>
#include <hamel/framework/mechanics/general_system.hpp>
#include <hamel/groups/exp.hpp>
#include <hamel/groups/rn.hpp>
#include <hamel/systems/n_trailer.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace {

using namespace hamel;
using testing::ElementsAre;

template <class S>
Growth growth(const S& system, const std::vector<double>& configuration) {
  const TypedGeometry<Exp<typename S::Group>> geometry;
  Eigen::VectorXd g(geometry.size());
  geometry.from_coordinates(configuration, g.data());
  return growth_of(geometry, *erase(system).mechanics, g.data());
}

template <int N>
struct Point {
  using Group = Rn<N>;
  Mat<N, N> inertia() const { return Mat<N, N>::Identity(); }
};

/// z' = y^2 x'. At y = 0, [X, Y] = 0 and [Y, [X, Y]] is not.
struct Martinet : Point<3> {
  Mat<1, 3> constraints(const Vec<3>& g) const { return {-g[1] * g[1], 0, 1}; }
};
TEST(Growth, GoesOnWhereABracketVanishes) {
  const Growth singular = growth(Martinet{}, {0, 0, 0}), regular = growth(Martinet{}, {0, 0.5, 0});
  EXPECT_THAT(singular.dimensions, ElementsAre(2, 2, 3));
  EXPECT_THAT(regular.dimensions, ElementsAre(2, 3));
  EXPECT_TRUE(singular.decided() && regular.decided());
}

struct Mechanisms {
  explicit Mechanisms(const char* name)
      : system(simulate(name).build().system()),
        geometry(registry().geometry(system.group.name, "exp")),
        g(geometry->size()) {
    geometry->from_coordinates(system.start.configuration, g.data());
    units = natural_units(components_of(system), *system.mechanics, g.data());
  }
  Growth exact(int most) const {
    const auto rows = recorded_rows(system, *geometry, g.data());
    EXPECT_TRUE(rows.has_value()) << system.name;
    return growth_of(*geometry, *system.mechanics, g.data(), most, units, rows ? &*rows : nullptr);
  }
  Growth by_values(int most) const {
    return growth_of(*geometry, *system.mechanics, g.data(), most, units);
  }
  SystemModel system;
  std::shared_ptr<const Geometry> geometry;
  Eigen::VectorXd g;
  std::vector<double> units;
};

/// A car whose rear wheels turn apart as it turns round: 6 of 7 directions, the sixth 1e-7 of the
/// first, and one integral. By differences, brackets of five fields are at round-off, and paths
/// decide; exact brackets do by themselves.
TEST(Growth, PathsDecideWhatBracketsDoNot) {
  const Mechanisms car("car");
  for (const Growth& found : {car.by_values(5), car.exact(5)}) {
    EXPECT_THAT(found.dimensions, ElementsAre(2, 3, 5, 6));
    EXPECT_TRUE(found.decided());
  }
}

/// Exact brackets and those by differences span as much wherever both decide.
TEST(Growth, ExactBracketsAreThoseOfDifferences) {
  int compared = 0;
  for (const char* name : {"bicycle", "kick_scooter", "two_trailer_truck", "unicycle_rider",
                           "skateboard", "snakeboard", "n_trailer"}) {
    const Mechanisms mechanism(name);
    const Growth exact = mechanism.exact(4), values = mechanism.by_values(4);
    const size_t both = std::min(exact.dimensions.size(), values.dimensions.size());
    ASSERT_GE(both, 1u) << name;
    for (size_t i = 0; i < both; ++i)
      EXPECT_EQ(exact.dimensions[i], values.dimensions[i]) << name << ", generation " << i;
    compared += exact.dimensions.size() == values.dimensions.size();
  }
  EXPECT_GE(compared, 5);
}

/// z' = y^8 x': nine fields at y = 0, one more than is looked at.
struct Flat : Point<3> {
  Mat<1, 3> constraints(const Vec<3>& g) const { return {-std::pow(g[1], 8), 0, 1}; }
};
TEST(Growth, StopsWithoutAVerdict) {
  const Growth singular = growth(Flat{}, {0, 0, 0});
  EXPECT_FALSE(singular.decided());
  EXPECT_THAT(singular.dimensions, ElementsAre(2));
}

/// z' = e^z (x x' + y y'), the differential of e^-z + (x^2 + y^2)/2.
struct Disguised : Point<3> {
  Mat<1, 3> constraints(const Vec<3>& g) const {
    return {-g[0] * std::exp(g[2]), -g[1] * std::exp(g[2]), 1};
  }
};
TEST(Growth, SeesAHolonomicConstraint) {
  const Growth closed = growth(Disguised{}, {0.3, 0.2, 0.1});
  EXPECT_THAT(closed.dimensions, ElementsAre(2));
  EXPECT_TRUE(closed.decided());
}

/// z' = tanh(y/e) x': one bracket, 1/e beside it, is new at y = 0 for every width e.
struct Narrow : Point<3> {
  double width = 1;
  Mat<1, 3> constraints(const Vec<3>& g) const { return {-std::tanh(g[1] / width), 0, 1}; }
};
TEST(Growth, NarrowRows) {
  std::mt19937 random(3);
  for (int i = 0; i < 6; ++i) {
    Narrow row;
    row.width = std::pow(10, -6 + 8 * static_cast<double>(random()) / 4294967296.0);
    for (const double place : {0.0, 0.3 * row.width}) {
      const Growth found = growth(row, {0.1, place, 0.2});
      EXPECT_THAT(found.dimensions, ElementsAre(2, 3)) << row.width;
      EXPECT_TRUE(found.decided()) << row.width;
    }
  }
}

/// z' = e y x' is not integrable for any e. Brackets that small are near the errors of others; they
/// are not called zero.
template <int Exponent>
struct Faint : Point<3> {
  Mat<1, 3> constraints(const Vec<3>& g) const { return {-std::pow(10.0, Exponent) * g[1], 0, 1}; }
};
TEST(Growth, SmallIsNotZero) {
  EXPECT_FALSE(growth(Faint<-12>{}, {0.3, 0.2, 0.1}).decided());
  EXPECT_FALSE(growth(Faint<-12>{}, {0, 0, 0}).decided());
  EXPECT_THAT(growth(Faint<-8>{}, {0.3, 0.2, 0.1}).dimensions, ElementsAre(2, 3));
}

/// y' = cos 3t is integrable with time; y' = sin x is not, though ker A = span(d/dx) is closed; nor
/// is y' = t x', whose ker A is closed at every t.
struct Driven : Point<2> {
  Mat<1, 2> constraints() const { return {0, 1}; }
  Vec<1> drift(double t, const auto& /*g*/) const { return Vec<1>(std::cos(3 * t)); }
};
struct Shear : Point<2> {
  Mat<1, 2> constraints() const { return {0, 1}; }
  Vec<1> drift(const Vec<2>& g) const { return Vec<1>(std::sin(g[0])); }
};
struct Tilting : Point<2> {
  Mat<1, 2> constraints(double t, const Vec<2>& /*g*/) const { return {-t, 1}; }
};
TEST(Growth, BracketsWithTheDrift) {
  const Growth driven = growth(Driven{}, {0, 0}), shear = growth(Shear{}, {0, 0}),
               tilting = growth(Tilting{}, {0, 0});
  EXPECT_TRUE(driven.with_drift && shear.with_drift && tilting.with_drift);
  EXPECT_THAT(driven.dimensions, ElementsAre(1));
  EXPECT_TRUE(driven.decided());
  EXPECT_THAT(shear.dimensions, ElementsAre(1, 2));
  EXPECT_THAT(tilting.dimensions, ElementsAre(1, 2));
}

/// A car with n trailers needs n + 2 fields; here for each n, one direction more by each
/// generation.
TEST(Growth, AsDeepAsTrailersNeed) {
  for (int trailers = 1; trailers <= 4; ++trailers) {
    NTrailer system;
    system.trailers = trailers;
    const auto geometry = registry().geometry(system.group(), "exp");
    Eigen::VectorXd g(geometry->size());
    geometry->from_coordinates(system.start().configuration, g.data());
    const Growth found = growth_of(*geometry, *system.mechanics(), g.data());
    std::vector<int> expected;
    for (int d = 2; d <= trailers + 3; ++d) expected.push_back(d);
    EXPECT_EQ(found.dimensions, expected);
    EXPECT_TRUE(found.decided());
  }
}

// Few fields are enough to see that rows are not integrable, and holonomic rows leave fewer
// directions. The ball is small: its fields turn fast.
TEST(Growth, FewFieldsAndHolonomicRows) {
  for (const auto& [name, directions] : {std::pair{"falling_disk", 5}, {"ballbot", 8}}) {
    const Analysis quick = analyse(registry(), name, {}, AnalysisOf::verdict);
    EXPECT_EQ(quick.growth.dimensions.back(), directions) << name;
    EXPECT_TRUE(quick.growth.decided()) << name;
    EXPECT_EQ(quick.integrable(), false) << name;
    EXPECT_TRUE(quick.conserved.empty());
  }
  const Analysis trailers = analyse(registry(), "two_trailer_truck", {}, AnalysisOf::verdict);
  EXPECT_THAT(trailers.growth.dimensions, ElementsAre(2, 3, 4));
  EXPECT_FALSE(trailers.growth.decided());
  EXPECT_EQ(trailers.integrable(), false);
}

TEST(Growth, IntegrableOnlyWhenDecided) {
  Analysis a;
  a.n = 3, a.rows = a.rank = 1, a.m = 2;
  a.growth.dimensions = {2};
  EXPECT_FALSE(a.integrable().has_value());
  a.growth.nearby = 2;
  EXPECT_EQ(a.integrable(), true);
  a.growth.nearby = 3;
  EXPECT_EQ(a.integrable(), false);  // as close to the start as one likes
  a.growth.nearby = -1;
  a.growth.dimensions = {2, 2, 3};
  EXPECT_EQ(a.integrable(), false);
}

}  // namespace
