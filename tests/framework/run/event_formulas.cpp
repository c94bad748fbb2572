// Events by formulas of the state, for any system: located where the motion is known in closed
// form.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hamel/simulate.hpp>

namespace hamel {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// With its mass above the blade the sleigh goes round in a circle: theta = t, x = sin t.
Simulation circling() {
  return simulate("chaplygin_sleigh")
      .set("offset", 0)
      .start({.velocity = {1, 1, 0}})
      .scheme("dop853")
      .tolerance({.relative = 1e-12})
      .until(6.2);
}

std::vector<std::string> names(const Result& r) {
  std::vector<std::string> out;
  for (const EventMet& e : r.events) out.push_back(e.name);
  return out;
}

// = in both directions, > and < in one.
TEST(EventFormulas, DirectionsAreThoseOfTheSign) {
  const Result r = circling().events({"2*x=1", "2*x>1", "2*x<1", "x^2 + y^2 > 2"}).run();
  ASSERT_TRUE(r) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("2*x=1", "2*x>1", "x^2 + y^2 > 2", "2*x=1", "2*x<1"));
  const double pi = std::acos(-1), up = pi / 6, down = 5 * pi / 6;
  const double expected[] = {up, up, pi / 2, down, down};
  for (size_t i = 0; i < r.events.size(); ++i)
    EXPECT_NEAR(r.events[i].time, expected[i], 1e-10) << r.events[i].name;
}

// Of the time, of velocities by name and by number, and of parameters, those of several numbers
// too.
TEST(EventFormulas, OfTimeVelocitiesAndParameters) {
  const Result r = circling().events({"t*omega=mass", "theta=2*xi2", "max(t,0) = 3"}).run();
  ASSERT_TRUE(r) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("t*omega=mass", "theta=2*xi2", "max(t,0) = 3"));
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(r.events[i].time, static_cast<double>(i) + 1, 1e-10);
  const Result stopped =
      simulate("suslov").set("inertia", {1, 1.5, 2}).stop_at({"t>inertia2"}).run();
  EXPECT_TRUE(stopped.stopped_by_event);
  EXPECT_NEAR(stopped.last.time, 1.5, 1e-10);
}

// Columns of a product begin with the number of the factor.
TEST(EventFormulas, ColumnsOfAProduct) {
  const Result r = simulate("rolling_disk")
                       .start({.velocity = {0, 1, 0, 1}})
                       .step(0.01)
                       .until(3)
                       .events({"1_x>1", "1_x + 1_x = 3", "x_1 = 2"})
                       .run();
  ASSERT_TRUE(r) << r.status.reason;
  ASSERT_THAT(names(r), ElementsAre("1_x>1", "1_x + 1_x = 3", "x_1 = 2"));
  for (size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(r.events[i].coordinates[1], 1 + static_cast<double>(i) / 2, 1e-9);
}

// A coordinate of a factor by its name alone: nearer than a velocity that is one letter off.
TEST(EventFormulas, TheNearestNameHasWhatWasGiven) {
  const auto offered = [](const std::string& given) -> std::string {
    try {
      simulate("chaplygin_ball").events({given + "=3"}).build();
    } catch (const ConfigError& error) {
      const std::string what = error.what(), mean = "did you mean '";
      const size_t at = what.find(mean);
      return at == std::string::npos
                 ? ""
                 : what.substr(at + mean.size(), what.size() - at - mean.size() - 2);
    }
    return "";
  };
  EXPECT_EQ(offered("x1"), "x");
  EXPECT_EQ(offered("R_33"), "R33");
  EXPECT_EQ(offered("omega"), "omega1");
  EXPECT_EQ(offered("omga1"), "omega1");
  EXPECT_EQ(offered("Q"), "");  // t has no letter of it
}

TEST(EventFormulas, MistakesAreNamed) {
  const auto mistake = [](const std::string& text) -> std::string {
    try {
      circling().events({text}).build();
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(mistake("omga=1"), HasSubstr("events: 'omga=1': unknown name 'omga'"));
  EXPECT_THAT(mistake("omga=1"), HasSubstr("did you mean 'omega'?"));
  EXPECT_THAT(mistake("x="), HasSubstr("events: 'x='"));
  EXPECT_THAT(mistake("x=ln(-1)"), HasSubstr("nan at the start"));
  for (const char* none : {"x", "x==1", "x<=1", "x=1=2"})
    EXPECT_THAT(mistake(none), HasSubstr("unknown event of chaplygin_sleigh")) << none;
  EXPECT_THAT(mistake("x"), HasSubstr("FORMULA=FORMULA"));
}

}  // namespace
}  // namespace hamel
