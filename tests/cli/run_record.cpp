// hamel run --json: the record, key by key; options reach the run; files are written.
#include <cmath>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using Json = nlohmann::json;
using testing::HasSubstr;

class Record : public CommandLine {};

/// Keys of the record (tools/README.md) and their types: s string, n number, i integer, o object, a
/// array, ? null too.
void expect_keys(const Json& object, const std::vector<std::pair<std::string, char>>& keys,
                 const std::string& where) {
  for (const auto& [key, type] : keys) {
    ASSERT_TRUE(object.contains(key)) << where << key;
    const Json& value = object[key];
    const bool fits = type == 's'   ? value.is_string()
                      : type == 'n' ? value.is_number()
                      : type == 'i' ? value.is_number_integer()
                      : type == 'o' ? value.is_object()
                      : type == 'a' ? value.is_array()
                                    : value.is_null() || value.is_number();
    EXPECT_TRUE(fits) << where << key << " = " << value;
  }
}

void expect_contract(const Json& r) {
  expect_keys(r,
              {{"system", 's'},     {"group", 's'},   {"scheme", 's'},      {"s", 'n'},
               {"retraction", 's'}, {"solver", 's'},  {"compose", 's'},     {"step", 'n'},
               {"parameters", 'o'}, {"status", 's'},  {"reason", 's'},      {"steps", 'i'},
               {"time", 'n'},       {"final", 'o'},   {"diagnostics", 'o'}, {"solver_stats", 'o'},
               {"timing", 'o'},     {"version", 's'}, {"git", 's'},         {"host", 's'}},
              "");
  expect_keys(r["final"], {{"element", 'a'}, {"velocity", 'a'}, {"momentum", 'a'}, {"energy", 'n'}},
              "final.");
  expect_keys(r["diagnostics"],
              {{"constraint_max", 'n'},
               {"holonomic_max", '?'},
               {"group_defect_max", 'n'},
               {"energy_error_max", 'n'},
               {"reaction_work", '?'},
               {"exact_error_final", '?'}},
              "diagnostics.");
  expect_keys(r["solver_stats"],
              {{"iterations_mean", 'n'},
               {"iterations_max", 'i'},
               {"evaluations_mean", 'n'},
               {"evaluations", 'i'},
               {"rejected", 'i'},
               {"residual_max", 'n'}},
              "solver_stats.");
  expect_keys(r["timing"],
              {{"seconds", 'n'},
               {"nanoseconds_per_step", 'n'},
               {"recording_seconds", 'n'},
               {"comparing_seconds", 'n'}},
              "timing.");
}

/// Adding a key is free but deliberate: every key of the record is listed here.
TEST_F(Record, HasExactlyTheseKeys) {
  const Json r = record({"suslov", "--step", "0.01", "--until", "0.5"});
  expect_contract(r);
  std::vector<std::string> keys;
  for (const auto& [key, value] : r.items()) keys.push_back(key);
  EXPECT_THAT(
      keys, testing::UnorderedElementsAre(
                "system", "group", "scheme", "s", "retraction", "solver", "compose", "step",
                "parameters", "status", "reason", "steps", "time", "final", "diagnostics",
                "solver_stats", "timing", "version", "git", "host",
                // later keys:
                "tolerance", "on_failure", "from", "until", "every", "check", "force", "force_at",
                "no_exact", "slip", "speed", "start_values", "rtol", "atol", "step_max",
                "steps_max", "output_step", "output_times", "watched", "stop_at", "events", "start",
                "inputs", "notes", "failure", "fallbacks", "system_file"));
}

TEST_F(Record, OfEverySystem) {
  for (const char* system : {"suslov", "chaplygin_sleigh", "rolling_disk"}) {
    const Json r = record({system, "--step", "0.01", "--until", "1"});
    expect_contract(r);
    EXPECT_EQ(r["system"], system);
    EXPECT_EQ(r["status"], "ok");
    EXPECT_EQ(r["reason"], "");
    EXPECT_EQ(r["steps"], 100);
    EXPECT_NEAR(r["time"].get<double>(), 1, 1e-12);
    EXPECT_LE(r["diagnostics"]["group_defect_max"], 1e-14);
    EXPECT_LE(r["diagnostics"]["exact_error_final"], 1e-3);
    EXPECT_GT(r["timing"]["nanoseconds_per_step"], 1);
    EXPECT_GT(r["timing"]["recording_seconds"], 0);
    EXPECT_LT(r["timing"]["recording_seconds"], r["timing"]["seconds"]);
    EXPECT_GT(r["timing"]["comparing_seconds"], 0);
  }
  // The element: the matrix, or one for each factor.
  EXPECT_EQ(record({"suslov", "--until", "1"})["final"]["element"].size(), 3u);
  EXPECT_EQ(record({"chaplygin_sleigh", "--until", "1"})["final"]["element"][2],
            Json({0.0, 0.0, 1.0}));
  const Json disk = record({"rolling_disk", "--until", "1"})["final"]["element"];
  ASSERT_EQ(disk.size(), 2u);
  EXPECT_EQ(disk[0].size(), 3u);
  EXPECT_EQ(disk[1].size(), 2u);
}

