// hamel study: its files, its mistakes; neither threads nor a kill change its results.
#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>

#include <hamel/framework/study/study.hpp>

#include "study_command.hpp"

namespace {

using namespace hamel::test;
using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

// 39 cells of 2 systems x 3 schemes x 2 retractions x 2 s x 3 steps; polar is not on se2, boxed
// does not use s.
constexpr const char* kSmall = R"(title = "Small"
until = 2
repeats = 2
scheme = ["lift", "balance", "boxed"]
retraction = ["cayley", "polar"]
s = [0, 0.5]
step = [0.2, 0.1, 0.05]
[[system]]
name = "suslov"
set = { inertia = [2, 0.3, 0.5, 3, 0.4, 4] }
velocity = [1, 0.5, 0]
[[system]]
name = "chaplygin_sleigh"
[[exclude]]
scheme = "balance"
step = 0.2
why = "to see it excluded"
)";

TEST_F(StudyCommand, WritesEveryCombination) {
  const Outcome o = run({"study", study(kSmall), "-o", "out"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("39 cells run: 39 ok, 0 failed"), HasSubstr("reference")))
      << o.out;
  const std::vector<std::string> rows = cells("out");
  EXPECT_EQ(rows.size(), 1u + 2 * 3 * 2 * 2 * 3);
  EXPECT_EQ(count(rows, ",impossible,se2 has no retraction polar"),
            16u);  // 4 of balance are excluded
  EXPECT_EQ(count(rows, ",excluded,to see it excluded"), 8u);
  const Json record = Json::parse(contents(file("out/record.json")));
  EXPECT_EQ(record["study"], kSmall);
  EXPECT_EQ(record["cells"]["ok"].get<int>() + record["cells"]["impossible"].get<int>() +
                record["cells"]["excluded"].get<int>() + record["cells"]["duplicate"].get<int>(),
            72);
  for (const char* key : {"version", "git", "host", "compiler", "flags", "libraries"})
    EXPECT_TRUE(record.contains(key)) << key;
}

