// hamel fit: numbers from recordings, its JSON, files and mistakes.
#include <cmath>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;

class FitCommand : public CommandLine {
 protected:
  // A recorded sleigh: offset 0.2, start (1, 1).
  std::string recording() {
    EXPECT_EQ(run({"run", "chaplygin_sleigh", "--set", "mass=1", "--set", "inertia=1", "--set",
                   "offset=0.2", "--velocity", "1,1,0", "--rtol", "1e-11", "--output-step", "0.05",
                   "--until", "4", "-o", "s.csv"})
                  .status,
              0);
    return "s.csv";
  }
  std::vector<std::string> fit(const std::string& data, std::vector<std::string> more) {
    std::vector<std::string> out = {"fit",     "chaplygin_sleigh", data,
                                    "--set",   "inertia=1",        "--velocity",
                                    "0.9,1,0", "--rtol",           "1e-11"};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
};

TEST_F(FitCommand, FindsTheSleighAndWritesItsRun) {
  const std::string data = recording();
  const json f =
      answer(fit(data, {"--set", "mass=1", "--fit", "offset=0.3:0:1,start.v1,start.omega",
                        "--sigma", "omega=0.01,v1=0.01", "-o", "fitted.toml"}));
  EXPECT_EQ(f["status"], "ok");
  EXPECT_EQ(f["names"], json({"offset", "start.v1", "start.omega"}));
  EXPECT_NEAR(f["parameters"]["offset"]["value"], 0.2, 1e-9);
  EXPECT_EQ(f["parameters"]["offset"]["unit"], "m");
  EXPECT_EQ(f["covariance"].size(), 3u);
  EXPECT_TRUE(f["undetermined"].empty());
  const json again = record({"--config", "fitted.toml"});
  EXPECT_NEAR(again["parameters"]["offset"], 0.2, 1e-9);
}

TEST_F(FitCommand, TakesSegments) {
  const json f = answer(fit(recording(), {"--fit", "offset=0.3,start.omega", "--segments", "3"}));
  EXPECT_EQ(f["status"], "ok");
  EXPECT_EQ(f["segments"], json({3}));
  EXPECT_NEAR(f["parameters"]["offset"]["value"], 0.2, 1e-9);
}

TEST_F(FitCommand, NamesWhatTheDataDoNotSee) {
  std::string velocities;  // the energy would give the scale
  for (const std::string& line : lines(contents(file(recording())))) {
    if (line.starts_with('#')) continue;
    const std::vector<std::string> cells = split(line);
    velocities += cells[0] + "," + cells[4] + "," + cells[5] + "\n";
  }
  const json f =
      answer(fit(write("v.csv", velocities), {"--fit", "mass=2,inertia=2,start.omega"}), 1);
  EXPECT_EQ(f["status"], "undetermined");
  ASSERT_EQ(f["undetermined"].size(), 1u);
  EXPECT_NEAR(f["undetermined"][0]["mass"], std::sqrt(0.5), 1e-5);
  EXPECT_NEAR(f["undetermined"][0]["inertia"], std::sqrt(0.5), 1e-5);
  EXPECT_TRUE(f["parameters"]["mass"]["sigma"].is_null());
}

TEST_F(FitCommand, ShowsDataAndFit) {
  const json page = page_by(fit(recording(), {"--fit", "offset", "--report", "page.html"}));
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_FALSE(figure_of(page, "omega: data and fit").is_null());
  EXPECT_FALSE(figure_of(page, "Residuals").is_null());
}

TEST_F(FitCommand, RefusesMistakes) {
  const std::string data = recording();
  const auto wrong = [&](const std::string& csv, const std::vector<std::string>& more) {
    const Outcome o = run(fit(csv, more));
    EXPECT_EQ(o.status, 2);
    return o.err;
  };
  EXPECT_THAT(wrong(data, {"--fit", "ofset"}), HasSubstr("did you mean 'offset'?"));
  EXPECT_THAT(wrong(data, {"--fit", "offset=1:0"}), HasSubstr("expected NAME, NAME=guess or"));
  EXPECT_THAT(wrong(data, {"--fit", "offset", "--segments", "0"}),
              HasSubstr("segments: got 0, expected a whole number from 1 to 81"));
  EXPECT_THAT(wrong(data, {"--fit", "offset", "--loss", "hubert"}),
              HasSubstr("--loss: got 'hubert', expected squares or huber:K"));
  EXPECT_THAT(wrong(write("bad.csv", "t,omega\n0,1\n1,one\n"), {"--fit", "offset"}),
              HasSubstr("bad.csv:3: column 2 (omega): got 'one'"));
  EXPECT_THAT(wrong(write("new.csv", "t,omga\n0,1\n1,1\n"), {"--fit", "offset"}),
              HasSubstr("column 2: unknown quantity 'omga'"));
  EXPECT_THAT(wrong("none.csv", {"--fit", "offset"}), HasSubstr("none.csv"));
}

}  // namespace
