// Mechanisms in files: where they start, what stops them, which have steady motions, with roots of
// any kind.
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;

using MechanismRuns = CommandLine;

/// A prescribed angle is the start's, from other times too.
TEST_F(MechanismRuns, StartsWhereItIsPrescribed) {
  const std::string hinge = write(R"toml([[body]]
name = "arm"
mass = 1
at = [1, 0, 0]
inertia = [1, 1, 1]
[[body]]
name = "tip"
mass = 1
at = [2, 0, 0]
inertia = [1, 1, 1]
[[joint]]
name = "turn"
kind = "hinge"
child = "arm"
[[joint]]
name = "free"
kind = "hinge"
parent = "arm"
child = "tip"
at = [1.5, 0, 0]
[[prescribed]]
joint = "turn"
angle = "0.5 + t^2/10"
)toml");
  for (const double from : {0.0, 3.0}) {
    const json out = answer({"run", hinge, "--from", std::to_string(from), "--until",
                             std::to_string(from + 1), "--compose", "kahan_li6"});
    EXPECT_NEAR(out["start"]["configuration"][0], 0.5 + from * from / 10, 1e-14);
    EXPECT_NEAR(out["start"]["velocity"][0], from / 5, 1e-14);
    EXPECT_NEAR(out["final"]["configuration"][0], 0.5 + (from + 1) * (from + 1) / 10, 1e-10);
  }
  EXPECT_THAT(run({"run", hinge, "--configuration", "0,0", "--velocity", "0,1"}).err,
              HasSubstr("system.toml:21:1: prescribed 'turn': turn.angle is prescribed as 0.5 at "
                        "t = 0, but 0 at the start"));
}

const std::string kTwo = R"toml([[body]]
name = "pendulum"
mass = 1
at = [0, 0, -1]
box = [0.1, 0.1, 0.1]
[[body]]
name = "skate"
mass = 1
at = [0.2, 0, 0]
box = [0.1, 0.1, 0.1]
[[body]]
name = "other"
mass = 1
at = [1, 0, 0]
box = [0.1, 0.1, 0.1]
[[joint]]
name = "pivot"
kind = "hinge"
child = "pendulum"
axis = [0, 1, 0]
[[joint]]
name = "ice"
kind = "planar"
child = "skate"
[[joint]]
name = "rink"
kind = "planar"
child = "other"
[[blade]]
name = "keel"
body = "skate"
)toml";

/// Two roots and a pendulum: no joint is a lone root.
TEST_F(MechanismRuns, WithoutALoneRootDescribesItself) {
  const json d = answer({"describe", write(kTwo)});
  EXPECT_EQ(d["parts"], json({"pendulum", "skate", "other"}));
  EXPECT_EQ(d["reactions"], json({"keel.reaction1"}));
  EXPECT_EQ(d["dimension"], 7);
  EXPECT_EQ(d["directions"], 6);
  const json a = answer({"describe", "--analyse", file("system.toml")});
  EXPECT_THAT(a["verdict"].get<std::string>(), HasSubstr("nonholonomic"));
  const std::string pendulum = kTwo.substr(0, kTwo.find("[[body]]\nname = \"skate\"")) +
                               "[[joint]]\nname = \"pivot\"\nkind = \"hinge\"\nchild = "
                               "\"pendulum\"\naxis = [0, 1, 0]\n";
  const json p = answer({"describe", write(pendulum)});
  EXPECT_EQ(p["parts"], json({"pendulum"}));
  EXPECT_EQ(p["directions"], 1);
}

/// Of the first root joint that runs ahead, whatever the few numbers mean.
TEST_F(MechanismRuns, StartsAtTheSpeedOfItsFirstRoot) {
  const json two = answer({"run", write(kTwo), "--speed", "3", "--until", "0.01"});
  EXPECT_EQ(two["start"]["velocity"][2], 3.0);
  EXPECT_EQ(two["start"]["velocity"][5], 0.0);
  const json ballbot = answer({"run", "ballbot", "--speed", "1", "--until", "0.01"});
  EXPECT_NEAR(ballbot["start"]["velocity"][3], 1, 1e-12);
}