/// As of an ensemble (cli/ensemble): the same but for the times. Ranks as a launcher states them.
TEST_F(StudyCommand, ShardsAndRanksGiveTheSameCells) {
  const std::string name = study(kSmall);
  ASSERT_EQ(run({"study", name, "-o", "whole", "--quiet"}).status, 0);
  ASSERT_EQ(run({"study", name, "-o", "parts", "--shard", "2/3", "--quiet"}).status, 0);
  const Outcome missing = run({"study", name, "-o", "parts", "--merge"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, AllOf(HasSubstr("merge: shard 1/3 is missing"),
                                 HasSubstr("merge: shard 3/3 is missing")));
  EXPECT_FALSE(std::filesystem::exists(file("parts/cells.csv")));
  for (const char* part : {"1/3", "3/3"})
    ASSERT_EQ(run({"study", name, "-o", "parts", "--shard", part, "--quiet"}).status, 0);
  const Outcome merged = run({"study", name, "-o", "parts", "--merge"});
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_THAT(merged.out, HasSubstr("39 cells run: 39 ok, 0 failed"));
  EXPECT_EQ(cells("parts"), cells("whole"));

  const std::string journal = contents(file("parts/journal-1-of-3.jsonl"));
  std::ofstream(file("parts/journal-1-of-3.jsonl")) << journal.substr(0, journal.size() / 2);
  EXPECT_THAT(run({"study", name, "-o", "parts", "--merge"}).err,
              HasSubstr("merge: shard 1/3 is incomplete: "));

  const std::vector<std::string> line = {"study", name, "-o", "ranks"};
  EXPECT_EQ(run(line, "OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=2 ").out, "");
  ASSERT_EQ(run(line, "OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=2 ").status, 0);
  EXPECT_EQ(cells("ranks"), cells("whole"));
}

/// Every mistake of the file at once, each with its place, and nothing is written.
TEST_F(StudyCommand, SaysWhatIsWrongWithTheFile) {
  const std::string name = study(R"(mode = "zippd"
until = 2
scheme = ["lift", "blance", ""]
retraction = ["cayly"]
s = [0, 2]
step = [0.3]
tolerance = ["small"]
wrong = 1
[[system]]
name = "suslov"
set = { inertai = [1, 2, 3] }
velocity = [1, 2]
[[system]]
name = "suslof"
[[exclude]]
s = 0.25
)");
  const Outcome o = run({"study", name, "-o", "out"});
  EXPECT_EQ(o.status, 2);
  for (const char* piece :
       {"small.toml:1:8: unknown mode 'zippd'", "did you mean 'zipped'",
        "small.toml:3:19: unknown scheme 'blance'", "did you mean 'balance'",
        "small.toml:3:29: unknown scheme ''", "small.toml:4:15: unknown retraction 'cayly'",
        "small.toml:5:9: s: got 2", "small.toml:6:9: step: 0.3 does not divide until = 2",
        "small.toml:7:14: tolerance: got 'small', expected a number",
        "small.toml:8:9: unknown key 'wrong'",
        "small.toml:11:19: unknown parameter of suslov 'inertai'",
        "small.toml:14:8: unknown system 'suslof'", "exclude: say why",
        "small.toml:16:5: exclude: unknown s '0.25'"}) {
    EXPECT_THAT(o.err, HasSubstr(piece));
  }
  EXPECT_FALSE(std::filesystem::exists(file("out")));
  study("until = 0\nstep = 0.1\n[[system]]\nname = \"suslov\"\n");
  EXPECT_THAT(run({"study", "small.toml"}).err,
              testing::AllOf(HasSubstr("until: got 0"), testing::Not(HasSubstr("divide"))));
  EXPECT_THAT(run({"study", "nowhere.toml"}).err, HasSubstr("cannot read 'nowhere.toml'"));
}

TEST_F(StudyCommand, TheNumberOfThreadsChangesNothingButTheTimes) {
  std::string all = "solver = [";
  for (const auto& solver : answer({"list", "solvers"})) all += solver["name"].dump() + ", ";
  const std::string name = study(all + "]\n" + kSmall);
  ASSERT_EQ(run({"study", name, "-o", "one", "--threads", "1", "--quiet"}).status, 0);
  ASSERT_EQ(run({"study", name, "-o", "two", "--threads", "2", "--quiet"}).status, 0);
  EXPECT_EQ(cells("one"), cells("two"));
}

/// A study killed and continued has the cells of an undisturbed one, and did not begin anew.
TEST_F(StudyCommand, GoesOnAfterAKill) {
  std::string longer = kSmall;
  longer.replace(longer.find("repeats = 2"), 11, "repeats = 40");
  longer.replace(longer.find("until = 2"), 9, "until = 40");
  const std::string name = study(longer);
  for (const int signal : {SIGKILL, SIGINT}) {
    const pid_t child = started_study(name, "killed");
    // As soon as it has kept some cells more.
    const std::string journal = file("killed/journal.jsonl");
    const size_t before = lines(contents(journal)).size();
    for (int i = 0; i < 1000 && lines(contents(journal)).size() < before + 10; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(child, signal);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    if (signal == SIGINT) {
      EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1);
    }
    EXPECT_GE(lines(contents(journal)).size(), before + 10);
    EXPECT_FALSE(std::filesystem::exists(file("killed/cells.csv")));
  }
  std::ofstream(file("killed/journal.jsonl"), std::ios::app)
      << "{\"cell\": 3, \"ro";  // a torn line
  const Outcome o = run({"study", name, "-o", "killed"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("were there"));
  ASSERT_EQ(run({"study", name, "-o", "whole", "--quiet"}).status, 0);
  EXPECT_EQ(cells("killed"), cells("whole"));
  // Once more: everything is there, and nothing is run.
  const std::string journal = contents(file("killed/journal.jsonl"));
  ASSERT_EQ(run({"study", name, "-o", "killed", "--quiet"}).status, 0);
  EXPECT_EQ(contents(file("killed/journal.jsonl")), journal);
}

TEST_F(StudyCommand, AnotherStudyNeedsAnotherFolder) {
  ASSERT_EQ(run({"study", study(kSmall), "-o", "out", "--quiet"}).status, 0);
  std::string other = kSmall;
  other.replace(other.find("0.05"), 4, "0.04");
  const std::string name = study(other);
  const Outcome o = run({"study", name, "-o", "out"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, AllOf(HasSubstr("--fresh"), HasSubstr("there: step = 0.2, 0.1, 0.05"),
                           HasSubstr("here:  step = 0.2, 0.1, 0.04")));
  EXPECT_EQ(run({"study", name, "-o", "out", "--fresh", "--quiet"}).status, 0);
  std::filesystem::create_directories(file("taken"));
  std::ofstream(file("taken/journal.jsonl")) << "precious";
  EXPECT_EQ(run({"study", name, "-o", "taken", "--fresh"}).status, 2);
  EXPECT_EQ(contents(file("taken/journal.jsonl")), "precious");
}

/// The HDF5 file holds the same numbers as the CSV, bit for bit, with units.
TEST_F(StudyCommand, Hdf5HoldsWhatTheCsvHolds) {
  if (hamel::hdf5_version().empty()) HAMEL_SKIP_WITHOUT("HDF5");
  ASSERT_EQ(run({"study", study(kSmall), "-o", "out", "--quiet"}).status, 0);
  std::map<std::string, std::string> texts;
  const hamel::Table table = hamel::read_hdf5(file("out/cells.h5"), &texts);
  EXPECT_EQ(table.csv(), contents(file("out/cells.csv")));
  EXPECT_EQ(table.column("step").unit, "s");
  EXPECT_EQ(table.column("ns_per_step").unit, "ns");
  EXPECT_EQ(Json::parse(texts.at("record"))["title"], "Small");
  EXPECT_THROW(hamel::read_hdf5(file("out/cells.csv")), hamel::ConfigError);
}

/// A step beyond the domain of exp fails, and is seen in every output.
TEST_F(StudyCommand, FailedCellsAreResults) {
  const std::string name = study(R"(until = 12
retraction = "exp"
step = [6, 0.1]
[[system]]
name = "chaplygin_sleigh"
velocity = [3, 1, 0]
)");
  const Outcome o = run({"study", name, "-o", "out"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("1 failed"), HasSubstr("[note] 1 cell failed: "),
                           HasSubstr("(newton 1). Where: h 6")));
  EXPECT_EQ(count(cells("out"), ",failed,"), 1u);
  if (std::filesystem::exists(file("out/report.html"))) {
    EXPECT_THAT(contents(file("out/report.html")), HasSubstr("\"marks\":[[\"failed\",\"\"]]"));
  }
}

/// Lists of 10,000 are refused, or made to cells, in a time that grows with their length.
TEST_F(StudyCommand, LongLists) {
  constexpr int count = 10000;
  const auto list = [](double from, double to) {
    std::string out;
    for (int i = 0; i < count; ++i)
      out += (i == 0 ? "[" : ", ") + std::to_string(from + (to - from) * i / count);
    return out + "]\n";
  };
  const std::string head = "until = 1\nrepeats = 1\nreference = false\nstep = 0.5\n",
                    system = "[[system]]\nname = \"suslov\"\n", within = "timeout 20 ";
  // (24 s)
  study("title = \"x\"\nuntil = 1\ns = " + list(0, 1) + "tolerance = " + list(1e-3, 2e-2) +
        "step = " + list(0.01, 0.7) + system);
  Outcome o = run({"study", "small.toml"}, within);
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("combinations, expected at most 200000"));
  EXPECT_THAT(o.err, HasSubstr("step: 0.010069 does not divide until"));
  // One that a scheme makes no use of, and one that is to be excluded.
  study(head + "scheme = \"boxed\"\ns = " + list(0, 1) + system);
  EXPECT_EQ(run({"study", "small.toml", "-o", "out", "--quiet"}, within).status, 0);
  EXPECT_EQ(count - 1, static_cast<int>(this->count(cells("out"), ",duplicate,")));
  study(head + "s = " + list(0, 1) + system + "[[exclude]]\nwhy = \"x\"\ns = " + list(1, 2));
  o = run({"study", "small.toml"}, within);
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("exclude: 1.5 is none of the 10000 values of s"));
}

/// The bar with the time left, on a terminal only.
TEST_F(StudyCommand, ShowsProgressOnATerminal) {
  std::string longer = kSmall;
  longer.replace(longer.find("until = 2"), 9, "until = 2500");
  const std::string name = study(longer);
  if (std::system("command -v script >/dev/null") != 0) HAMEL_SKIP_WITHOUT("script(1)");
  const std::string command = "cd " + file("") + " && script -qec \"$HAMEL_PROGRAM study " + name +
                              " -o out\" /dev/null >bar.txt </dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_THAT(contents(file("bar.txt")), AllOf(HasSubstr("study [="), HasSubstr(" s left")));
  const Outcome o = run({"study", name, "-o", "out"});
  EXPECT_THAT(o.err, Not(HasSubstr("study [=")));
}

}  // namespace
