// The cells of a study: systems from data files, and schemes that do not use an axis.
#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "studies.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

constexpr const char* kSkate = R"(group = "se2"
inertia = [0.1, 1.0, 1.0]
constraints = [[0, 0, 1]]
configuration = [0.4, 1.0, 0.0]
velocity = [1.2, 0.5, 0.0]
potential = "x^2"
)";

class DataFile : public testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(path) << text; }
  TemporaryFolder folder;
  const std::string path = folder / "skate.toml";
};

/// A file's system is a system: its cells end where `hamel run` of the file does, and its claims
/// are those of a system with a potential: with the forces at the nodes lift has order 2 at every
/// s, as without them.
TEST_F(DataFile, IsASystem) {
  write(kSkate);
  StudyConfig config = small();
  config.axes["scheme"] = {"lift", "rkmk4"};
  config.axes["s"] = {0};
  config.systems.push_back({.label = "skate", .name = path});
  const StudyResult study = run(config);
  EXPECT_TRUE(study.complete);
  EXPECT_THAT(study.references[1].kind, HasSubstr("converged"));
  for (size_t i = 0; i < study.cells.size(); ++i) {
    const StudyCell& cell = study.cells[i];
    if (cell.system == 0) continue;
    const Result alone = Simulation(registry(), path).config(cell.config()).run();
    const auto last = alone.trajectory.row(alone.trajectory.rows() - 1);
    EXPECT_THAT(study.metrics[i].final, ElementsAre(last[1], last[2], last[3]));
    EXPECT_EQ(cell.claimed_order, cell.config().scheme == "lift" ? 2 : 4);
    EXPECT_NEAR(study.metrics[i].order, cell.claimed_order, 0.15);
  }
}

/// The text belongs to the study: it is read once, another text is another study, and its mistakes
/// are found before anything runs.
TEST_F(DataFile, BelongsToTheStudy) {
  write(kSkate);
  StudyConfig config = small();
  config.systems = {{.label = "skate", .name = path}};
  const Study study(registry(), config);
  EXPECT_THAT(study.config().fingerprint(), HasSubstr("potential = "));
  const StudyResult before = study.run();
  EXPECT_THAT(before.record(), HasSubstr("potential = "));
  write("no system any more");
  const StudyResult after = study.run();
  EXPECT_EQ(before.metrics[0].final, after.metrics[0].final);
  EXPECT_THAT(mistakes_of(config), AllOf(Contains(HasSubstr(path + ":1:")), Not(IsEmpty())));
  std::filesystem::remove(path);
  EXPECT_THAT(mistakes_of(config), Each(HasSubstr("cannot read '" + path + "'")));
}

/// rkmk4 solves no equation: one cell for all solvers and tolerances, with neither in the table;
/// what it does about a failure matters where halves are tried, as they may succeed.
TEST(StudyCells, ExplicitSchemesUseNoSolver) {
  StudyConfig config = small();
  config.axes["scheme"] = {"lift", "rkmk4"};
  config.axes["s"] = {0, 0.5};
  config.axes["solver"] = {"hybrid", "newton"};
  config.axes["tolerance"] = {1e-13, 1e-10};
  config.axes["on_failure"] = {"retry:newton", "stop"};
  config.axes["step"] = {0.1};
  const StudyResult study = run(config);
  std::vector<size_t> of_rkmk4;
  size_t duplicates = 0;
  for (size_t i = 0; i < study.cells.size(); ++i) {
    const StudyCell& cell = study.cells[i];
    if (cell.config().scheme != "rkmk4") continue;
    if (cell.runs()) of_rkmk4.push_back(i);
    else ++duplicates;
  }
  ASSERT_EQ(of_rkmk4.size(), 1u);
  EXPECT_EQ(duplicates, 15u);
  const size_t one = of_rkmk4.front();
  EXPECT_TRUE(study.metrics[one].ok) << study.metrics[one].reason;
  EXPECT_TRUE(std::isnan(study.metrics[one].solver_difference));
  const Table table = study.table();
  for (const char* axis : {"s", "solver", "tolerance", "on_failure"}) {
    EXPECT_EQ(table.column(axis).text(one), "") << axis;
    EXPECT_NE(table.column(axis).text(0), "") << axis;
  }
  EXPECT_EQ(study.cells[study.cells.size() - 1].why,
            "rkmk4 does not use s, solver, on_failure, tolerance: one cell represents all");

  config.axes["on_failure"] = {"retry:newton", "stop", "halve"};
  std::vector<std::string> policies;
  for (const StudyCell& cell : study_cells(config, registry()))
    if (cell.runs() && cell.config().scheme == "rkmk4")
      policies.push_back(cell.axes.at("on_failure"));
  EXPECT_THAT(policies, ElementsAre("stop", "halve"));
}

