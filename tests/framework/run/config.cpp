// Config reads back exactly the text that it prints; a file with a mistake is refused with line and
// column.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include <hamel/systems/simulate_typed.hpp>

#include "refusal.hpp"

namespace {

using namespace hamel;
using testing::HasSubstr;

void expect_equal(const Config& a, const Config& b) {
  EXPECT_EQ(a.system, b.system);
  EXPECT_EQ(a.parameters, b.parameters);
  Config::start_fields([&](const Option& option, auto member) {
    EXPECT_EQ(a.start.*member, b.start.*member) << option.name;
  });
  Config::fields(
      [&](const Option& option, auto member) { EXPECT_EQ(a.*member, b.*member) << option.name; });
}

Config unusual() {
  Config c;
  c.system = "suslov";
  c.parameters = {{"inertia", {0.1, 1.0 / 3, 1e22}},
                  {"normal", {-0.0, 5e-324, 1.7976931348623157e308}}};
  c.start.configuration = {
      1, 0, 0, 0, std::cos(0.3), -std::sin(0.3), 0, std::sin(0.3), std::cos(0.3)};
  c.start.momentum = {1e-17, -2, 3};
  c.scheme = "balance";
  c.s = 0.1 + 0.2;
  c.retraction = "polar";
  c.tolerance = 3e-15;
  c.on_failure = "retry:hybrid";
  c.compose = "suzuki4";
  c.step = -1.0 / 7;
  c.from = 0.1;
  c.until = -1e5;
  c.every = 123456789012;
  c.slip = true;
  c.no_exact = true;
  c.force_at = "base";
  c.check = c.force = true;
  c.rtol = 1e-7 / 3;
  c.atol = 1e-11;
  c.step_max = 0.7;
  c.steps_max = 12345;
  c.speed = 1.0 / 3;
  c.start_values = {"omega=1", "theta=0.5"};
  c.output_step = 0.1 / 7;
  c.output_times = {0.1, -1.0 / 3};
  c.events = {"x=1", "cusp"};
  c.stop_at = {"fallen"};
  return c;
}

TEST(Config, RoundTripIsExact) {
  expect_equal(Config::from_toml(Config{}.to_toml()), Config{});
  expect_equal(Config::from_toml(unusual().to_toml()), unusual());
  // Once more through text: the same text.
  EXPECT_EQ(Config::from_toml(unusual().to_toml()).to_toml(), unusual().to_toml());
}

/// Quotes and backslashes in a name must not break the file.
TEST(Config, RoundTripOfOddNames) {
  Config c;
  c.system = R"(a "quoted" \ name)";
  c.parameters["odd key"] = {1};
  expect_equal(Config::from_toml(c.to_toml()), c);
}

/// The list is whole: the unusual run differs from the default in every option but the solver.
TEST(Config, EveryOptionIsInTheListAndGoesByName) {
  Config copy;
  std::vector<std::string> names;
  Config::fields([&](const Option& option, auto member) {
    names.emplace_back(option.name);
    EXPECT_EQ(copy.*member != unusual().*member, names.back() != "solver") << option.name;
    copy.set(option.name, unusual().text(option.name));
    EXPECT_EQ(copy.*member, unusual().*member) << option.name;
    EXPECT_THAT(unusual().to_toml(), HasSubstr("\n" + names.back() + " = "));
  });
  EXPECT_THAT(names, testing::ElementsAre("scheme", "retraction", "s", "solver", "force_at",
                                          "compose", "on_failure", "tolerance", "step", "rtol",
                                          "atol", "step_max", "steps_max", "speed", "start", "from",
                                          "until", "every", "output_step", "output_times", "events",
                                          "stop_at", "slip", "check", "force", "no_exact"));
  EXPECT_THROW(copy.set("tolerence", "1"), ConfigError);
  EXPECT_THROW(copy.set("every", "1.5"), ConfigError);
  EXPECT_THROW(copy.set("step", "0.1x"), ConfigError);
}

template <class Value>
void expect_read_back(const Value& value, const std::string& text) {
  EXPECT_EQ(text_of(value), text);
  Value again{};
  read_text("option", text, again);
  EXPECT_EQ(again, value);
}

TEST(Config, ValuesOfEveryTypeAreReadBack) {
  expect_read_back(0.1 + 0.2, "0.30000000000000004");
  expect_read_back(123456789012L, "123456789012");
  expect_read_back(true, "true");
  expect_read_back(false, "false");
  expect_read_back(std::string("a, b"), "a, b");
  expect_read_back(std::vector<double>{1, -2.5, 1e-300}, "1,-2.5,1e-300");
  expect_read_back(std::vector<std::string>{"lift", "balance"}, "lift,balance");
  bool flag = false;
  EXPECT_THROW(read_text("check", "yes", flag), ConfigError);
}

/// The same for the builder, for a file and for the command line: all are a Config.
TEST(Config, LeavesSchemeAndStepsToTheDefaults) {
  const Config open = Config{}.completed();
  EXPECT_EQ(open.scheme, "dop853");
  EXPECT_EQ(open.rtol, 1e-8);
  EXPECT_EQ(open.output_step, 0.01);
  EXPECT_FALSE(open.step);
  expect_equal(open.completed(), open);
  const auto by = [](const std::string& option, const std::string& value) {
    Config config;
    config.set(option, value);
    return config.completed();
  };
  EXPECT_EQ(by("step", "0.1").scheme, "lift");
  EXPECT_FALSE(by("step", "0.1").chooses_steps());
  EXPECT_EQ(by("rtol", "1e-6").scheme, "dop853");
  EXPECT_EQ(by("rtol", "1e-6").rtol, 1e-6);
  EXPECT_FALSE(by("rtol", "1e-6").output_step);
  EXPECT_EQ(by("compose", "suzuki4").scheme, "lift");
  EXPECT_EQ(by("compose", "suzuki4").step, 0.01);
  EXPECT_EQ(by("scheme", "rkmk4").step, 0.01);
  EXPECT_EQ(by("until", "-1").step_or_usual(), -0.01);
  EXPECT_EQ(by("output_step", "0.5").output_step, 0.5);
}

TEST(Config, StateTheDefaultsInANote) {
  const auto notes = [](Simulation run) { return run.until(0.1).run().notes; };
  EXPECT_THAT(notes(simulate("segway")),
              testing::Contains("no scheme or step given: dop853 at rtol = 1e-08; error unknown "
                                "(--check)"));
  EXPECT_THAT(notes(simulate("suslov")),  // whose exact motion is known
              testing::Contains("no scheme or step given: dop853 at rtol = 1e-08"));
  for (const std::string& note : notes(simulate("segway").step(0.01)))
    EXPECT_THAT(note, testing::Not(HasSubstr("no scheme")));
}

TEST(Config, OfAResultRunsAgain) {
  const Result first = simulate("chaplygin_sleigh").set("offset", 0.3).step(0.05).until(3).run();
  Simulation again = simulate("");
  const Result second = again.config(Config::from_toml(first.config.to_toml())).run();
  // The start is projected once more: a few eps, which 60 steps do not amplify.
  ASSERT_EQ(first.last.coordinates.size(), second.last.coordinates.size());
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(first.last.coordinates[i], second.last.coordinates[i], 1e-13);
    EXPECT_NEAR(first.last.velocity[i], second.last.velocity[i], 1e-13);
  }
}

