// Systems by data alone, and hamel describe --analyse.
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

using DataSystem = CommandLine;

constexpr const char* kKnife = R"(
group = "se2"
inertia = [0.1, 1, 1]
constraints = [[0, 0, 1]]
velocity = [1, 0, 0]
potential = "-2.899053227347741*x"
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

TEST_F(DataSystem, ProductsPotentialAndFriction) {
  const json r = record({write(R"(
name = "two oscillators"
group = "r1*so2"
inertia = [2, 3]
velocity = [0, 1]
potential = "0.5*8*(x1_1 - 1)^2"
force = [0, "-0.6*theta_2'"]
)"),
                         "--until", "3", "--step", "0.002"});
  // 2 x'' = -8 (x - 1):  x = 1 - cos 2t;  3 w' = -0.6 w:  w = exp(-0.2 t).
  EXPECT_NEAR(r["final"]["velocity"][0], 2 * std::sin(6), 1e-4);
  EXPECT_NEAR(r["final"]["velocity"][1], std::exp(-0.6), 1e-6);
  EXPECT_EQ(r["system"], "two oscillators");
}

/// A force that has no value at the end of a step: the step fails, and the states before it are
/// kept.
TEST_F(DataSystem, AValueThatIsNotFiniteIsNoStep) {
  const std::string path = write(
      "group = \"r1\"\ninertia = [1]\ncoordinates = [\"x\"]\nforce = [\"sqrt(0.495 - "
      "t)\"]\nvelocity = [1]\n");
  for (const char* scheme : {"lift", "balance", "gni", "unadapted", "reversible", "rkmk4"}) {
    for (const char* until : {"0.5", "1"}) {
      const Outcome o = run({"run", path, "--scheme", scheme, "--until", until, "--json"});
      EXPECT_EQ(o.status, 1) << scheme;
      EXPECT_THAT(o.err, HasSubstr("a value that is not finite")) << scheme;
      const json record = json::parse(o.out);
      EXPECT_TRUE(record["final"]["velocity"][0].is_number()) << scheme;
      EXPECT_EQ(record["steps"], 49) << scheme;
    }
  }
}

constexpr const char* kSlide = R"(
name = "sled"
group = "r2"
coordinates = ["x", "y"]
inertia = ["m", "m"]
potential = "-m*g*x"
force = ["push", 0]
velocity = ["v", 0]
[parameters]
m = { value = 2, unit = "kg", meaning = "mass", least = 0.5 }
g = { value = 1.5, unit = "m/s^2" }
v = 1
[inputs]
push = { unit = "N", meaning = "from behind", least = 0, most = 4 }
[events]
far = { value = "x - 3", meaning = "3 m away", direction = 1 }
[invariants]
across = "m*y'"
)";

/// Set, driven, watched and recorded like a registered system: x = v t + g t^2/2 + (push/m) t^2/2.
TEST_F(DataSystem, ParametersInputsAndEvents) {
  const std::string sled = write(kSlide);
  const json plain = record({sled, "--until", "1"});
  EXPECT_NEAR(plain["final"]["configuration"][0], 1 + 0.75, 1e-12);
  EXPECT_EQ(plain["parameters"]["m"], 2.0);
  EXPECT_EQ(plain["diagnostics"]["invariants"]["across"]["drift_max"], 0.0);
  const json set = record({sled, "--until", "1", "--set", "g=4", "--set", "v=0.5", "--input",
                           "push=2", "--stop-at", "far"});
  EXPECT_NEAR(set["final"]["configuration"][0], 0.5 + 2 + 0.5, 1e-12);
  EXPECT_EQ(set["parameters"]["v"], 0.5);
  EXPECT_NEAR(set["diagnostics"]["work"].get<double>(), 2 * 3, 1e-10);
  EXPECT_NEAR(record({sled, "--stop-at", "far"})["time"], (std::sqrt(1 + 2 * 1.5 * 3) - 1) / 1.5,
              1e-10);
  for (const auto& [arguments, message] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--set", "mm=1"}, "did you mean 'm'?"},
           {{"--set", "m=0.1"}, "got 0.1, expected at least 0.5"},
           {{"--input", "psh=1"}, "did you mean 'push'?"},
           {{"--input", "push=5"}, "[0, 4]"},
           {{"--stop-at", "fra"}, "did you mean 'far'?"}}) {
    std::vector<std::string> all = {"run", sled};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 2) << message;
    EXPECT_THAT(o.err, HasSubstr(message));
  }
}