/// boxed measures the same at every place of its s in the list.
TEST(StudyCells, AnUnusedValueIsTheDefault) {
  StudyConfig config = small();
  config.axes["scheme"] = {"boxed"};
  config.axes["s"] = {0, 0.5};
  const StudyCells cells = study_cells(config, registry());
  EXPECT_TRUE(cells.front().runs());
  EXPECT_EQ(cells.front().config().s, Config{}.s);
}

/// 1e5 cells fit into memory: what is the same for all cells of a system is kept once.
TEST(StudyCells, ShareWhatIsTheSame) {
  StudyConfig config = small();
  config.axes["step"] = {0.1, 0.05};
  const StudyCells cells = study_cells(config, registry());
  ASSERT_GE(cells.size(), 2u);
  EXPECT_EQ(cells[0].base, cells[1].base);
  EXPECT_NE(cells[0].config().step, cells[1].config().step);
  EXPECT_LT(sizeof(StudyCell), sizeof(Config) / 3);
}

/// The axes are the options that Config::fields lets a study vary; a program may misname one.
TEST(StudyCells, AxesGoByName) {
  EXPECT_THAT(study_axes(),
              ElementsAre("system", "scheme", "retraction", "s", "solver", "force_at", "compose",
                          "on_failure", "tolerance", "step", "rtol", "atol"));
  StudyConfig config = small();
  EXPECT_THAT(config.values("tolerance"), ElementsAre(Config().text("tolerance")));
  config.axes["schme"] = {"lift"};
  config.axes["s"] = {"half"};
  EXPECT_THAT(mistakes_of(config), AllOf(Contains(HasSubstr("unknown axis 'schme'")),
                                         Contains(HasSubstr("did you mean 'scheme'?")),
                                         Contains(HasSubstr("s: 'half' is not a number"))));
}

/// Steps chosen by the error stand beside steps of one size: a pair uses its tolerance, rkmk4 its
/// step, lift either; their order is the power of the tolerance, 1, and no group mixes the two.
TEST(StudyCells, TolerancesStandBesideSteps) {
  StudyConfig config = parse_study(R"(until = 4
repeats = 1
scheme = ["dopri5", "rkmk4", "lift"]
step = [0.1, 0.05]
rtol = ["fixed", 1e-5, 1e-6, 1e-7]
[[system]]
name = "chaplygin_sleigh"
velocity = [0.9, -1, 0]
[[exclude]]
scheme = "dopri5"
rtol = "fixed"
why = "by tolerance"
)",
                                   "study.toml", registry());
  const StudyResult study = run(config);
  std::map<std::string, int> runs;
  for (size_t i = 0; i < study.cells.size(); ++i) {
    const StudyCell& cell = study.cells[i];
    if (!cell.runs()) continue;
    const StudyMetrics& m = study.metrics[i];
    EXPECT_TRUE(m.ok) << m.reason;
    const bool chosen = cell.config().chooses_steps();
    ++runs[cell.config().scheme + (chosen ? " chosen" : " fixed")];
    EXPECT_EQ(cell.claimed_order, chosen ? 1 : cell.config().scheme == "lift" ? 2 : 4);
    EXPECT_NEAR(m.order, cell.claimed_order, chosen ? 0.3 : 0.35) << cell.config().scheme;
    EXPECT_NEAR(m.time, 4, 1e-12);
  }
  EXPECT_THAT(runs, ElementsAre(Pair("dopri5 chosen", 3), Pair("lift chosen", 6),
                                Pair("lift fixed", 2), Pair("rkmk4 fixed", 2)));
}

/// A cell that is not run keeps the values that were asked for, in the table too.
TEST(StudyCells, ADuplicateKeepsItsValues) {
  StudyConfig config = small();
  config.axes["scheme"] = {"boxed"};
  config.axes["s"] = {0.5, 0};
  config.axes["step"] = {0.1};
  const StudyResult study = run(config);
  ASSERT_EQ(study.cells[1].skipped, "duplicate");
  EXPECT_EQ(study.table().column("s").text(1), "0");
}

}  // namespace
