// Verdicts of hamel study: on explicit schemes, on failures alone, and on systems from files.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "study_command.hpp"

namespace {

using namespace hamel::test;
using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

// A system by data alone, whose motion is not known exactly.
constexpr const char* kBowl = R"(group = "se2"
inertia = [0.1, 1, 1]
constraints = [[0, 0, 1]]
velocity = [1.2, 0.5, 0]
potential = "-0.5*x"
)";

/// Figures of many curves draw some of them, long tables hold their first rows; both say so. The
/// files have every cell.
TEST_F(StudyCommand, APageOfManyCellsIsCut) {
  std::string values = "0";
  for (int i = 1; i < 2001; ++i) values += fmt::format(", {}", i / 4000.0);
  const Outcome o = run({"study",
                         study("until = 0.02\nrepeats = 1\ns = [" + values +
                               "]\nstep = [0.02, 0.01]\n[[system]]\nname = \"suslov\"\n"),
                         "-o", "out", "--quiet"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(cells("out").size(), 4003u);
  if (!std::filesystem::exists(file("out/report.html"))) return;
  const Json page = page_data(contents(file("out/report.html")));
  const Json plot = figure_of(page, "Error against step");
  EXPECT_EQ(plot["series"].size(), 182u);  // each eleventh of 2001
  EXPECT_THAT(std::string(plot["note"]), HasSubstr("182 of 2001 curves"));
  const Json map = figure_of(page, "Error");
  EXPECT_EQ(map["values"].size(), 182u);
  EXPECT_EQ(map["y_values"].size(), 182u);
  EXPECT_EQ(figure_of(page, "Measured orders")["rows"].size(), 2000u);
  EXPECT_THAT(std::string(figure_of(page, "Measured orders")["note"]),
              HasSubstr("The first 2000 of 2001 rows."));
  EXPECT_EQ(figure_of(page, "The first 2000 of 4002 cells that were run")["rows"].size(), 2000u);
}

/// An explicit scheme is compared with no solver, and named without one.
TEST_F(StudyCommand, ExplicitSchemesStandAlone) {
  const std::string name = study(R"(until = 2
scheme = ["lift", "rkmk4"]
solver = ["newton", "hybrid"]
step = [0.2, 0.1]
[[system]]
name = "chaplygin_sleigh"
)");
  Outcome o = run({"study", name, "-o", "out"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("6 cells run: 6 ok, 0 failed"), HasSubstr("rkmk4"),
                           HasSubstr("solver, 2 groups of otherwise equal cells"),
                           HasSubstr("The solvers agree: 2 runs end within"),
                           HasSubstr("scheme, 4 groups")));
  for (const char* wrong : {"rkmk4, newton", "rkmk4, hybrid", "newton, rkmk4", "``", "nan"})
    EXPECT_THAT(o.out, Not(HasSubstr(wrong)));
  EXPECT_EQ(count(cells("out"), "rkmk4,cayley,,,,none,,,0.2,,,ok"), 1u);
  if (std::filesystem::exists(file("out/report.html"))) {
    EXPECT_THAT(contents(file("out/report.html")),
                AllOf(HasSubstr("\"rkmk4\",\"unused\",\"0.2\""), Not(HasSubstr("rkmk4, newton"))));
  }
  o = run({"study",
           study("until = 2\nscheme = \"rkmk4\"\nsolver = [\"newton\", \"hybrid\"]\nstep = "
                 "[0.2, 0.1]\n[[system]]\nname = \"chaplygin_sleigh\"\n"),
           "-o", "alone"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("2 cells run"), Not(HasSubstr("solvers agree")),
                           Not(HasSubstr("] solver, "))));
}

/// Verdicts state a name and a number, also when all cells of a scheme have failed and when there
/// is nothing to compare with.
TEST_F(StudyCommand, VerdictsNameWhatTheyCompare) {
  Outcome o = run({"study", study(R"(until = 12
retraction = "exp"
scheme = ["lift", "boxed"]
s = [0.5, 0.25]
step = [6, 0.1]
[[exclude]]
scheme = "boxed"
step = 0.1
why = "only its failed cell is left"
[[system]]
name = "chaplygin_sleigh"
velocity = [3, 1, 0]
)"),
                   "-o", "failed"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("3 failed"), HasSubstr("] s, "), Not(HasSubstr("``")),
                           Not(HasSubstr("nan"))));
  std::ofstream(file("bowl.toml")) << kBowl;
  o = run({"study",
           study("until = 2\nstep = [0.2, 0.1]\n[[system]]\nname = \"bowl.toml\"\n"
                 "velocity = [1e9, 1, 0]\n"),
           "-o", "none"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("reference              bowl.toml: none: lift"),
                           HasSubstr("has nothing to compare with"), Not(HasSubstr("``")),
                           Not(HasSubstr("nan"))));
}

/// A system's file is part of the study: its mistakes have both places, and its change is another
/// study.
TEST_F(StudyCommand, SystemsMayBeFiles) {
  const std::string name =
      study("until = 2\nstep = [0.2, 0.1]\n[[system]]\nname = \"bowl.toml\"\n");
  EXPECT_THAT(run({"study", name, "-o", "out"}).err,
              HasSubstr("small.toml:4:8: system: cannot read 'bowl.toml'"));
  std::ofstream(file("bowl.toml")) << "group = \"so2*se7\"\n";
  EXPECT_THAT(run({"study", name, "-o", "out"}).err,
              HasSubstr("small.toml:4:8: bowl.toml:1:9: unknown group 'so2*se7'"));
  std::ofstream(file("bowl.toml")) << kBowl;
  Outcome o = run({"study", name, "-o", "out"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("2 cells run: 2 ok"));
  EXPECT_EQ(Json::parse(contents(file("out/record.json")))["data"]["bowl.toml"], kBowl);
  std::ofstream(file("bowl.toml"), std::ios::app) << "contacts = [1]\n";
  o = run({"study", name, "-o", "out"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("here:  bowl.toml: contacts = [1]"));
}

/// The values of an axis are compared in a table under one sentence, on the screen and on the page.
TEST_F(StudyCommand, ValuesAreComparedInATable) {
  const Outcome o = run({"study", study(R"(until = 4
scheme = ["lift", "rkmk4"]
step = [0.2, 0.1]
[[system]]
name = "chaplygin_sleigh"
)"),
                         "-o", "out"});
  EXPECT_EQ(o.status, 0) << o.err;
  const auto all = lines(o.out);
  const auto at = std::find_if(all.begin(), all.end(), [](const std::string& line) {
    return line.find("scheme, 2 groups of otherwise equal cells: worst in error lift") !=
           std::string::npos;
  });
  ASSERT_LT(at - all.begin() + 3, static_cast<long>(all.size())) << o.out;
  EXPECT_EQ(at[1], "    scheme  error ratio  time ratio  worst in");
  EXPECT_THAT(at[2], testing::StartsWith("    lift  "));
  EXPECT_THAT(at[2], testing::EndsWith("  2"));
  EXPECT_THAT(at[3], testing::MatchesRegex("    rkmk4   1 .*  0"));
  if (!std::filesystem::exists(file("out/report.html"))) return;
  Json blocks = Json::array();
  const Json page = page_data(contents(file("out/report.html")));
  for (const Json& section : page["sections"])
    blocks.insert(blocks.end(), section["blocks"].begin(), section["blocks"].end());
  const auto table = std::find_if(blocks.begin(), blocks.end(), [](const Json& block) {
    return block.value("title", "") == "By scheme";
  });
  ASSERT_NE(table, blocks.end());
  EXPECT_EQ((*table)["columns"],
            Json::parse(R"(["scheme", "error ratio", "time ratio", "worst in"])"));
  EXPECT_EQ((*table)["rows"][0][0], "lift");
  EXPECT_GT((*table)["rows"][0][1], 1.05);
}

/// Of long tables the screen has twenty rows.
TEST_F(StudyCommand, LongTablesAreCutOnTheScreen) {
  std::string values = "0";
  for (int i = 1; i < 25; ++i) values += ", " + std::to_string(i / 100.0);
  const Outcome o =
      run({"study",
           study("until = 0.2\nscheme = \"lift\"\nretraction = \"cayley\"\ns = [" + values +
                 "]\nstep = [0.1, 0.05]\nrepeats = 1\n[[system]]\nname = "
                 "\"chaplygin_sleigh\"\n"),
           "-o", "out"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("    and 5 more, on the page\n"));
}

/// A control that leaves the constraint alone is exact where the free motion keeps it; it never
/// wins without a word.
TEST_F(StudyCommand, AControlDoesNotWinWithoutAWarning) {
  const Outcome o = run({"study", study(R"(until = 4
scheme = ["lift", "unadapted"]
retraction = "cayley"
step = [0.2, 0.1]
repeats = 1
[[system]]
name = "suslov"
velocity = [1, 0.001, 0]
)"),
                         "-o", "out"});
  EXPECT_EQ(o.status, 0) << o.err;
  for (const std::string& line : lines(o.out)) {
    if (!line.starts_with("    suslov ") || line.find("unadapted") == std::string::npos) continue;
    EXPECT_THAT(line,
                HasSubstr("unadapted (a control: it claims no order, and leaves the constraint"));
  }
  EXPECT_THAT(o.out, HasSubstr("unadapted (a control: it claims no order"));
}

/// Large steps show no order, neither reached nor failed: 3.63 of 4, and with smaller ones 4.
TEST_F(StudyCommand, StepsTooLargeDeriveNoOrder) {
  const auto verdicts = [&](const std::string& steps, const std::string& folder) {
    const Outcome o =
        run({"study", study("until = 4\nscheme = \"rkmk4\"\nrepeats = 1\nstep = " + steps + R"(
[[system]]
name = "suslov"
set = { inertia = [2, 0.3, 0.5, 3, 0.4, 4] }
velocity = [1.2, 0.5, 0]
)"),
             "-o", folder});
    EXPECT_EQ(o.status, 0) << o.err;
    return o.out;
  };
  for (const char* steps : {"[2, 1, 0.5]", "[1, 0.5]"}) {
    EXPECT_THAT(verdicts(steps, steps),
                AllOf(HasSubstr("Not in the asymptotic range, no order is derived: rkmk4 3.6"),
                      Not(HasSubstr("[failed]")), Not(HasSubstr("Below it"))));
  }
  EXPECT_THAT(verdicts("[0.2, 0.1, 0.05]", "fine"),
              HasSubstr("The one measured order reaches the claim of its scheme"));
}

/// An error as large as the motion is reported as no more than that.
TEST_F(StudyCommand, SaturatedCellsAreSaidToBeSo) {
  const Outcome o = run({"study", study(R"(until = 400
scheme = ["lift", "boxed"]
retraction = "cayley"
step = [0.2, 0.1]
repeats = 1
[[system]]
name = "suslov"
)"),
                         "-o", "out"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("saturated: an error above 0.3 of the motion"));
}

/// Where only times are asked for no reference is made, and sixty trailers take few evaluations:
/// seconds, not the minutes of a converged motion.
TEST_F(StudyCommand, TrailersAreNotCompared) {
  std::ofstream(file("trailers.toml")) << source_file("tools/studies/trailers.toml");
  const Outcome o = run({"study", "trailers.toml", "-o", "out", "--threads", "1"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("10 cells run: 10 ok"), Not(HasSubstr("nothing to compare"))));
  const Json references = Json::parse(contents(file("out/record.json")))["references"];
  EXPECT_EQ(references.size(), 10u);
  for (const Json& reference : references)
    EXPECT_EQ(reference["reference"], "none: the study does not ask for errors");
  const std::vector<std::string> evaluations = column("out", "evaluations_mean");
  EXPECT_EQ(evaluations.size(), 10u);
  for (const std::string& mean : evaluations) EXPECT_LT(std::stod(mean), 12);
}

}  // namespace