/// Machine code and the interpreter give the same bits: rows are equal as text.
TEST_F(DataSystem, RunsTheSameWithoutMachineCode) {
  const auto rows = [&](const std::string& before) {
    const Outcome o = run(
        {"run", std::string(std::getenv("HAMEL_SOURCE")) + "/tests/examples/scooter_by_rows.toml",
         "--input", "torque=0.02", "--until", "5", "-o", file("rows.csv"), "--quiet"},
        before);
    EXPECT_EQ(o.status, 0) << o.err;
    const std::string text = contents(file("rows.csv"));
    return text.substr(0, text.find("\n#"));
  };
  const std::string with = rows("");
  EXPECT_GT(with.size(), 1000u);
  EXPECT_EQ(rows("HAMEL_NO_MACHINE_CODE=1 exec "), with);
}

TEST_F(DataSystem, IsDescribed) {
  const Outcome o = run({"describe", write(kSlide), "--json"});
  ASSERT_EQ(o.status, 0) << o.err;
  const json all = json::parse(o.out);
  EXPECT_EQ(all["formulas"], (json{{"inertia[1, 1]", "m"},
                                   {"inertia[2, 2]", "m"},
                                   {"potential", "-m*g*x"},
                                   {"force[1]", "push"}}));
  EXPECT_EQ(all["columns"], (json{"x", "y"}));
  EXPECT_EQ(all["rates"], (json{"x'", "y'"}));
  EXPECT_EQ(all["inputs"][0]["range"], "in [0, 4]");
  EXPECT_EQ(all["parameters"][1]["meaning"], "mass");
  EXPECT_EQ(all["events"][0]["name"], "far");
  EXPECT_EQ(all["invariants"], json{"across"});
}

/// A parameter of a file is swept in a study.
TEST_F(DataSystem, IsStudied) {
  const std::string sled = write(kSlide);
  std::ofstream(file("study.toml"))
      << "until = 1\nstep = [0.1, 0.05]\nscheme = ['lift']\n"
      << "[[system]]\nname = '" << sled << "'\nset = { g = 1 }\n"
      << "[[system]]\nname = '" << sled
      << "'\nlabel = 'steep'\nset = { g = 3 }\ninputs = { push = 1 }\n";
  const Outcome o = run({"study", file("study.toml"), "-o", file("out"), "--json", "--quiet"});
  ASSERT_EQ(o.status, 0) << o.err;
  const Outcome wrong = [&] {
    std::ofstream(file("study.toml"), std::ios::app)
        << "[[system]]\nname = '" << sled << "'\nset = { h = 3 }\n";
    return run({"study", file("study.toml"), "-o", file("out2")});
  }();
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("unknown parameter"));
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
  // One direction is always closed; with the drift of its prescribed shape the board goes anywhere,
  // and the three rows of the shape are functions of time.
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

/// Inertia that is definite on the admissible velocities alone: x = cos t + 0.5 sin t moves both,
/// by every scheme whose step needs no inverse of the inertia.
TEST_F(DataSystem, MayHaveMasslessLinks) {
  const std::string system = write(R"(group = "r2"
inertia = [1, 0]
constraints = [[1, -1]]
configuration = [1, 1]
velocity = [0.5, 0.5]
potential = "0.5*x1^2"
)");
  const json moved = record({system, "--until", "1", "--step", "0.001"});
  EXPECT_EQ(moved["scheme"], "lift");
  for (const int i : {0, 1}) {
    EXPECT_NEAR(moved["final"]["element"][i][2].get<double>(), std::cos(1) + 0.5 * std::sin(1),
                1e-6);
  }
  const json open = record({system, "--until", "1"});
  EXPECT_EQ(open["scheme"], "dop853");
  EXPECT_NEAR(open["final"]["element"][1][2].get<double>(), std::cos(1) + 0.5 * std::sin(1), 1e-7);
  for (const char* scheme : {"rkmk4", "tsit5", "dopri5", "rk4_projected", "balance"}) {
    const json any = record({system, "--until", "1", "--step", "0.001", "--scheme", scheme});
    EXPECT_NEAR(any["final"]["element"][1][2].get<double>(), std::cos(1) + 0.5 * std::sin(1), 1e-6)
        << scheme;
  }
  for (const char* scheme : {"gni", "reversible", "unadapted"}) {
    const Outcome o = run({"run", system, "--scheme", scheme});
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr("with massless links lift, balance and the explicit schemes"));
  }
}

