// hamel steady --vary: branches are followed, crossings are what they are, and only digits that are
// known are printed.
#include <cmath>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Steady : public CommandLine {
 protected:
  json sweep(const std::string& file, const std::string& vary, bool branches = false) {
    std::vector<std::string> line = {"steady", file, "--vary", vary, "--json"};
    if (branches) line.push_back("--branches");
    const Outcome o = run(line);
    EXPECT_EQ(o.status, 0) << o.err;
    return json::parse(o.out);
  }
  std::string particle(const std::string& text) {
    return write("particle.toml", text + "[parameters]\np = 1\n");
  }
};

// A bob on a hinge on a shaft that turns at a prescribed rate: 1 m, 9.81 m/s^2.
std::string hoop(double angle) {
  return R"toml([parameters]
rate = { value = 4, unit = "rad/s" }
[[body]]
name = "shaft"
mass = 1
at = [0, 0, 0]
inertia = [0.1, 0.1, 0.1]
[[body]]
name = "bob"
mass = 1
at = [0, 0, -1]
inertia = [0, 0, 0]
[[joint]]
name = "shaft"
kind = "hinge"
child = "shaft"
axis = [0, 0, 1]
[[joint]]
name = "arm"
kind = "hinge"
parent = "shaft"
child = "bob"
axis = [0, 1, 0]
[[prescribed]]
joint = "shaft"
rate = "rate"
[start]
arm.angle = )toml" +
         std::to_string(angle) + "\n";
}

/// Hanging, stable up to sqrt(g/l), where the tilted motions begin, cos = g/(l rate^2); no other
/// change, whatever the guess and whichever way.
TEST_F(Steady, BobOnATurningShaft) {
  const double critical = std::sqrt(9.81);
  for (const char* vary : {"rate=2:6:9", "rate=6:2:9", "rate=2.9:5.3:4"}) {
    for (const double angle : {0.0, 0.5}) {
      const json s = sweep(write("hoop.toml", hoop(angle)), vary, true);
      ASSERT_EQ(s["crossings"].size(), 1u) << vary;
      const json& crossing = s["crossings"][0];
      EXPECT_NEAR(crossing["value"], critical, 1e-10);
      EXPECT_LT(crossing["round_off"], 1e-9);
      EXPECT_EQ(crossing["bifurcation"], "pitchfork");
      EXPECT_EQ(crossing["kind"], "real");
      const double rate = crossing["other"]["value"], tilt = crossing["other"]["element"][1];
      EXPECT_GT(rate, critical);
      EXPECT_NEAR(std::cos(tilt), 9.81 / (rate * rate), 1e-9);
      // The other branch, stable, up to the last value; it ends where it began.
      ASSERT_EQ(s["branches"].size(), 1u);
      EXPECT_TRUE(s["branches"][0]["crossings"].empty());
      for (const json& at : s["branches"][0]["vary"]) {
        const double there = at["value"];
        EXPECT_EQ(at["found"], there > critical) << there;
        if (there > critical) {
          const double angle_there = at["motion"]["element"][1];
          EXPECT_NEAR(std::cos(angle_there), 9.81 / (there * there), 1e-9);
        }
      }
      EXPECT_EQ(s["branches"][0]["end"]["bifurcation"], "pitchfork");
      EXPECT_NEAR(s["branches"][0]["end"]["value"], critical, 1e-5);
    }
  }
}