/// Of t, coordinates and rates by name: the pendulum, let go at 1 rad, is upright when its angle is
/// 0.
TEST_F(MechanismRuns, StopsAtEvents) {
  const std::string text = kTwo + R"toml([events]
upright = { value = "pivot.angle", meaning = "the pendulum hangs", direction = -1 }
late = "t - 2"
[start]
pivot.angle = 1
)toml";
  const json out = answer(
      {"run", write(text), "--stop-at", "upright", "--until", "3", "--compose", "kahan_li6"});
  EXPECT_NEAR(out["final"]["configuration"][0], 0, 1e-12);
  EXPECT_LT(out["final"]["velocity"][0], -1);
  EXPECT_NEAR(answer({"run", write(text), "--stop-at", "late"})["time"], 2, 1e-12);
  const json events = answer({"describe", write(text)})["events"];
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[1]["name"], "upright");
  EXPECT_EQ(events[1]["meaning"], "the pendulum hangs");
  EXPECT_EQ(events[1]["direction"], "downwards");
  EXPECT_THAT(run({"run", write(kTwo + "[events]\nup = \"pivot.angel\"\n")}).err,
              HasSubstr("did you mean 'pivot.angle'?"));
}

/// A motor that slows a wheel and a rate that does not change leave a skate its steady motions; one
/// of t does not.
TEST_F(MechanismRuns, SteadyWhereNoFormulaIsOfTime) {
  const std::string skate = R"toml([[body]]
name = "deck"
mass = 3
at = [0.1, 0, 0.2]
box = [0.5, 0.2, 0.1]
[[body]]
name = "rotor"
mass = 1
at = [0, 0, 0.4]
cylinder = [0.1, 0.03]
[[body]]
name = "fan"
mass = 1
at = [0, 0, 0.6]
cylinder = [0.1, 0.03]
[[joint]]
name = "road"
kind = "planar"
child = "deck"
[[joint]]
name = "spin"
kind = "hinge"
parent = "deck"
child = "rotor"
[[joint]]
name = "fan"
kind = "hinge"
parent = "deck"
child = "fan"
[[blade]]
name = "keel"
body = "deck"
[inputs]
wind = { unit = "N" }
[[prescribed]]
joint = "fan"
)toml";
  const auto steady = [&](const std::string& rate, const std::string& effort) {
    return run({"steady",
                write(skate + "rate = " + rate + "\n[[motor]]\njoint = \"spin\"\neffort = " +
                      effort + "\n[[force]]\nname = \"wind\"\nbody = \"deck\"\n" +
                      "along = [\"wind*cos(theta)\", 0, 0]\n"),
                "--speed", "1", "--json"});
  };
  const Outcome o = steady("3", "\"wind - 0.1*spin.rate\"");
  ASSERT_EQ(o.status, 0) << o.err;
  const json s = json::parse(o.out);
  EXPECT_NEAR(s["motion"]["velocity"][1], 1, 1e-12);
  EXPECT_NEAR(s["motion"]["velocity"][4], 3, 1e-12);
  EXPECT_THAT(steady("\"3 + t\"", "0").err, HasSubstr("depends on time"));
  EXPECT_THAT(steady("3", "\"0.1*t\"").err, HasSubstr("depends on time"));
}

/// A wheel whose joint is prescribed: the contact and the joint have the name of the body, their
/// reactions do not.
TEST_F(MechanismRuns, EveryReactionHasItsOwnName) {
  std::ofstream(file("cart.toml")) << R"toml(
[[body]]
name = "cart"
mass = 1
at = [0, 0, 0.1]
inertia = [0.1, 0.1, 0.1]
[[joint]]
kind = "planar"
child = "cart"
[[body]]
name = "wheel"
mass = 1
at = [0, 0, 0.1]
cylinder = [0.1, 0.02]
axis = [0, 1, 0]
[[joint]]
kind = "hinge"
parent = "cart"
child = "wheel"
at = [0, 0, 0.1]
axis = [0, 1, 0]
[[wheel]]
body = "wheel"
at = [0, 0, 0.1]
radius = 0.1
[[prescribed]]
joint = "wheel"
rate = "1 + 0.5*sin(t)"
)toml";
  ASSERT_EQ(run({"run", "cart.toml", "--until", "0.1", "--quiet", "-o", "a.csv"}).status, 0);
  const std::string head = lines(contents(file("a.csv"))).front();
  for (const char* number : {"1", "2", "4"}) {  // 3 is the height, which stays on the plane
    const std::string name = std::string(",wheel.reaction") + number;
    EXPECT_NE(head.find(name), std::string::npos) << head;
    EXPECT_EQ(head.find(name), head.rfind(name)) << head;
  }
}

