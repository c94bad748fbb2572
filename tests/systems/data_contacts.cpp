// Contacts with friction of systems by data: [[contact]].
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include <hamel/framework/check/contact_laws.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "../framework/run/refusal.hpp"
#include "slipping.hpp"

namespace hamel {
namespace {

using namespace test;
using testing::HasSubstr;

Simulation data(const std::string& text) {
  return Simulation(registry(), "data",
                    OwnSystem{data_system_maker(registry(), "data.toml", text)});
}

// The blade of a sleigh that bears its weight: as the registered one.
TEST(DataContacts, ASleighIsTheRegisteredOne) {
  const Simulation by_data = data(R"toml(
group = "se2"
inertia = [["J + m*a^2", 0, "m*a"], [0, "m", 0], ["m*a", 0, "m"]]
constraints = [[0, 0, 1]]
[parameters]
m = 1.2
a = 0.3
J = 0.7
[[contact]]
name = "blade"
tangential = [1]
load = "9.81*m"
friction = "0.1 + 0*a"
static_friction = 0.12
)toml")
                                 .start({.velocity = {2.5, 1.5, 0.1}})
                                 .slip()
                                 .tolerance({.relative = 1e-11})
                                 .until(3);
  const Result one = by_data.run();
  const Result other = simulate("chaplygin_sleigh")
                           .set("mass", 1.2)
                           .set("offset", 0.3)
                           .set("inertia", 0.7)
                           .set("friction", 0.1)
                           .start({.velocity = {2.5, 1.5, 0.1}})
                           .slip()
                           .tolerance({.relative = 1e-11})
                           .until(3)
                           .run();
  ASSERT_TRUE(one.status.ok) << one.status.reason;
  ASSERT_TRUE(other.status.ok) << other.status.reason;
  ASSERT_FALSE(other.events.empty());
  EXPECT_EQ(one.events.front().name, "blade.rolls");
  EXPECT_NEAR(one.events.front().time, other.events.front().time, 1e-10);
  for (const LawResult& law : check_contacts(by_data)) EXPECT_TRUE(law.passed()) << law;
}

// A stone thrown with v = 3 m/s from the height h: its bounces end at 2 w/g e/(1 - e) behind the
// first strike, w^2 = 2 g h, and take mu (1 + e) w/(1 - e) of v in all; then it slides to rest.
TEST(DataContacts, AStoneBouncesSlidesAndRests) {
  const double mu = 0.05, e = 0.4, h = 0.02, w = std::sqrt(2 * kGravity * h);
  const Simulation stone = data(R"toml(
group = "r3"
coordinates = ["x", "y", "z"]
inertia = [19, 19, 19]
constraints = [[1, 0, 0], [0, 1, 0]]
state = [{ name = "way", rate = "x'" }]
holonomic = ["z"]
potential = "9.81*19*z"
configuration = [0, 0, 0.02]
velocity = [2.4, 1.8, 0]
[[contact]]
name = "ice"
tangential = [1, 2]
normal = 3
friction = 0.05
restitution = 0.4
)toml")
                               .slip()
                               .tolerance({.relative = 1e-11})
                               .until(8);
  const Result r = stone.run();
  ASSERT_TRUE(r.status.ok) << r.status.reason;
  const double lands = w / kGravity * (1 + 2 * e / (1 - e)), left = 3 - mu * (1 + e) * w / (1 - e);
  EXPECT_NEAR(time_of(r, "ice.rolls"), lands + left / (mu * kGravity), 1e-7);
  EXPECT_NEAR(last(r, "x") / last(r, "y"), 2.4 / 1.8, 1e-12);
  EXPECT_NEAR(last(r, "way"), last(r, "x"), 1e-8);
  EXPECT_LT(std::hypot(last(r, "x'"), last(r, "y'")), 1e-12);
  for (const LawResult& law : check_contacts(stone)) EXPECT_TRUE(law.passed()) << law;
}

TEST(DataContacts, MistakesAreNamed) {
  const auto refused = [](const std::string& contact) {
    const std::string text =
        "group = 'r2'\ninertia = [1, 1]\nconstraints = [[1, 0]]\nholonomic = ['x2']\n[[contact]]\n";
    return refusal([&] { (void)data_system(registry(), text + contact, "data.toml"); });
  };
  EXPECT_EQ(refused("tangential = [1]\nnormal = 2\nfriction = 0.3\n"), "accepted");
  EXPECT_THAT(refused("tangential = [1]\nnormal = 2\n"),
              HasSubstr("data.toml:5:1: contact: expected friction = ...; 0 for a smooth one"));
  EXPECT_THAT(refused("tangential = [3]\nnormal = 2\nfriction = 0.3\n"),
              HasSubstr("data.toml:6:14: tangential: expected rows, 1 to 2, got 3"));
  EXPECT_THAT(refused("tangential = [1]\nnormal = 1\nfriction = 0.3\n"),
              HasSubstr("data.toml:7:10: normal: expected rows, 2 to 2, got 1"));
  EXPECT_THAT(refused("tangential = [1]\nfriction = 0.3\n"),
              HasSubstr("contact: expected normal = the row of its gap, or load = a force in N"));
  EXPECT_THAT(refused("tangential = [1]\nnormal = 2\nload = 3\nfriction = 0.3\n"),
              HasSubstr("contact: expected normal or load, not both"));
  EXPECT_THAT(refused("tangential = [1]\nnormal = 2\nfrction = 0.3\n"),
              HasSubstr("unknown key 'frction'"));
  EXPECT_THAT(refused("normal = 2\nfriction = 0\n[[contact]]\nnormal = 2\nfriction = 0\n"),
              HasSubstr("another name than 'contact'"));
  EXPECT_THAT(refusal([] {
                data(
                    "group = 'r2'\ninertia = [1, 1]\nconstraints = [[1, 0]]\n[[contact]]\n"
                    "tangential = [1]\nload = 3\nfriction = -0.3\n")
                    .start({.velocity = {0, 1}})
                    .slip()
                    .until(1)
                    .build();
              }),
              HasSubstr("friction"));
}

}  // namespace
}  // namespace hamel