TEST_F(Record, EveryOptionReachesTheRun) {
  const Json r = record({"suslov",
                         "--set",
                         "inertia=2,0.3,0.5,3,0.4,4",
                         "--set",
                         "normal=0,0,2",
                         "--configuration",
                         "0,-1,0,1,0,0,0,0,1",
                         "--velocity",
                         "1,0.5,0",
                         "--scheme",
                         "balance",
                         "--s",
                         "0.25",
                         "--retraction",
                         "exp",
                         "--solver",
                         "newton",
                         "--tolerance",
                         "1e-12",
                         "--compose",
                         "suzuki4",
                         "--force",
                         "--step",
                         "0.05",
                         "--until",
                         "2",
                         "--every",
                         "4"});
  EXPECT_EQ(r["parameters"]["inertia"], Json({2.0, 0.3, 0.5, 3.0, 0.4, 4.0}));
  EXPECT_EQ(r["parameters"]["normal"], Json({0.0, 0.0, 2.0}));
  EXPECT_EQ(r["start"]["configuration"], Json({0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_NEAR(r["start"]["velocity"][0].get<double>(), 1, 1e-15);
  EXPECT_EQ(r["scheme"], "balance");
  EXPECT_EQ(r["s"], 0.25);
  EXPECT_EQ(r["retraction"], "exp");
  EXPECT_EQ(r["solver"], "newton");
  EXPECT_EQ(r["tolerance"], 1e-12);
  EXPECT_EQ(r["compose"], "suzuki4");
  EXPECT_EQ(r["force"], true);
  EXPECT_EQ(r["step"], 0.05);
  EXPECT_EQ(r["steps"], 40);
  EXPECT_EQ(r["every"], 4);
}

TEST_F(Record, TheDefaultsOfTheContract) {
  const Json open = record({"suslov"});
  EXPECT_EQ(open["scheme"], "dop853");
  EXPECT_EQ(open["rtol"], 1e-8);
  EXPECT_EQ(open["step"], nullptr);
  EXPECT_LT(open["steps"], 200);
  EXPECT_EQ(record({"suslov", "--rtol", "1e-6"})["scheme"], "dop853");
  const Json r = record({"suslov", "--step", "0.01"});
  EXPECT_EQ(r["scheme"], "lift");
  EXPECT_EQ(r["s"], 0.5);
  EXPECT_EQ(r["retraction"], "cayley");
  EXPECT_EQ(r["solver"], "newton");
  EXPECT_EQ(r["compose"], "none");
  EXPECT_EQ(r["step"], 0.01);
  EXPECT_EQ(r["steps"], 2000);
}

TEST_F(Record, BackwardsInTime) {
  const Json r = record({"chaplygin_sleigh", "--step", "-0.01", "--until", "-2"});
  EXPECT_EQ(r["steps"], 200);
  EXPECT_NEAR(r["time"].get<double>(), -2, 1e-12);
  EXPECT_LE(r["diagnostics"]["exact_error_final"], 1e-3);
}

TEST_F(Record, MomentumIsProjectedWithANote) {
  const Json r = record({"suslov", "--step", "0.01", "--momentum", "1,1,3", "--until", "0.1"});
  ASSERT_EQ(r["notes"].size(), 2u);  // the first: no rigid body has the paper's moments
  EXPECT_THAT(r["notes"][1].get<std::string>(), HasSubstr("momentum was projected"));
  EXPECT_NEAR(r["start"]["velocity"][0].get<double>(), 1, 1e-15);
  EXPECT_NEAR(r["start"]["velocity"][1].get<double>(), 0.1, 1e-15);
}

TEST_F(Record, QuietAndText) {
  const Outcome text = run({"run", "suslov", "--until", "0.1"}),
                quiet = run({"run", "suslov", "--until", "0.1", "--quiet"});
  EXPECT_EQ(text.status, 0);
  EXPECT_THAT(text.out, HasSubstr("suslov on so3"));
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, "");
  // --json goes to standard output even when quiet.
  EXPECT_TRUE(Json::accept(run({"run", "suslov", "--until", "0.1", "--quiet", "--json"}).out));
}

/// A note has one line of at most 100 columns; its whole text is printed by --verbose, which the
/// file of --config may have too, and is in the record.
TEST_F(Record, NotesAreALineEachAndWholeOnRequest) {
  const std::string whole = record({"car", "--until", "0.1"})["notes"][0];
  ASSERT_THAT(whole, HasSubstr("; the reactions there include that of wheel 'right'"));
  const std::string hint = "--verbose: notes in full";
  const auto notes_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", "car", "--until", "0.1"}, out;
    words.insert(words.end(), more.begin(), more.end());
    for (const std::string& line : lines(run(words).out))
      if (line.starts_with("  note ") || line.find(hint) != std::string::npos) out.push_back(line);
    return out;
  };
  const std::vector<std::string> cut = notes_of({});
  ASSERT_GE(cut.size(), 3u);
  EXPECT_THAT(cut.front(), AllOf(HasSubstr("row dropped: wheel 'right'"), testing::EndsWith(" …")));
  EXPECT_THAT(cut.back(), HasSubstr(hint));
  for (const std::string& line : cut) EXPECT_LE(line.size(), 102u) << line;  // (… has three bytes)
  const std::string file = write("run.toml", "verbose = true");
  for (const auto& asked : {notes_of({"--verbose"}), notes_of({"--config", file})}) {
    EXPECT_EQ(asked.size(), cut.size() - 1);
    EXPECT_EQ(asked.front(), "  note                   " + whole);
  }
  EXPECT_THAT(run({"describe", "car"}).out, HasSubstr(hint));
  EXPECT_THAT(run({"describe", "car", "--verbose"}).out, HasSubstr("  note         " + whole));
}

/// Exit status 1: the step leaves the domain of exp. The good steps are written, and the record has
/// the place and the reason.
TEST_F(Record, ANumericalFailureKeepsWhatWasComputed) {
  const Outcome o =
      run({"run", "chaplygin_sleigh", "--velocity", "0.02,-3,0", "--retraction", "exp", "--step",
           "0.5", "--until", "50", "--json", "-o", "part.csv", "-o", "part.json"});
  EXPECT_EQ(o.status, 1);
  EXPECT_THAT(o.err, HasSubstr("failed in step"));
  const Json r = Json::parse(o.out);
  expect_contract(r);
  EXPECT_EQ(r["status"], "failed");
  EXPECT_NE(r["reason"], "");
  EXPECT_GE(r["steps"], 1);
  EXPECT_LT(r["steps"], 100);
  EXPECT_EQ(r["failure"]["step"].get<long>(), r["steps"].get<long>() + 1);
  EXPECT_EQ(Json::parse(contents(file("part.json")))["status"], "failed");
  size_t rows = 0;
  for (const std::string& line : lines(contents(file("part.csv"))))
    rows += !line.empty() && line[0] != '#' ? 1u : 0u;
  EXPECT_EQ(rows, r["steps"].get<size_t>() + 2);  // header, start, good steps
}

/// A failure in the very first step records the start once.
TEST_F(Record, FailureInTheFirstStep) {
  const Outcome o = run({"run", "suslov", "--retraction", "exp", "--step", "50", "--until", "500",
                         "--json", "-o", "a.csv"});
  EXPECT_EQ(o.status, 1);
  const Json r = Json::parse(o.out);
  EXPECT_EQ(r["steps"], 0);
  size_t rows = 0;
  for (const std::string& line : lines(contents(file("a.csv"))))
    rows += !line.empty() && line[0] != '#' ? 1u : 0u;
  EXPECT_EQ(rows, 2u);  // header and start
}

/// What is not finite is not ok: a step so wild that it cannot be recovered from its two
/// configurations, a velocity whose energy overflows. What is there of the state before is kept.
TEST_F(Record, WhatIsNotFiniteIsNotOk) {
  int wild = 0;
  for (const char* speed : {"1", "1e3", "1e6", "1e9", "1e12", "1e200"}) {
    for (const char* scheme : {"rkmk4", "rk4_projected", "dopri5", "lift"}) {
      for (const auto& [system, others] :
           std::map<std::string, std::string>{{"suslov", ",1,0"}, {"unicycle_3d", ",2,3,4,5,6"}}) {
        SCOPED_TRACE(system + " by " + scheme + " at " + speed);
        const Outcome o = run({"run", system, "--velocity", speed + others, "--scheme", scheme,
                               "--step", "1", "--until", "5", "-o", "a.csv", "--json"});
        const Json r = Json::parse(o.out);
        EXPECT_EQ(o.status, r["status"] == "ok" ? 0 : 1);
        size_t rows = 0;
        for (const std::string& line : lines(contents(file("a.csv"))))
          rows += !line.empty() && line[0] != '#' ? 1u : 0u;
        EXPECT_GE(rows, 2u);
        if (r["status"] != "ok") {
          wild += r["reason"].get<std::string>().find("not finite") != std::string::npos;
          continue;
        }
        for (const char* measured : {"constraint_max", "group_defect_max", "energy_error_max"})
          EXPECT_TRUE(r["diagnostics"][measured].is_number()) << measured;
        EXPECT_TRUE(r["final"]["energy"].is_number());
      }
    }
  }
  EXPECT_GT(wild, 0);
  const Json turned = record(
      {"suslov", "--velocity", "1e6,1,0", "--scheme", "rkmk4", "--step", "1", "--until", "5"}, 1);
  EXPECT_EQ(turned["reason"], "the step left the domain of the retraction");
  EXPECT_EQ(turned["steps"], 0);
  EXPECT_TRUE(turned["diagnostics"]["constraint_max"].is_number());
}

/// What a step that failed has cost is counted; of no steps there is no mean.
TEST_F(Record, ARunWithoutAStep) {
  const Json r = record({"falling_disk", "--rtol", "1e-30", "--check"}, 1);
  EXPECT_EQ(r["steps"], 0);
  EXPECT_GT(r["solver_stats"]["evaluations"], r["solver_stats"]["rejected"]);
  EXPECT_TRUE(r["solver_stats"]["iterations_mean"].is_null());
  EXPECT_TRUE(r["solver_stats"]["evaluations_mean"].is_null());
  EXPECT_TRUE(r["timing"]["nanoseconds_per_step"].is_null());
  const Outcome o = run({"run", "falling_disk", "--rtol", "1e-30", "--check"});
  EXPECT_THAT(o.out, HasSubstr("estimated error        not determined: the run has failed"));
  EXPECT_THAT(o.out, testing::Not(HasSubstr("ns each")));
  const Outcome lift = run({"run", "falling_disk", "--step", "0.3", "--until", "3", "--check"});
  EXPECT_THAT(lift.out, HasSubstr("take a smaller step: a step turns"));
}

/// The events of an earlier run are not left beside the rows of another.
TEST_F(Record, EventsAreThoseOfTheRun) {
  run({"run", "rolling_disk", "--until", "1", "--events", "1_x>0.3", "-o", "a.csv", "--quiet"});
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.csv", "a.events.csv"));
  run({"run", "suslov", "--until", "1", "-o", "a.csv", "--quiet"});
  EXPECT_THAT(files(), testing::ElementsAre("a.csv"));
}

TEST_F(Record, ReportPage) {
  const Outcome o = run({"run", "suslov", "--until", "1", "--report", "page.html", "--quiet"});
  if (o.status == 2 && o.err.find("without the page") != std::string::npos) {
    EXPECT_TRUE(files().empty());
    HAMEL_SKIP_WITHOUT("page");
  }
  ASSERT_EQ(o.status, 0) << o.err;
  const std::string page = contents(file("page.html"));
  EXPECT_THAT(page.substr(0, 200), HasSubstr("<!doctype html>"));
  EXPECT_THAT(page, HasSubstr("suslov"));
  // Self-contained: nothing is fetched.
  EXPECT_THAT(page, testing::Not(HasSubstr("<script src=")));
  EXPECT_THAT(page, testing::Not(HasSubstr("<link rel=\"stylesheet\"")));
  EXPECT_THAT(files(), testing::ElementsAre("page.html"));
}

}  // namespace
