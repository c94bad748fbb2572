// Files of ensembles: what they may hold, and what each mistake is answered with, before anything
// runs.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/hamel.hpp>

#include "../run/refusal.hpp"

namespace {

using namespace hamel;
using testing::ElementsAre;
using testing::HasSubstr;

EnsembleConfig read(const std::string& text) {
  return parse_ensemble(text, "many.toml", registry());
}

TEST(EnsembleFile, HoldsTheOptionsOfARunAndWhatIsVaried) {
  const EnsembleConfig config = read(R"(system = "rattleback"
until = 3
grid = true
seed = 5
keep = ["end.omega3", { name = "turns", formula = "event.reversed.count" }, "at(1.5).R11"]
statistics_at = [1, 2]
statistics_of = ["omega3"]
quantiles = [0.1, 0.9]
class = { formula = "event.reversed.count > 0 ? 1 : 0", names = ["on", "back"] }
[set]
mass = 2
[vary]
start.omega3 = { range = [-2, -1, 3] }
skew = { values = [0.3, 0.4] }
gravity = { uniform = [9, 10] }
[histograms]
"end.omega3" = 20
turns = { bins = 4, range = [0, 4] }
[events]
fast = "omega3 > 2"
)");
  EXPECT_EQ(config.run.system, "rattleback");
  EXPECT_EQ(config.run.parameters.at("mass"), std::vector<double>{2});
  EXPECT_EQ(config.members, 6);
  ASSERT_EQ(config.vary.size(), 3u);
  EXPECT_EQ(config.vary[0].name, "start.omega3");
  EXPECT_THAT(config.vary[0].numbers, ElementsAre(-2, -1.5, -1));
  EXPECT_EQ(config.keep[1].name, "turns");
  EXPECT_EQ(config.histograms.at("turns").until, 4);
  EXPECT_EQ(config.where.at("vary.skew"), "many.toml:14:8");
}

TEST(EnsembleFile, MistakesHaveTheirPlace) {
  const std::string head = "system = 'rattleback'\nmembers = 3\n";
  const std::string keep = "keep = ['end.omega3']\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {head + keep + "[vary]\nskew = { range = [0, 1, 0] }", "many.toml:5:"},
      {head + keep + "[vary]\nskew = { range = [0, 1, 0] }", "no range is without members"},
      {head + keep + "[vary]\nskew = { values = [] }", "a list without values has no members"},
      {head + keep + "[vary]\nskew = { values = [1, 2] }", "2 values for 3 members"},
      {head + keep + "[vary]\nskw = { uniform = [0, 1] }", "did you mean 'skew'?"},
      {head + keep + "[vary]\nstart.omga3 = { uniform = [0, 1] }", "did you mean 'start.omega3'?"},
      {head + keep + "[vary]\nmass = { uniform = [-1, 1] }",
       "many.toml:5:8: vary.mass: got -1,1, expected positive"},
      {head + keep + "[vary]\nmass = { normal = [0.1, 5] }", "expected positive"},
      {head + keep + "[vary]\nmass = { normal = [0.1, 5] }", "vary.mass: member "},
      {head + keep + "[vary]\nmass = { uniform = [1, 1] }", "least below most"},
      {head + keep + "[vary]\nmass = { log_uniform = [0, 1] }", "0 < least < most"},
      {head + keep + "[vary]\nmass = 3", "expected one of { values = [...] }"},
      {head + keep + "[vary]\nstart.R11 = { uniform = [0, 1] }", "vary start.configuration"},
      {head + keep + "[vary]\nstart.configuration = { tau_normal = [1, 2] }", "one number or 6"},
      {head + "keep = ['end.omga3']", "many.toml:3:"},
      {head + "keep = ['end.omga3']", "did you mean 'omega3'?"},
      {head + "keep = ['event.revrsed.count']", "did you mean 'reversed'?"},
      {head + "keep = ['event.reversed']", "expected event.NAME.count or event.NAME.time"},
      {head + "keep = ['at(50).omega3']", "expected a time of the run, 0 to 20"},
      {head + "keep = ['at(x).omega3']", "at(x): expected a time"},
      {head + "keep = ['end.omega3 +']", "keep[0]"},
      {head + "keep = ['end.omega3', 'end.omega3']", "another column 'end.omega3'"},
      {head + "keep = ['skew']\n[vary]\nskew = { uniform = [0, 1] }",
       "keep[0]: there is another column 'skew'"},
      {head + keep + "[histograms]\n'end.omega2' = 3",
       "many.toml:5:16: histograms: unknown kept quantity 'end.omega2'"},
      {head + keep + "[histograms]\n'end.omega3' = 0", "1 to 100000 bins"},
      {head + "keep = []", "nothing is kept of a member"},
      {head + keep + "shceme = 'lift'", "did you mean 'scheme'?"},
      {head + keep + "scheme = 'lfit'", "many.toml:4:10: unknown scheme 'lfit'"},
      {head + keep + "check = true", "many.toml:4:9: check: not of the members of an ensemble"},
      {"system = 'rattleback'\nmembers = -3\n" + keep, "many.toml:2:11: members: got -3"},
      {"system = 'rattleback'\nmembers = 7\ngrid = true\n" + keep +
           "[vary]\nskew = { values = [0.1, 0.2] }",
       "expected a multiple of the 2 combinations"},
      {"system = 'suslov'\nmembers = 3\nkeep = ['end.omega1']\n[vary]\nstart.omega3 = { uniform = "
       "[1, 2] }",
       "the constraint rows of suslov leave no choice of it"},
      {head + "keep = ['end.work']",
       "many.toml:3:9: keep[0]: 'end.work': work: no forces and no moving constraints do work on "
       "rattleback"},
      {head + keep + "trajectories = [3]", "many.toml:4:16: trajectories: got 3, expected 0 to 2"},
      {head + keep + "trajectories = [0.5]", "expected the numbers of members, from 0"},
      {head + keep + "trajectories = [1e300]", "expected the numbers of members, from 0"},
      {"system = 'segway'\nmembers = 3\nkeep = ['end.t']\nstep = 0.01\ntrajectories = [1]\n"
       "[feedback]\nperiod = 0.01\nleft_torque = 'v1'",
       "trajectories: a run has no inputs by formulas"},
      {"system = 'none.toml'\nkeep = ['end.t']\n", "many.toml:1:10: system: cannot read"},
      {"system = 'segway'\nkeep = ['end.t']\n[inputs]\nleft_torque = 'none.csv'",
       "many.toml:3:1: input left_torque: cannot read"},
      {"system = 'suslov'\nstep = 0.1\n", "it has neither [vary] nor keep"},
      {"[[system]]\nname = 'suslov'\n", "a study (hamel study)"},
  };
  for (const auto& [text, message] : cases)
    EXPECT_THAT(refusal([&, &text = text] { read(text); }), HasSubstr(message)) << text;
}

/// HDF5 takes a / for a group, and a kept formula without a name may have one.
TEST(EnsembleFile, AKeptFormulaMayDivide) {
  const EnsembleConfig config = read(
      "system = 'rattleback'\nmembers = 3\nuntil = 0.1\n"
      "keep = ['end.energy', 'end.energy/start.energy', '1 / 2']\n"
      "[vary]\nstart.omega3 = { uniform = [1, 2] }\n");
  const EnsembleResult result = Ensemble(registry(), config).run();
  const std::vector<double>& ratio =
      std::get<0>(result.table.column("end.energy/start.energy").values);
  for (const double value : ratio) EXPECT_NEAR(value, 1, 1e-6);
  if (hdf5_version().empty()) return;
  const std::string folder = testing::TempDir() + "divided";
  result.write(folder);
  const Table table = read_hdf5(folder + "/ensemble.h5", nullptr);
  ASSERT_EQ(table.columns.size(), result.table.columns.size());
  for (size_t i = 0; i < table.columns.size(); ++i)
    EXPECT_EQ(table.columns[i].name, result.table.columns[i].name);
  EXPECT_EQ(std::get<0>(table.column("end.energy/start.energy").values), ratio);
  std::filesystem::remove_all(folder);
}

}  // namespace
