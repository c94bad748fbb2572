// Names for parts of formulas, [let], in systems by data and in mechanisms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include <fmt/format.h>

#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/hamel.hpp>
#include <hamel/systems/mechanisms/mechanism_file.hpp>

#include "../framework/run/refusal.hpp"

namespace hamel {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string pendulum(const std::string& lets, const std::string& potential,
                     const std::string& force) {
  return fmt::format(R"toml(group = "r2"
coordinates = ["x", "y"]
inertia = ["m", "m"]
potential = "{}"
force = ["{}", 0]
configuration = [0.4, 0.1]
velocity = [0.3, 1.2]
[parameters]
m = 1.5
{}
[inputs]
push = {{ unit = "N" }}
[outputs]
away = "sqrt(radius2)"
[events]
turns = "radius2 - 1"
)toml",
                     potential, force, lets);
}

Simulation by_data(const std::string& text) {
  return {registry(), "data", OwnSystem{data_system_maker(registry(), "data.toml", text)}};
}

// The texts of names in place of the names: the same motion to the bit, as no operation is another.
TEST(LetNames, StandForTheirTexts) {
  const std::string radius = "radius2 = \"x^2 + y^2\"\n";
  const Simulation named = by_data(pendulum("[let]\nwell = \"radius2*(1 + bend)\"\n" + radius +
                                                "bend = \"m*radius2/4\"\ndrag = \"-0.1*x'\"\n",
                                            "well", "drag + push"))
                               .input("push", 0.2);
  const Simulation written =
      by_data(
          pendulum("[let]\n" + radius, "((x^2 + y^2)*(1 + (m*(x^2 + y^2)/4)))", "-0.1*x' + push"))
          .input("push", 0.2);
  for (const char* scheme : {"lift", "dop853"}) {
    Simulation a = named, b = written;
    const Result left = a.scheme(scheme).step(0.02).until(3).run();
    const Result right = b.scheme(scheme).step(0.02).until(3).run();
    ASSERT_TRUE(left.status.ok) << left.status.reason;
    ASSERT_GT(left.trajectory.rows(), 10U);
    EXPECT_EQ(
        std::vector<double>(left.trajectory.values().begin(), left.trajectory.values().end()),
        std::vector<double>(right.trajectory.values().begin(), right.trajectory.values().end()));
    const auto x = left.trajectory.column("x"), y = left.trajectory.column("y");
    EXPECT_NEAR(left.trajectory.column("away")[5], std::hypot(x[5], y[5]), 1e-14);
  }
}

std::string cart(const std::string& lets, const std::string& mass, const std::string& force) {
  return fmt::format(R"toml([parameters]
m = 2
{}
[[body]]
name = "cart"
mass = "{}"
inertia = [1, 1, 1]
[[joint]]
name = "rail"
kind = "slider"
child = "cart"
axis = [1, 0, 0]
[[motor]]
joint = "rail"
effort = "{}"
[start]
"rail.position" = 0.5
)toml",
                     lets, mass, force);
}

TEST(LetNames, StandInMechanisms) {
  const auto run = [](const std::string& text) {
    return Simulation(registry(), "cart", OwnSystem{[text](const Parameters& given) {
                        return mechanism_from(text, "cart.toml", given);
                      }})
        .scheme("dop853")
        .until(2)
        .run();
  };
  const Result named =
      run(cart("[let]\nhalf = \"m/2\"\npull = \"-stiff*rail.position\"\n"
               "stiff = \"3*half\"\n",
               "half", "pull"));
  ASSERT_TRUE(named.status.ok) << named.status.reason;
  // m/2 x'' = -3 m/2 x
  EXPECT_NEAR(named.last.coordinates[0], 0.5 * std::cos(std::sqrt(3.0) * 2), 1e-8);
  const std::string why = refusal([&] {
    (void)mechanism_from(cart("[let]\n\"rail.position\" = \"2\"\n", "m", "0"), "cart.toml", {});
  });
  EXPECT_THAT(why, HasSubstr("let.rail.position: expected a name that nothing else has"));
}

TEST(LetNames, SayWhatIsWrong) {
  const auto wrong = [](const std::string& lets, const std::string& potential = "0") {
    return refusal([&] {
      (void)data_system(registry(),
                        pendulum("[let]\nradius2 = \"x^2 + y^2\"\n" + lets, potential, "0"),
                        "p.toml", {});
    });
  };
  EXPECT_EQ(wrong(""), "accepted");
  EXPECT_THAT(wrong("a = \"b + 1\"\nb = \"2*a\"\n"),
              HasSubstr("let.a: 'b' is made of itself: b -> a -> b"));
  EXPECT_THAT(wrong("a = \"a\"\n"), HasSubstr("'a' is made of itself: a -> a"));
  // Found where it is used, as another place may know the name; the place is that of the use.
  EXPECT_THAT(wrong("a = \"2*z\"\n", "x + a"),
              HasSubstr("p.toml:4:18: potential: unknown name 'z'"));
  EXPECT_THAT(wrong("a = \"2*z\"\n", "x + a"), HasSubstr("(in let.a)"));
  EXPECT_THAT(wrong("", "radius2 + z"), AllOf(HasSubstr("p.toml:4:24: potential: unknown name 'z'"),
                                              Not(HasSubstr("(in let"))));
  EXPECT_THAT(wrong("a = \"2*(x\"\n"), HasSubstr("let.a: "));
  EXPECT_THAT(wrong("m = \"2\"\n"), HasSubstr("let.m: expected a name that nothing else has"));
  EXPECT_THAT(wrong("x = \"2\"\n"), HasSubstr("two things are called 'x'"));
  EXPECT_THAT(wrong("push = \"2\"\n"), HasSubstr("two things are called 'push'"));
  EXPECT_THAT(wrong("sin = \"2\"\n"),
              HasSubstr("let: expected a name allowed in a formula, got 'sin'"));
  EXPECT_THAT(wrong("a = [1]\n"), HasSubstr("let.a: expected a number or a formula"));
  std::string doubled = "n0 = \"x + y\"\n";
  for (int i = 1; i <= 40; ++i) doubled += fmt::format("n{0} = \"n{1} + n{1}\"\n", i, i - 1);
  EXPECT_THAT(wrong(doubled), HasSubstr("more than 2000 characters, with the texts of its names"));
  EXPECT_EQ(wrong("e3 = \"x\"\n", "1e3*x + 2*e3"), "accepted");
}

}  // namespace
}  // namespace hamel