std::string message(const std::string& toml) {
  return refusal([&] { (void)Config::from_toml(toml, "run.toml"); });
}

TEST(Config, MistakesNameLineAndColumn) {
  EXPECT_THAT(message("system = \"suslov\"\nstep = = 3\n"), HasSubstr("run.toml:2:8"));
  EXPECT_THAT(message("system = \"suslov\"\nstep = \"fast\"\n"),
              HasSubstr("run.toml:2:8: step: got 'fast', expected a number"));
  EXPECT_THAT(message("every = 1.5\n"),
              HasSubstr("run.toml:1:9: every: got 1.5, expected a whole number"));
  EXPECT_THAT(message("velocity = [1, \"x\", 3]\n"), HasSubstr("run.toml:1:16: velocity"));
  EXPECT_THAT(message("scheme = 3\n"),
              HasSubstr("run.toml:1:10: scheme: got 3, expected a string"));
  EXPECT_THAT(message("set = 3\n"), HasSubstr("run.toml:1:7: set: expected a table"));
  EXPECT_THAT(message("[set]\ninertia = [1, [2], 3]\n"), HasSubstr("run.toml:2:15: set.inertia"));
  EXPECT_THAT(message("\n\nretracton = \"exp\"\n"),
              testing::AllOf(HasSubstr("run.toml:3:"), HasSubstr("did you mean 'retraction'?")));
}

TEST(Config, AllMistakesOfAFileAtOnce) {
  const std::string all =
      message("stpe = 0.1\nscheme = 3\nuntil = \"late\"\n[set]\nmass = \"heavy\"\n");
  EXPECT_THAT(all, HasSubstr("did you mean 'step'?"));
  EXPECT_THAT(all, HasSubstr("scheme: got 3, expected a string"));
  EXPECT_THAT(all, HasSubstr("until: got 'late', expected a number"));
  EXPECT_THAT(all, HasSubstr("set.mass"));
}

TEST(Config, AFileThatIsNotThere) {
  EXPECT_THROW((void)read_config("/no/such/file.toml"), ConfigError);
  EXPECT_THROW((void)read_config("/"), ConfigError);
}

TEST(Config, WholeSteps) {
  const auto steps = [](double h, double t) {
    Config c;
    c.step = h;
    c.until = t;
    return c.steps();
  };
  EXPECT_EQ(steps(0.01, 1800), 180000);
  EXPECT_EQ(steps(0.1, 0.3), 3);
  EXPECT_EQ(steps(0.1, 0.35), 3);
  EXPECT_EQ(steps(-0.1, -0.3), 3);
  EXPECT_EQ(steps(0.1, 0), 0);
  EXPECT_EQ(steps(1.0 / 3, 1), 3);
}

}  // namespace