const std::string kLocked = R"toml([[body]]
name = "deck"
mass = 5
at = [0.3, 0, 0.1]
box = [0.6, 0.15, 0.05]
[[body]]
name = "fork"
mass = 1.5
at = [0.75, 0, 0.5]
box = [0.05, 0.06, 0.8]
[[body]]
name = "bob"
mass = 1
at = [0.3, 0, 0.5]
sphere = 0.1
[[joint]]
name = "road"
kind = "planar"
child = "deck"
[[joint]]
name = "steer"
kind = "hinge"
parent = "deck"
child = "fork"
at = [0.75, 0, 0]
[[joint]]
name = "roll"
kind = "hinge"
parent = "deck"
child = "bob"
at = [0.3, 0, 0.1]
axis = [1, 0, 0]
stiffness = 20
damping = 0.5
[[blade]]
name = "rear"
body = "deck"
[[blade]]
name = "front"
body = "fork"
at = [0.75, 0, 0]
[start]
speed = 2
[[prescribed]]
joint = "steer"
)toml";

/// A constant angle is held while a steady motion is sought, and its rate leaves the mechanism its
/// steady motions: on a circle of radius 0.75 m / tan 0.2, the bob where its spring bears weight
/// and centrifugal force.
TEST_F(MechanismRuns, SteadyWhereAnAngleIsHeld) {
  for (const char* angle : {"0.2", "\"0.4/2\"", "\"0.2 + 2*pi\""}) {
    const Outcome o =
        run({"steady", write(kLocked + "angle = " + std::string(angle) + "\n"), "--json"});
    ASSERT_EQ(o.status, 0) << o.err;
    const json s = json::parse(o.out);
    const json &at = s["motion"]["element"], &xi = s["motion"]["velocity"];
    EXPECT_NEAR(std::remainder(at[3].get<double>() - 0.2, 2 * std::numbers::pi), 0, 1e-12);
    const double turn = xi[0], ahead = xi[1], roll = at[4];
    EXPECT_NEAR(turn, ahead * std::tan(0.2) / 0.75, 1e-10);
    // The bob 0.4 m above the axis of roll, 0.1 m from its centre all moments the same.
    const double aside = -0.4 * std::sin(roll), height = 0.4 * std::cos(roll);
    const double inward = turn * ahead - turn * turn * aside;  // acceleration to the left
    EXPECT_NEAR(20 * roll, -9.81 * aside + inward * height, 1e-9) << angle;
    EXPECT_EQ(run({"run", write(kLocked + "angle = " + std::string(angle) + "\n"), "--until", "1"})
                  .status,
              0);
  }
  EXPECT_THAT(run({"steady", write(kLocked + "angle = \"0.2 + t^2\"\n")}).err,
              HasSubstr("depends on time"));
}

/// Motions of the analysis that start later start where the angle is then.
TEST_F(MechanismRuns, AnalysedWhereAnAngleIsPrescribed) {
  for (const char* angle : {"0.1 + 0.4*sin(1.5*t)", "0.2 + t"}) {
    const Outcome o = run({"describe", "--analyse",
                           write(kLocked + "angle = \"" + std::string(angle) + "\"\n"), "--json"});
    EXPECT_EQ(o.status, 0) << o.err;
    EXPECT_EQ(json::parse(o.out)["directions"], 2) << angle;
  }
  // A four-bar linkage that cannot start later where it is stated to start now.
  const Outcome o = run({"describe", "--analyse", write(R"toml(redundant = "drop"
body = [
  { name = "crank", mass = 1, at = [0.15, 0, 1.2], box = [0.3, 0.03, 0.03] },
  { name = "rod", mass = 1.5, at = [0.6, 0, 1.5], box = [0.6, 0.03, 0.03] },
  { name = "rocker", mass = 1, at = [0.95, 0, 1.3], box = [0.03, 0.03, 0.6] },
  { name = "bob", mass = 1, at = [0.95, 0, 1.3], box = [0.03, 0.03, 0.6] },
]
joint = [
  { name = "a", kind = "hinge", child = "crank", at = [0, 0, 1], axis = [0, 1, 0] },
  { name = "b", kind = "hinge", parent = "crank", child = "rod", at = [0.3, 0, 1.4], axis = [0, 1, 0] },
  { name = "d", kind = "hinge", child = "rocker", at = [1, 0, 1], axis = [0, 1, 0] },
  { name = "e", kind = "hinge", parent = "rocker", child = "bob", at = [1, 0, 1], axis = [0, 1, 0] },
]
loop = [{ name = "c", a = "rod", b = "rocker", at = [0.9, 0, 1.6], axis = [0, 1, 0] }]
prescribed = [{ joint = "a", angle = "0.3*sin(t)" }]
[start]
d.angle = 0
)toml"),
                         "--json"});
  EXPECT_EQ(o.status, 0) << o.err;
}

}  // namespace
