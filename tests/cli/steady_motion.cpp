// hamel steady: only digits that are known are printed, and no verdict that its error covers.
#include <cmath>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class SteadyMotion : public CommandLine {
 protected:
  std::string particle(const std::string& text) {
    return write("particle.toml", text + "[parameters]\np = 1\n");
  }
};

/// A fourfold -1 and a fourfold 0 in one block of four: the digits that are printed are right, and
/// none that is wrong is.
TEST_F(SteadyMotion, DigitsThatAreKnown) {
  const std::string critical = particle(
      "group = \"r2\"\ninertia = [1, 1]\n"
      "force = [\"-2*x1' - x1 + x2\", \"-2*x2' - x2\"]\nconfiguration = [0, 0]\n"
      "velocity = [0, 0]\n");
  const json s = json::parse(run({"steady", critical, "--json"}).out);
  ASSERT_EQ(s["eigenvalues"].size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_GT(s["round_off"][i], 1e-6);
    EXPECT_NEAR(s["eigenvalues"][i][0], -1, s["round_off"][i]);
    EXPECT_NEAR(s["eigenvalues"][i][1], 0, s["round_off"][i]);
  }
  EXPECT_THAT(run({"steady", critical}).out, Not(HasSubstr("0.99999")));
  const std::string drifting = particle(
      "group = \"r2\"\ninertia = [1, 1]\n"
      "force = [\"p*x2 - 1e-3*x1^3\", \"-x2^3\"]\nconfiguration = [0, 0]\nvelocity = [0, 0]\n");
  const json zero = json::parse(run({"steady", drifting, "--json"}).out);
  EXPECT_TRUE(zero["eigenvalues"].empty()) << zero["eigenvalues"];
  EXPECT_EQ(zero["neutral"], 4);
}

/// A, B, C by names, and the pair for a sample time; for small h it is 1 + A h and B h.
/// The velocity has names, without digits that are round-off; the start can be given again.
TEST_F(SteadyMotion, AStartToCopy) {
  const Outcome o = run({"steady", "falling_disk", "--speed", "3"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("  velocity      omega1 = 0, omega2 = 0, omega3 = 6, v1 = -3, "
                               "v2 = 0, v3 = 0\n"));
  const std::string start = "--configuration 1,0,0,0,0,-1,0,1,0,0,0,0.5 --velocity 0,0,6,-3,0,0";
  EXPECT_THAT(o.out, HasSubstr("  as a start    " + start + "\n"));
  const Outcome again = run({"steady", "falling_disk", "--configuration",
                             "1,0,0,0,0,-1,0,1,0,0,0,0.5", "--velocity", "0,0,6,-3,0,0"});
  EXPECT_THAT(again.out, HasSubstr(start));
}

TEST_F(SteadyMotion, LinearisationForControl) {
  const json s = answer({"steady", "segway", "--speed", "1", "--sample-time", "1e-6"});
  const json& linear = s["linearisation"];
  const size_t n = linear["states"].size();
  EXPECT_THAT(linear["states"].get<std::vector<std::string>>(), testing::Contains("pitch"));
  EXPECT_EQ(linear["inputs"], json({"right_torque", "left_torque"}));
  ASSERT_EQ(linear["A"].size(), n);
  ASSERT_EQ(linear["B"].size(), n);
  EXPECT_EQ(linear["C"].size(), linear["quantities"].size());
  const json& pair = linear["discrete"];
  EXPECT_EQ(pair["sample_time"], 1e-6);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) {
      const double a = linear["A"][i][j], sampled = pair["A"][i][j];
      EXPECT_NEAR(sampled, (i == j ? 1 : 0) + 1e-6 * a, 1e-9);
    }
    for (size_t j = 0; j < 2; ++j) {
      const double b = linear["B"][i][j], sampled = pair["B"][i][j];
      EXPECT_NEAR(sampled, 1e-6 * b, 1e-9);
    }
  }
  EXPECT_THAT(run({"steady", "segway", "--sample-time", "-1", "--json"}).err,
              HasSubstr("--sample-time"));
}

/// A hill that a turning frame makes stable: real parts are 0 to their errors, which is no verdict
/// (JSON null). With friction there is one.
TEST_F(SteadyMotion, VerdictsThatErrorsCover) {
  const auto hill = [&](const std::string& friction) {
    return particle(
        "group = \"r2\"\ninertia = [1, 1]\npotential = \"-0.025*(x1^2 + x2^2)\"\n"
        "force = [\"0.6*x2'" +
        friction + "*x1'\", \"-0.6*x1'" + friction +
        "*x2'\"]\nconfiguration = [0, 0]\nvelocity = [0, 0]\n");
  };
  const std::string open = hill("-0");
  const json s = answer({"steady", open});
  EXPECT_TRUE(s["growing"].is_null());
  EXPECT_EQ(s["eigenvalue_errors"].size(), s["eigenvalues"].size());
  EXPECT_THAT(run({"steady", open}).out, HasSubstr("not decided: no mode grows faster than"));
  const json swept = answer({"steady", open, "--vary", "p=0:1:2"})["vary"];
  EXPECT_TRUE(swept[0]["growing"].is_null());
  EXPECT_EQ(swept[0]["eigenvalue_errors"].size(), 4u);
  const std::string grows = hill("+0.01");
  EXPECT_EQ(answer({"steady", grows})["growing"], 2);  // the fast pair
  const json linear = answer({"steady", grows})["linearisation"];
  for (const char* name : {"A", "B", "C"})
    EXPECT_EQ(linear["errors"][name].size(), linear[name].size());
}

}  // namespace