/// From the tilted motion, towards slower rates: the branch ends, and reports where and on what.
TEST_F(Steady, ATiltedBranchEndsAtThePitchfork) {
  const std::string file = write("hoop.toml", hoop(1.1));
  const Outcome o = run({"steady", file, "--vary", "rate=5:2:7"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("not on this branch"));
  EXPECT_THAT(o.out, HasSubstr("the branch ends at rate = 3.13"));
  EXPECT_THAT(o.out, HasSubstr("pitchfork"));
  EXPECT_THAT(o.out, Not(HasSubstr("stability changes")));
}

// V = x^3/3 - p x: x = sqrt(p), which turns back at 0 into -sqrt(p).
TEST_F(Steady, Fold) {
  const std::string file = particle(
      "group = \"r1\"\ninertia = [1]\npotential = \"x1^3/3 - p*x1\"\nconfiguration = [1]\n"
      "velocity = [0]\n");
  const json s = sweep(file, "p=1:-1:9", true);
  EXPECT_EQ(s["end"]["bifurcation"], "fold");
  EXPECT_NEAR(s["end"]["value"], 0, 1e-8);
  EXPECT_LT(s["end"]["other"]["element"][0], 0);
  ASSERT_EQ(s["branches"].size(), 1u);
  EXPECT_EQ(s["branches"][0]["vary"][0]["found"], true);
  EXPECT_NEAR(s["branches"][0]["vary"][0]["motion"]["element"][0], -1, 1e-10);
  EXPECT_NEAR(s["branches"][0]["vary"][0]["eigenvalues"][0][0], std::sqrt(2), 1e-9);
}

// A particle with V and drag, at rest at x.
std::string in_potential(const std::string& potential, double x) {
  return "group = \"r1\"\ninertia = [1]\npotential = \"" + potential +
         "\"\nforce = [\"-0.3*x1'\"]\nconfiguration = [" + std::to_string(x) +
         "]\nvelocity = [0]\n";
}

/// A value on the fold itself: as a start the motion is known to the square root of the residual,
/// and so are its eigenvalues, 0 and -0.3; a branch that comes to it ends there.
TEST_F(Steady, AValueOnTheFold) {
  const std::string file = particle(in_potential("x1^3/3 - p*x1", 1));
  const json from = sweep(file, "p=0:1:3");
  const json& fold = from["vary"][0];
  ASSERT_EQ(fold["found"], true);
  for (size_t i = 0; i < 2; ++i) {
    const double real = fold["eigenvalues"][i][0], error = fold["round_off"][i];
    EXPECT_LE(std::min(std::abs(real), std::abs(real + 0.3)), error);
  }
  const json to = sweep(file, "p=1:0:3");
  EXPECT_EQ(to["vary"][2]["found"], false);
  ASSERT_EQ(to["ends"].size(), 1u);
  EXPECT_EQ(to["ends"][0]["bifurcation"], "fold");
  EXPECT_NEAR(to["ends"][0]["value"], 0, 1e-10);
}

// V = x^3/3 - p x^2/2: x = 0 and x = p cross at 0.
TEST_F(Steady, Transcritical) {
  const std::string file = particle(
      "group = \"r1\"\ninertia = [1]\npotential = \"x1^3/3 - p*x1^2/2\"\nconfiguration = [0]\n"
      "velocity = [0]\n");
  const json s = sweep(file, "p=-1:1:6", true);
  ASSERT_EQ(s["crossings"].size(), 1u);
  EXPECT_EQ(s["crossings"][0]["bifurcation"], "transcritical");
  EXPECT_NEAR(s["crossings"][0]["value"], 0, 1e-10);
  ASSERT_EQ(s["branches"].size(), 1u);
  for (const json& at : s["branches"][0]["vary"]) {
    ASSERT_EQ(at["found"], true);
    EXPECT_NEAR(at["motion"]["element"][0], at["value"], 1e-10);
  }
}

/// No kind depends on the units of x or of p, nor on whether a value is on the bifurcation.
TEST_F(Steady, KindsHaveNoUnits) {
  for (const char* c : {"0.001", "1.5", "2000"}) {
    for (const char* unit : {"1", "0.001"}) {
      for (const std::string grid : {":5"}) {
        const std::string p = "(p/" + std::string(unit) + ")";
        const std::string range = "p=-" + std::string(unit) + ":" + std::string(unit) + grid;
        const json s =
            sweep(particle(in_potential("-0.5*" + p + "*x1^2 + " + c + "*x1^3/3", 0)), range, true);
        ASSERT_EQ(s["crossings"].size(), 1u) << c << " " << range;
        EXPECT_EQ(s["crossings"][0]["bifurcation"], "transcritical") << c << " " << range;
        EXPECT_NEAR(s["crossings"][0]["value"], 0, 1e-10 * std::stod(unit));
        ASSERT_EQ(s["branches"].size(), 1u);
        const json& last = s["branches"][0]["vary"].back();
        const double value = last["value"], x = last["motion"]["element"][0];
        EXPECT_NEAR(x * std::stod(c), value / std::stod(unit), 1e-9);
      }
    }
  }
}

// V = -p x^2/2 -+ x^4/4: halves x = sqrt(-+p) join at 0.
TEST_F(Steady, HalvesOfAPitchforkJoin) {
  for (const bool super : {true, false}) {
    const std::string file =
        particle(in_potential(std::string("-0.5*p*x1^2") + (super ? "+" : "-") + "0.25*x1^4", 0));
    for (const char* grid : {"p=-1:1:5", "p=-1:1:4", "p=1:-1:4"}) {
      const json s = sweep(file, grid, true);
      ASSERT_EQ(s["crossings"].size(), 1u) << grid;
      EXPECT_EQ(s["crossings"][0]["bifurcation"], "pitchfork");
      EXPECT_EQ(s["crossings"][0]["supercritical"], super);
      EXPECT_TRUE(s["ends"].empty());
      ASSERT_EQ(s["branches"].size(), 1u);
      const json& ends = s["branches"][0]["ends"];
      ASSERT_EQ(ends.size(), 1u);
      EXPECT_EQ(ends[0]["bifurcation"], "pitchfork");
      EXPECT_NEAR(ends[0]["value"], 0, 1e-9);
    }
  }
}

// V = -p x^2/2 - x^4/4 + x^6/6: subcritical at 0, a fold at -1/4, and stable motions behind it.
TEST_F(Steady, BranchesPassFolds) {
  const std::string file = particle(in_potential("-0.5*p*x1^2 - 0.25*x1^4 + x1^6/6", 0));
  for (const char* grid : {"p=-1:1:5", "p=-1:1:9"}) {
    const json s = sweep(file, grid, true);
    ASSERT_EQ(s["crossings"].size(), 1u);
    EXPECT_EQ(s["crossings"][0]["supercritical"], false);
    ASSERT_EQ(s["branches"].size(), 2u);
    std::vector<std::string> kinds;
    for (const json& end : s["branches"][0]["ends"]) kinds.push_back(end["bifurcation"]);
    EXPECT_THAT(kinds, testing::UnorderedElementsAre("fold", "pitchfork"));
    const json& behind = s["branches"][1];
    ASSERT_EQ(behind["ends"].size(), 1u);
    EXPECT_EQ(behind["ends"][0]["bifurcation"], "fold");
    EXPECT_EQ(behind["ends"][0]["towards"], "first");
    EXPECT_NEAR(behind["ends"][0]["value"], -0.25, 1e-9);
    const json& last = behind["vary"].back();
    const double x = last["motion"]["element"][0];
    EXPECT_NEAR(x * x, 0.5 + std::sqrt(0.25 + 1), 1e-9);
    EXPECT_LT(last["eigenvalues"][0][0], 0);
  }
  const Outcome o = run({"steady", file, "--vary", "p=-1:1:5", "--branches"});
  EXPECT_THAT(o.out, HasSubstr("it turns back (fold) and continues"));
  EXPECT_THAT(o.out, HasSubstr("it joins another one as one of its halves (pitchfork)"));
  EXPECT_THAT(o.out, HasSubstr("the branch leaves the range at p = 1"));
}

/// Two go out, one comes in, on a grid of four values: weave, then capsize.
TEST_F(Steady, CoarseGridOfTheBicycle) {
  const json s = sweep("bicycle", "speed=1:10:4");
  ASSERT_EQ(s["crossings"].size(), 2u);
  EXPECT_EQ(s["crossings"][0]["kind"], "pair");
  EXPECT_NEAR(s["crossings"][0]["value"], 4.29238253634111, 1e-9);
  EXPECT_EQ(s["crossings"][1]["kind"], "real");
  EXPECT_NEAR(s["crossings"][1]["value"], 6.02426201538837, 1e-9);
}

// x'' = -x + (p - 0.1) x', y'' = (0.1 - p) y - y': a pair comes in where a real one goes out.
TEST_F(Steady, OneComesInWhereAnotherGoesOut) {
  const std::string file = particle(
      "group = \"r2\"\ninertia = [1, 1]\nforce = [\"-x1 + (p - 0.13)*x1' - x1'^3\", "
      "\"(0.1 - p)*x2 - x2' - x2^3\"]\nconfiguration = [0, 0]\nvelocity = [0, 0]\n");
  for (const char* grid : {"p=-1:1:2", "p=-1:1:5", "p=0.1:0.2:3"}) {
    const json s = sweep(file, grid);
    const bool starts_there = std::string(grid) == "p=0.1:0.2:3";
    ASSERT_EQ(s["crossings"].size(), starts_there ? 1u : 2u) << grid;
    EXPECT_EQ(s["crossings"].back()["bifurcation"], "hopf");
    EXPECT_NEAR(s["crossings"].back()["value"], 0.13, 1e-9);
    if (starts_there) continue;
    EXPECT_EQ(s["crossings"][0]["bifurcation"], "pitchfork");
    EXPECT_NEAR(s["crossings"][0]["value"], 0.1, 1e-9);
  }
}

// x'' = -x + p x' - x'^3: rest loses its stability to an oscillation at p = 0.
TEST_F(Steady, Hopf) {
  const std::string file = particle(
      "group = \"r1\"\ninertia = [1]\npotential = \"0.5*x1^2\"\nforce = [\"p*x1' - x1'^3\"]\n"
      "configuration = [0]\nvelocity = [0]\n");
  const json s = sweep(file, "p=-1:1:4");
  ASSERT_EQ(s["crossings"].size(), 1u);
  EXPECT_EQ(s["crossings"][0]["bifurcation"], "hopf");
  EXPECT_EQ(s["crossings"][0]["kind"], "pair");
  EXPECT_NEAR(s["crossings"][0]["value"], 0, 1e-10);
  EXPECT_TRUE(s["crossings"][0]["other"].is_null());
}

// x'' = p x + 0.6 y', y'' = p y - 0.6 x': a hill that a turning frame makes stable up to p = 0.3^2.
TEST_F(Steady, HamiltonianHopf) {
  const std::string file = particle(
      "group = \"r2\"\ninertia = [1, 1]\npotential = \"-0.5*p*(x1^2 + x2^2)\"\n"
      "force = [\"0.6*x2'\", \"-0.6*x1'\"]\nconfiguration = [0, 0]\nvelocity = [0, 0]\n");
  const json s = sweep(file, "p=0.02:0.2:5");
  ASSERT_EQ(s["crossings"].size(), 1u);
  EXPECT_EQ(s["crossings"][0]["bifurcation"], "hamiltonian_hopf");
  EXPECT_NEAR(s["crossings"][0]["value"], 0.09, 1e-11);
  EXPECT_LT(s["crossings"][0]["round_off"], 1e-10);
  const Outcome o = run({"steady", file, "--vary", "p=0.02:0.2:5"});
  EXPECT_THAT(o.out, HasSubstr("stability changes at p = 0.0900000000"));
}

/// The speed is varied like a parameter where the system defines one, and is offered like one.
TEST_F(Steady, NamesWhatMayVary) {
  EXPECT_THAT(run({"steady", "bicycle", "--vary", "spead=1:8:15"}).err,
              testing::AllOf(HasSubstr("--vary: unknown parameter of bicycle 'spead'"),
                             HasSubstr("did you mean 'speed'?")));
  EXPECT_THAT(run({"steady", "suslov", "--vary", "speed=1:8:15"}).err,
              HasSubstr("unknown parameter of suslov 'speed': expected one of inertia, normal"));
}

TEST_F(Steady, BranchesNeedAParameter) {
  EXPECT_THAT(run({"steady", "bicycle", "--speed", "5", "--branches"}).err,
              HasSubstr("give --vary"));
}

}  // namespace
