// hamel plan: closed facts by files, the run that repeats a plan, mistakes.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using Json = nlohmann::json;
using testing::HasSubstr;

class PlansOfTheProgram : public CommandLine {
 protected:
  Json plan(const std::string& name, int status = 0) {
    const Outcome out = run({"plan", file(name), "--json"});
    EXPECT_EQ(out.status, status) << out.err;
    return Json::parse(out.out);
  }
  // A disk that rolls straight: m R^2 + J over a torque; here a mass on a line.
  void write_cart(const std::string& rest) {
    write("cart.toml",
          "name = \"cart\"\ngroup = \"r1\"\ninertia = [1]\nforce = [\"force\"]\n"
          "[inputs]\nforce = { unit = \"N\" }\n");
    write("plan.toml", "system = \"" + file("cart.toml") +
                           "\"\nsteps = 20\ninputs = [\"force\"]\n" + rest +
                           "[from]\nvelocity = [0]\n[to]\nconfiguration = [1]\nvelocity = [0]\n");
  }
};

// J = 6 M^2 d^2/T^3/(1 - 1/N^2).
TEST_F(PlansOfTheProgram, RestToRestIsTheClosedValue) {
  write_cart("until = 2\n");
  const Json out = plan("plan.toml");
  EXPECT_EQ(out["status"], "ok");
  EXPECT_EQ(out["solver"], "riccati");
  EXPECT_EQ(out["steps"], 20);
  EXPECT_EQ(out["t"].size(), 21);
  EXPECT_EQ(out["inputs"]["force"].size(), 20);
  EXPECT_EQ(out["states"]["x1"].size(), 21);
  EXPECT_NEAR(out["objective"].get<double>(), 0.75 / (1 - 1.0 / 400), 1e-9);
  EXPECT_LE(out["defect_max"].get<double>(), 1e-10);
}

// T^4 = 18 M^2 d^2/(1 - 1/N^2), cost 4T/3.
TEST_F(PlansOfTheProgram, AFreeTimeIsTheClosedValue) {
  write_cart("until = { free = true, least = 0.5, most = 8 }\ncost = { time = 1 }\n");
  const Json out = plan("plan.toml");
  EXPECT_EQ(out["status"], "ok");
  EXPECT_NEAR(out["objective"].get<double>(), 2.748075351524, 1e-8);
  EXPECT_NEAR(out["until"].get<double>(), 0.75 * 2.748075351524, 1e-6);
}

// A force of 0.8 N takes 1 kg from rest to rest in 2 s over 0.8 m at most.
TEST_F(PlansOfTheProgram, AGoalOutOfReachIsSaid) {
  write_cart("until = 2\nbounds = { force = [-0.8, 0.8] }\n");
  const Json out = plan("plan.toml", 1);
  EXPECT_EQ(out["status"], "out_of_reach");
  EXPECT_LT(out["missed"]["x1"].get<double>(), -0.05);
  EXPECT_GT(out["missed"]["x1"].get<double>(), -0.2);
  for (const Json& u : out["inputs"]["force"]) EXPECT_LE(std::abs(u.get<double>()), 0.8);
}

TEST_F(PlansOfTheProgram, ASleighIsParkedAsideAndARunRepeatsIt) {
  for (const char* name : {"pushed_sleigh.toml", "parking.toml"})
    write(name, source_file(std::string("tests/examples/") + name));
  const Json out = plan("parking.toml");
  EXPECT_EQ(out["status"], "ok");
  EXPECT_NEAR(out["objective"].get<double>(), 4.36573, 5e-6);
  EXPECT_NEAR(out["multipliers"]["adjoint"][100][2].get<double>(),
              out["multipliers"]["goal"]["y"].get<double>(), 1e-6);
  ASSERT_EQ(run({"plan", file("parking.toml"), "-o", file("plan.csv"), "--quiet"}).status, 0);
  const std::string table = file("plan.csv") + ":hold";
  const Outcome repeated = run({"run", "pushed_sleigh.toml", "--scheme", "lift", "--retraction",
                                "exp", "--s", "0", "--step", "0.04", "--until", "4", "--input",
                                "torque=" + table, "--input", "force=" + table, "--json"});
  ASSERT_EQ(repeated.status, 0) << repeated.err;
  const Json end = Json::parse(repeated.out)["final"];
  for (const Json& v : end["velocity"]) EXPECT_NEAR(v.get<double>(), 0, 1e-9);
  EXPECT_NEAR(end["element"][0][2].get<double>(), 0, 1e-9);  // x
  EXPECT_NEAR(end["element"][1][2].get<double>(), 1, 1e-9);  // y
}

// The system's file is beside the plan's, not where the program runs.
TEST_F(PlansOfTheProgram, WritesTheGainsOfAFeedback) {
  std::filesystem::create_directory(file("plans"));
  write("plans/cart.toml",
        "name = \"cart\"\ngroup = \"r1\"\ninertia = [1]\nforce = [\"force\"]\n"
        "[inputs]\nforce = { unit = \"N\" }\n");
  write("plans/plan.toml",
        "system = \"cart.toml\"\nsteps = 20\nuntil = 2\ninputs = [\"force\"]\n"
        "[from]\nvelocity = [0]\n[to]\nconfiguration = [1]\nvelocity = [0]\n");
  const Outcome out = run({"plan", "plans/plan.toml", "--track", file("gains.csv"), "--quiet"});
  ASSERT_EQ(out.status, 0) << out.err;
  std::ifstream in(file("gains.csv"));
  std::string line;
  for (int i = 0; i < 3; ++i) std::getline(in, line);
  EXPECT_EQ(line, "t,d(force)/d(eta.x1'),d(force)/d(x1')");
  int rows = 0;
  while (std::getline(in, line)) ++rows;
  EXPECT_EQ(rows, 20);
  EXPECT_EQ(run({"plan", "plans/plan.toml", "--track", "gains.txt"}).status, 2);
}

TEST_F(PlansOfTheProgram, RefusesMistakesWithTheirPlaces) {
  const auto refused = [&](const std::string& text, const std::string& message) {
    write("bad.toml", text);
    const Outcome out = run({"plan", file("bad.toml")});
    EXPECT_EQ(out.status, 2);
    EXPECT_THAT(out.err, HasSubstr(message));
  };
  const std::string good =
      "system = \"segway\"\nuntil = 1\nsteps = 5\ninputs = [\"left_torque\"]\n";
  refused("system = \"segway\"\nuntil = 1\nstps = 5\ninputs = [\"left_torque\"]\n",
          "bad.toml:3:8: unknown key 'stps'");
  refused("system = \"segway\"\nuntil = 1\nsteps = 5\ninputs = [\"left_torqe\"]\n",
          "bad.toml:4:10: unknown input of segway 'left_torqe'");
  refused("system = \"segwy\"\nuntil = 1\nsteps = 5\ninputs = [\"left_torque\"]\n",
          "bad.toml:1:10: unknown system 'segwy'");
  refused(good + "[to]\nconfiguration = [1]\n",
          "bad.toml:6:17: to.configuration: got 1 entries, expected 6 (theta, x, y");
  refused(good + "[cost]\nrunning = \"vv1\"\n", "did you mean 'v1'?");
  refused(good + "[bounds]\npitch = [1, -1]\n", "got [1, -1], expected low < high");
  refused(good + "constraints = [\"v1 + 3\"]\n", "expected 'formula >= formula'");
  refused("system = \"snakeboard\"\nuntil = 1\nsteps = 5\ninputs = [\"rotor_rate\"]\n",
          "'rotor_rate' of snakeboard is the rate of a row");
}

}  // namespace
