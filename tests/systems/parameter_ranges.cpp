// Parameters that make no physical sense are refused, for every registered system: the range that
// each of its fields states, at the edges.
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/hamel.hpp>

namespace {

using namespace hamel;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr double kHuge = 1e300, kTiny = 1e-300;

std::vector<std::string> mistakes_with(const std::string& system, const Field& field,
                                       const std::vector<double>& value) {
  return simulate(system).set(field.name, value).step(1e-3).until(2e-3).mistakes();
}
std::string words(const std::string& system, const Field& field) {
  return "parameter '" + field.name + "' of " + system + ": ";
}
// A list with three numbers or one is entry by entry; 6 or 9 are a matrix.
bool matrix(const Field& field) { return field.range.moments && field.value.size() > 3; }

/// Each entry in turn at each edge: refused by name exactly where the range excludes it.
TEST(ParameterRanges, EdgesAreRefusedOrRun) {
  int refused = 0, accepted = 0;
  for (const std::string& system : registry().systems()) {
    for (const Field& field : registry().system(system)->fields) {
      for (size_t i = 0; i < field.value.size(); ++i) {
        for (const double edge : {0.0, -1.0, -field.value[i], kTiny, -kTiny, 1e12, kHuge}) {
          std::vector<double> value = field.value;
          value[i] = edge;
          const auto mistakes = mistakes_with(system, field, value);
          // A number that decides the dimension is refused before its range is looked at.
          const auto named = Contains(
              AllOf(testing::AnyOf(HasSubstr(words(system, field)), HasSubstr("trailers: got")),
                    HasSubstr("expected")));
          const std::string what = words(system, field) + std::to_string(edge);
          if (!matrix(field) && !field.range.allows(edge)) {
            EXPECT_THAT(mistakes, named) << what;
            ++refused;
          } else {
            EXPECT_THAT(mistakes, Not(named)) << what;
            ++accepted;
          }
        }
        for (const double edge :
             {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
              -std::numeric_limits<double>::infinity()}) {
          std::vector<double> value = field.value;
          value[i] = edge;
          EXPECT_THAT(mistakes_with(system, field, value),
                      Contains(AllOf(HasSubstr("'" + field.name + "'"), HasSubstr("not finite"))));
        }
      }
    }
  }
  EXPECT_GT(refused, 300);
  EXPECT_GT(accepted, 200);
}

/// What no body has less than none of is never negative, and what is divided by never zero: a
/// system that forgets to state a range fails here.
TEST(ParameterRanges, MassesMomentsAndLengthsHaveOne) {
  for (const std::string& system : registry().systems()) {
    for (const Field& field : registry().system(system)->fields) {
      const auto any = [&](std::initializer_list<const char*> words) {
        return std::any_of(words.begin(), words.end(), [&](const char* word) {
          return field.name.find(word) != std::string::npos;
        });
      };
      if (field.unit == "kg" || field.unit == "kg m^2") {
        EXPECT_FALSE(field.range.allows(-1)) << words(system, field);
      }
      if (any({"radius", "length", "axes", "track"})) {
        EXPECT_FALSE(field.range.allows(0) || field.range.allows(-1)) << words(system, field);
      }
      EXPECT_FALSE(field.range.allows(std::numeric_limits<double>::quiet_NaN()));
      if (!matrix(field)) {
        for (const double x : field.value)
          EXPECT_TRUE(field.range.allows(x)) << words(system, field);
      }
    }
  }
}

/// Together with everything else that is wrong.
TEST(ParameterRanges, AllAtOnce) {
  const auto mistakes = simulate("rolling_disk")
                            .set("radius", -1)
                            .set("mass", 0)
                            .scheme("lfit")
                            .step(0)
                            .start({.velocity = {1}})
                            .mistakes();
  for (const char* piece : {"'radius' of rolling_disk: got -1, expected positive",
                            "'mass' of rolling_disk: got 0, expected positive",
                            "did you mean 'lift'", "step: got 0", "velocity: got 1 values"}) {
    EXPECT_THAT(mistakes, Contains(HasSubstr(piece)));
  }
}

/// A range may follow from other parameters: the mass centre of a body lies inside it.
TEST(ParameterRanges, OfOneParameterByAnother) {
  EXPECT_THAT(simulate("rattleback").set("depth", 5).mistakes(),
              Contains("parameter 'depth' of rattleback: got 5, expected in [0, 0.2]"));
  EXPECT_THAT(simulate("routh_sphere").set("radius", 0.1).mistakes(),
              Contains(HasSubstr("'offset' of routh_sphere: got 0.15, expected in [-0.1, 0.1]")));
}

/// A system given in C++ states ranges of its own, and its members are checked where nothing was
/// set.
struct Puck {
  using Group = SE2;
  double mass = 1;
  std::vector<double> angles = {0.1};
  Mat<3, 3> inertia() const { return Vec<3>(1, 1, 1).asDiagonal(); }
  Start start() const { return {.velocity = {1, 0, 0}}; }
  void fields(auto& f) {
    f("mass", mass, "kg", "", Range{.least = 2, .open = true});
    f("angles", angles, "rad", "", Range{.least = -1, .most = 1, .open = true});
  }
};
TEST(ParameterRanges, OfAUsersSystem) {
  const auto mistakes = simulate(Puck{.mass = 2, .angles = {0, 1}}).mistakes();
  EXPECT_THAT(mistakes, Contains("parameter 'mass' of user system: got 2, expected above 2"));
  EXPECT_THAT(mistakes,
              Contains("parameter 'angles' of user system: got 0,1, expected in (-1, 1)"));
  EXPECT_THAT(simulate(Puck{.mass = 3}).mistakes(), testing::IsEmpty());
}

std::vector<std::string> notes_with(const std::string& system, const std::string& name,
                                    const std::vector<double>& value) {
  return simulate(system).set(name, value).step(1e-3).until(2e-3).run().notes;
}

/// Moments that no rigid body has make a note, as numbers, as a matrix, and of a body with an axis.
TEST(ParameterRanges, TheTriangleInequalityIsANote) {
  const auto note = Contains(HasSubstr("no rigid body has the principal moments"));
  EXPECT_THAT(notes_with("veselova", "inertia", {1, 1, 3}), note);
  EXPECT_THAT(notes_with("veselova", "inertia", {1, 1, 2}), Not(note));
  EXPECT_THAT(notes_with("veselova", "inertia", {1, 2, 2.5}), Not(note));
  EXPECT_THAT(notes_with("suslov", "inertia", {1, 0.5, 0, 1, 0, 2.1}), note);  // 0.5, 1.5, 2.1
  EXPECT_THAT(notes_with("suslov", "inertia", {1, 0.5, 0, 1, 0, 1.9}), Not(note));
  EXPECT_THAT(notes_with("suslov", "inertia", {1, 0.5, 0, 0.5, 1, 0, 0, 0, 2.1}), note);
  EXPECT_THAT(notes_with("suslov", "inertia", {1, 10, 100}),
              Contains("parameter 'inertia' of suslov: no rigid body has the principal moments "
                       "1,10,100, since 100 > 1 + 10"));
  EXPECT_THAT(notes_with("falling_disk", "axial_inertia", {0.5}), note);
  EXPECT_THAT(simulate("falling_disk").until(0.1).run().notes, Not(note));  // thin: equality
}

}  // namespace
