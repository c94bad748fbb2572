// hamel plan: closed facts by files, the run that repeats a plan, mistakes.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

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

// A force of 0.8 N takes 1 kg from rest to rest in 2 s over 0.8 m at most. With a miss of a rate
// over 0.4 s, a fifth of the duration, as one of a length, and the force reversed r before the end:
//   x = 1.6 - 0.8 r^2,  v = 1.6 (1 - r),  (x - 1)^2 + (0.4 v)^2 least at r = 0.8889.
TEST_F(PlansOfTheProgram, AGoalOutOfReachIsSaid) {
  write_cart("until = 2\nbounds = { force = [-0.8, 0.8] }\n");
  const Json out = plan("plan.toml", 1);
  EXPECT_EQ(out["status"], "out_of_reach");
  EXPECT_NEAR(out["missed"]["x1"].get<double>(), -0.0322, 2e-3);  // by 20 steps
  EXPECT_NEAR(out["missed"]["x1'"].get<double>(), 0.178, 2e-3);
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

// The gait ends in the shape of its start, at rest: the same torques again go as far again.
TEST_F(PlansOfTheProgram, AGaitOfTheSnakeboardCanBeRepeated) {
  for (const char* name : {"pushed_snakeboard.toml", "planned_gait.toml"})
    write(name, source_file(std::string("tests/examples/") + name));
  const Json out = plan("planned_gait.toml");
  ASSERT_EQ(out["status"], "ok");
  EXPECT_NEAR(out["objective"].get<double>(), 0.18075949, 1e-7);
  std::string table = "t,rotor,steer\n";
  const std::vector<double> rotor = out["inputs"]["rotor"], steer = out["inputs"]["steer"];
  for (std::size_t k = 0; k <= 2 * rotor.size(); ++k) {
    const std::size_t at = k % rotor.size();
    table += std::to_string(0.1 * static_cast<double>(k));
    for (const double u : {rotor[at], steer[at]}) table += "," + Json(u).dump();
    table += "\n";
  }
  write("twice.csv", table);
  const Outcome repeated =
      run({"run", "pushed_snakeboard.toml", "--scheme", "lift", "--step", "0.1", "--until", "8",
           "--input", "rotor=" + file("twice.csv") + ":hold", "--input",
           "steer=" + file("twice.csv") + ":hold", "--json"});
  ASSERT_EQ(repeated.status, 0) << repeated.err;
  const Json end = Json::parse(repeated.out)["final"];
  for (const Json& v : end["velocity"]) EXPECT_NEAR(v.get<double>(), 0, 1e-8);
  EXPECT_NEAR(end["element"][0][0][2].get<double>(), 0.6, 1e-8);  // x
  EXPECT_NEAR(end["element"][0][1][2].get<double>(), 0, 1e-8);    // y
}

// A mechanism. A bicycle steers to the other side first; its lean is that of the turn.
TEST_F(PlansOfTheProgram, ABicycleChangesItsLaneByTheTorqueOfItsFork) {
  write("lane_change.toml", source_file("tests/examples/lane_change.toml"));
  const Json out = plan("lane_change.toml");
  ASSERT_EQ(out["status"], "ok");
  EXPECT_LE(out["defect_max"].get<double>(), 1e-10);
  const std::vector<double> y = out["states"]["y"], steer = out["states"]["steer.angle"],
                            lean = out["states"]["R32"], v1 = out["states"]["v1"];
  ASSERT_EQ(y.size(), 61u);
  EXPECT_LT(steer[4], -0.01);
  EXPECT_LT(y[10], -0.01);
  EXPECT_NEAR(y[60], 1, 1e-9);
  EXPECT_NEAR(steer[60], 0, 1e-9);
  EXPECT_NEAR(lean[60], 0, 1e-9);
  EXPECT_NEAR(v1[60], 5, 0.02);  // the energy that the torque leaves
  ASSERT_EQ(run({"plan", file("lane_change.toml"), "-o", file("lane.csv"), "--quiet"}).status, 0);
  const Outcome repeated =
      run({"run", "bicycle", "--scheme", "lift", "--retraction", "exp", "--step", "0.05", "--until",
           "3", "--configuration", "1,0,0,0,1,0,0,0,1,0,0,0.3,0,0,0", "--velocity",
           "0,0,0,5,0,0,0,16.666666666666668,14.285714285714286", "--input",
           "steer.torque=" + file("lane.csv") + ":hold", "--json"});
  ASSERT_EQ(repeated.status, 0) << repeated.err;
  EXPECT_NEAR(Json::parse(repeated.out)["final"]["element"][0][1][3].get<double>(), 1, 1e-7);
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