/// Scalar states beside the coordinates of a group: a lag behind a place that moves at w, z = w (t
/// - T) + w T exp(-t/T); one with an input and the time, y = u t + t^2/2; a force that lags, m x''
/// = f, f' = (1 - f)/T.
TEST_F(DataSystem, MayHaveStates) {
  const std::string system = write(R"(group = "r2"
coordinates = ["x", "s"]
rates = ["v", "w"]
inertia = [2, 1]
force = ["pull", 0]
velocity = [0, 1.3]
[[state]]
name = "z"
rate = "(s - z)/T"
[[state]]
name = "y"
rate = "u + t"
[[state]]
name = "pull"
rate = "(1 - pull)/T"
[[state]]
name = "way"
rate = "(1 + z)*w"
[inputs]
u = { unit = "1", meaning = "a rate" }
[parameters]
T = { value = 0.4, unit = "s", meaning = "lag", least = 0.01 }
)");
  const double t = 2, T = 0.4, w = 1.3, left = std::exp(-t / T);
  const double z = w * (t - T) + w * T * left;
  const double sum = w * (t * t / 2 - T * t) + w * T * T * (1 - left);  // of z over the time
  const std::vector<double> expected = {(t * t / 2 - T * t + T * T * (1 - left)) / 2,
                                        w * t,
                                        z,
                                        0.7 * t + t * t / 2,
                                        1 - left,
                                        w * (t + sum)};
  for (const Words& method :
       {Words{"--rtol", "1e-11"}, Words{"--scheme", "rkmk4", "--step", "1e-3"},
        Words{"--scheme", "lift", "--step", "1e-4"}}) {
    SCOPED_TRACE(method[1]);
    Words line = {system, "--until", "2", "--input", "u=0.7"};
    line.insert(line.end(), method.begin(), method.end());
    const json end = record(line);
    const double near = method[1] == "lift" ? 1e-7 : 1e-9;
    EXPECT_EQ(end["group"], "r2*r4");
    EXPECT_NEAR(end["final"]["element"][0][0][2].get<double>(), expected[0], near);
    EXPECT_NEAR(end["final"]["element"][0][1][2].get<double>(), expected[1], near);
    for (const int i : {0, 1, 2, 3})
      EXPECT_NEAR(end["final"]["element"][1][i][4].get<double>(), expected[2 + i], near) << i;
    EXPECT_THAT(end["notes"].dump(), Not(HasSubstr("projected")));
  }
  EXPECT_EQ(record({system, "--until", "1", "--set", "T=0.1"})["status"], "ok");
  const auto said = [&](const std::string& state) {
    return run({"run", write("group = \"r1\"\ninertia = [1]\nvelocity = [1]\n" + state)}).err;
  };
  EXPECT_THAT(said("[[state]]\nname = \"z\"\n"),
              HasSubstr("state.rate: expected a formula linear in the velocities"));
  EXPECT_THAT(said("[[state]]\nname = \"z\"\nrate = \"xi1^2\"\n"),
              HasSubstr("system.toml:6:8: state.rate: expected a formula that is linear in the "
                        "velocities"));
  EXPECT_THAT(said("[[state]]\nname = \"2z\"\nrate = \"1\"\n"),
              HasSubstr("state.name: expected a name allowed in a formula, got '2z'"));
  EXPECT_THAT(said("[[state]]\nname = \"z\"\nrat = \"1\"\n"), HasSubstr("did you mean 'rate'?"));
  EXPECT_THAT(said("[[state]]\nname = \"x1\"\nrate = \"1\"\n"),
              HasSubstr("two things are called 'x1'"));
  EXPECT_THAT(said("potential = \"z\"\n[[state]]\nname = \"z\"\nrate = \"1\"\n"),
              HasSubstr("potential: unknown name 'z'"));
}

/// The page calls coordinates and rates as the file does, and finds which of them are places all
/// the same.
TEST_F(DataSystem, NamesTheCurvesOfThePage) {
  auto figures = curves({write(R"(
group = "se2*so2"
coordinates = ["heading", "east", "north", "wheel"]
rates = ["spin", "ahead", "aside", "roll"]
inertia = [0.1, 1, 1, 1]
constraints = [[0, 0, 1, 0]]
velocity = [0.5, 1, 0, 1]
)"),
                         "--until", "1"});
  if (figures.empty()) HAMEL_SKIP_WITHOUT("page");
  using testing::ElementsAre;
  EXPECT_THAT(figures["Path in the plane"], ElementsAre("east, north"));
  EXPECT_THAT(figures["Angular velocity"], ElementsAre("spin [rad/s]"));
  EXPECT_THAT(figures["Spin of wheels and rotors"], ElementsAre("roll [rad/s]"));
  EXPECT_THAT(figures["Velocity"], ElementsAre("ahead [m/s]", "aside [m/s]"));
  EXPECT_THAT(figures["Angles of wheels and rotors"], ElementsAre("wheel [rad]"));
  EXPECT_THAT(figures["Momentum in the body"],
              ElementsAre("mu of ahead [N s]", "mu of aside [N s]"));
}

}  // namespace
