// Mechanisms in files whose parts slide, stick and strike: keys, mistakes, robots, notes.
#include <cmath>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kBlock = R"([[body]]
name = "block"
mass = 1
at = [0, 0, 0.1]
box = [0.2, 0.2, 0.2]
[[joint]]
name = "way"
kind = "slider"
child = "block"
axis = [1, 0, 0]
)";

using Words = std::vector<std::string>;

class Slipping : public CommandLine {
 protected:
  std::string block(const std::string& more, const std::string& behind = "") {
    return write("block.toml", kBlock + more + "\n" + behind);
  }
  json run_of(const std::string& system, const Words& more = {}) {
    Words words = {system};
    words.insert(words.end(), more.begin(), more.end());
    return record(words);
  }
  std::string refused(const std::string& system) {
    const Outcome out = run({"run", system, "--until", "1"});
    EXPECT_EQ(out.status, 2);
    return out.err;
  }
};

// Its rate at the start needs no --slip, as dry friction only takes it away.
TEST_F(Slipping, ABlockWithDryFrictionRests) {
  const json out = run_of(block("friction = 2", "[start]\nway.rate = 1"),
                          {"--until", "1000", "--rtol", "1e-10"});
  ASSERT_EQ(out["events"].size(), 1U);
  EXPECT_EQ(out["events"][0]["name"], "way.sticks");
  EXPECT_NEAR(out["events"][0]["time"].get<double>(), 0.5, 1e-13);
  EXPECT_LE(out["steps"].get<long>(), 12);
}

TEST_F(Slipping, StopsAndWalls) {
  const json out = run_of(block("stop = [-1, 1]\nrestitution = 0.5",
                                "[parameters]\nedge = 0.6\n[[wall]]\nname = \"wall\"\ndistance = "
                                "\"edge - way.position\"\n"
                                "restitution = 1\n[start]\nway.rate = 2"),
                          {"--until", "1.5"});
  ASSERT_EQ(out["events"].size(), 2U);
  EXPECT_EQ(out["events"][0]["name"], "wall.strikes");
  EXPECT_NEAR(out["events"][0]["time"].get<double>(), 0.3, 1e-12);
  EXPECT_EQ(out["events"][1]["name"], "way.low.strikes");
  EXPECT_NEAR(out["events"][1]["time"].get<double>(), 1.1, 1e-12);
}

TEST_F(Slipping, MistakesAreNamed) {
  EXPECT_THAT(refused(block("friction = -2")),
              HasSubstr("block.toml:6:1: joint 'way': friction: got -2, expected at least 0"));
  EXPECT_THAT(refused(block("stop = [1, -1]")), HasSubstr("joint 'way': stop: got [1,-1]"));
  EXPECT_THAT(refused(block("restitution = 0.5")), HasSubstr("restitution: expected a stop"));
  EXPECT_THAT(refused(block("stop = [0, 1]", "[start]\nway.position = 1.5")),
              AllOf(HasSubstr("configuration: 'way.high' of "), HasSubstr("is passed by 0.5")));
  EXPECT_THAT(refused(block("", "[[wall]]\nname = \"w\"\ndistance = \"1 - way.rate\"")),
              HasSubstr("wall 'w': distance: 'way.rate' is a velocity"));
  EXPECT_THAT(refused(block("", "[[point]]\nbody = \"block\"\nfriction = 0.1")),
              HasSubstr("load: not given"));
  EXPECT_THAT(refused(block("", "[[point]]\nbody = \"block\"\nfrction = 0.1")),
              HasSubstr("did you mean 'friction'?"));
}

// An effort that jumps is noted, with what to take.
TEST_F(Slipping, JumpsAreNoted) {
  const auto with = [&](const std::string& effort) {
    return run({"describe", block("", "[[motor]]\njoint = \"way\"\neffort = \"" + effort + "\"\n"),
                "--verbose"})
        .out;
  };
  for (const char* effort : {"-2*sign(way.rate)", "way.rate > 0 ? -1 : 1"})
    EXPECT_THAT(with(effort),
                AllOf(HasSubstr("jumps where way.rate changes its sign"), HasSubstr("`friction`")))
        << effort;
  for (const char* effort : {"-2*way.rate", "t < 0.05 ? 1 : 0", "-abs(way.rate)*way.rate"})
    EXPECT_THAT(with(effort), Not(HasSubstr("jumps"))) << effort;
}

// a = 0.25, b = 0.2, r = 0.1: W = b r w/(a^2 + b^2); the torque of friction is r mu N a/|(a, b)|.
TEST_F(Slipping, ASkidSteeredRobotTurns) {
  const std::string robot = source_file("tests/examples/skid_steered.urdf");
  const std::string copy = write("robot.urdf", robot);
  const json out =
      run_of(copy + "?wheel=auto,friction=0.6",
             {"--until", "3", "--rtol", "1e-10", "--input", "front_left_axle.torque=-6", "--input",
              "rear_left_axle.torque=-6", "--input", "front_right_axle.torque=6", "--input",
              "rear_right_axle.torque=6"});
  const double load = 20 * 9.81 / 4, a = 0.25, b = 0.2, r = 0.1;
  const double w = (6 - r * 0.6 * load * a / std::hypot(a, b)) / 0.5;
  const auto velocity = out["final"]["velocity"].get<std::vector<double>>();
  EXPECT_NEAR(velocity[0], b * r * w / (a * a + b * b), 1e-8);
  EXPECT_NEAR(velocity[4], w, 1e-7);
  EXPECT_THAT(out["notes"].dump(), HasSubstr("turns only by slipping"));
  const Outcome described = run({"describe", copy + "?wheel=auto,friction=0.6"});
  EXPECT_THAT(described.out, HasSubstr("turns only by slipping"));
  // A note that recommends --slip is none where it is given.
  const Words starts = {"--start", "v1=1,omega=1", "--until", "0.05"};
  Words slips = starts;
  slips.push_back("--slip");
  const std::string given = copy + "?wheel=auto,friction=0.6";
  EXPECT_THAT(run_of(given, starts)["notes"].dump(), HasSubstr("--slip starts so"));
  EXPECT_THAT(run_of(given, slips)["notes"].dump(), Not(HasSubstr("--slip starts so")));
  // Modes over the time, and beside where the contacts are.
  if (const json page = page_of({given, "--start", "v1=1,omega=1", "--until", "0.05", "--slip"});
      !page.is_null()) {
    const json modes = figure_of(page, "Modes of the contacts");
    EXPECT_EQ(modes["y_values"].size(), 4U);
    EXPECT_EQ(modes["classes"], json({"open", "rolls", "slides"}));
    EXPECT_EQ(modes["values"][0][0], 2);  // slides at first
    EXPECT_EQ(figure_of(page, "Motion")["forces"][0]["modes"][0], 2);
  }
  const Outcome wrong = run({"run", copy, "--wheel", "auto,friction=-1", "--until", "1"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("friction: got '-1', expected a number of at least 0"));
}

}  // namespace
