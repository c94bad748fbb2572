// Systems by data alone, and hamel describe --analyse.
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;

class DataSystem : public CommandLine {
 protected:
  std::string write(const std::string& text) {
    std::ofstream(file("system.toml")) << text;
    return file("system.toml");
  }
  json record(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"--json", "--quiet"});
    const Outcome o = run(arguments);
    EXPECT_EQ(o.status, 0) << o.err;
    return json::parse(o.out);
  }
  void refused(const std::string& text, const std::string& message) {
    const Outcome o = run({"run", write(text)});
    EXPECT_EQ(o.status, 2) << text;
    EXPECT_THAT(o.err, HasSubstr(message)) << text;
  }
};

constexpr const char* kKnife = R"(
group = "se2"
inertia = [0.1, 1, 1]
constraints = [[0, 0, 1]]
velocity = [1, 0, 0]
[linear]
x = -2.899053227347741
)";

/// The knife edge on its incline, from data and compiled: m g sin(0.3) = 2.899053227347741.
TEST_F(DataSystem, RunsAsTheCompiledOne) {
  const json data = record({write(kKnife), "--until", "5"});
  const json compiled = record({"knife_edge_on_incline", "--until", "5"});
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(data["final"]["velocity"][i], compiled["final"]["velocity"][i], 1e-9);
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(data["final"]["element"][i][j], compiled["final"]["element"][i][j], 1e-9);
    }
  }
  EXPECT_NEAR(data["final"]["energy"], compiled["final"]["energy"], 1e-9);
}

/// Without potential, drift and damping it is a left-invariant system: the sleigh.
TEST_F(DataSystem, LeftInvariantOnesRunOnTheFastPath) {
  const json data = record({write(R"(
group = "se2"
inertia = [[0.14, 0, 0.2], [0, 1, 0], [0.2, 0, 1]]
constraints = [[0, 0, 1]]
velocity = [0.9, -1, 0]
)"),
                            "--scheme", "boxed"});
  const json compiled = record({"chaplygin_sleigh", "--scheme", "boxed"});
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(data["final"]["velocity"][i], compiled["final"]["velocity"][i], 1e-12);
  }
}

TEST_F(DataSystem, ProductsSpringsAndDamping) {
  const json r = record({write(R"(
name = "two oscillators"
group = "r1*so2"
inertia = [2, 3]
velocity = [0, 1]
[spring]
1_x1 = { stiffness = 8, rest = 1 }
[damping]
2 = 0.6
)"),
                         "--until", "3", "--step", "0.002"});
  // 2 x'' = -8 (x - 1):  x = 1 - cos 2t;  3 w' = -0.6 w:  w = exp(-0.2 t).
  EXPECT_NEAR(r["final"]["velocity"][0], 2 * std::sin(6), 1e-4);
  EXPECT_NEAR(r["final"]["velocity"][1], std::exp(-0.6), 1e-6);
  EXPECT_EQ(r["system"], "two oscillators");
}

TEST_F(DataSystem, MistakesAreNamed) {
  refused("inertia = [1]", "group: missing");
  refused("group = \"se4\"\ninertia = [1]", "did you mean 'se");
  refused("group = \"se2\"", "inertia: missing");
  refused("group = \"se2\"\ninertia = [1, 2]", ":2:11: inertia: expected 3 numbers");
  refused("group = \"se2\"\ninertia = [1, 2, nan]\nvelocity = [1, 0, 0]", "finite");
  refused("group = \"se2\"\ninertia = [1, 2, -3]\nvelocity = [1, 0, 0]", "positive definite");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\nconstraints = [[0, 0]]", "constraints");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\nconstrains = [[0, 0, 1]]",
          "did you mean 'constraints'?");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\nvelocity = [1, 0, 0]\n[linear]\nz = 1",
          "unknown column of se2 'z'");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\nvelocity = [1, 0, 0]\n[spring]\nx = 1",
          "spring.x: expected { stiffness");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\n[damping]\n4 = 1", "1 to 3, got '4'");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\n[spring]\nx = { stiffness = 1, rset = 2 }",
          ":4:29: unknown key 'rset': expected one of stiffness, rest; did you mean 'rest'?");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\n[spring]\nx = { rest = 2 }",
          ":4:5: spring.x: expected { stiffness");
  refused("name = 3\ngroup = \"se2\"\ninertia = [1, 2, 3]", ":1:8: name: expected a string");
  refused("group = 3\ninertia = [1, 2, 3]", ":1:9: group: expected a string");
  refused("summary = \"a skate\"\ngroup = \"se2\"\ninertia = [1, 2, 3]",
          ":1:11: unknown key 'summary'");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\nlinear = 1", ":3:10: linear: expected a table");
  refused("group = [", ":1:");
  const Outcome o = run({"run", file("none.toml")});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("cannot read"));
}

TEST_F(DataSystem, AnalysisSeesWhatASystemIs) {
  const auto analysis = [&](const std::string& name) {
    const Outcome o = run({"describe", "--analyse", name, "--json"});
    EXPECT_EQ(o.status, 0) << o.err;
    return json::parse(o.out);
  };
  const json sleigh = analysis("chaplygin_sleigh");
  EXPECT_EQ(sleigh["growth"], json({2, 3}));
  EXPECT_FALSE(sleigh["integrable"]);
  ASSERT_EQ(sleigh["conserved"].size(), 1u);
  EXPECT_EQ(sleigh["conserved"][0]["expression"], "E");
  EXPECT_EQ(analysis("falling_disk")["growth"], json({3, 4, 5}));  // the height is holonomic
  const json ball = analysis("chaplygin_ball");
  EXPECT_EQ(ball["growth"].back(), 5);
  EXPECT_EQ(analysis("suslov")["growth"], json({2, 3}));
  // One direction is always closed; with the drift of its prescribed shape the board goes anywhere, and the
  // three rows of the shape are functions of time.
  const json board = analysis("snakeboard");
  EXPECT_EQ(board["growth"], json({1, 2, 3}));
  EXPECT_TRUE(board["affine"]);
  EXPECT_FALSE(board["integrable"]);
  EXPECT_THAT(board["verdict"].get<std::string>(), HasSubstr("reach only 3 of 6 directions"));
  // A constraint that can be integrated: y stays where it is, or moves at a constant rate.
  const json rail =
      analysis(write("group = \"r2\"\ninertia = [1, 1]\nconstraints = [[0, 1]]\n"
                     "velocity = [1, 0]"));
  EXPECT_TRUE(rail["integrable"]);
  EXPECT_EQ(rail["growth"], json({1}));
  const json lift =
      analysis(write("group = \"r2\"\ninertia = [1, 1]\nconstraints = [[0, 1]]\n"
                     "drift = [0.3]\nvelocity = [1, 0.3]"));
  EXPECT_TRUE(lift["integrable"]);
  EXPECT_THAT(lift["verdict"].get<std::string>(), HasSubstr("with time"));
}

}  // namespace
