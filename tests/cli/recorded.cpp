// Rows are written as they come: every format, what is left of a run that was ended, and the run
// resumed from there.
#include "recorded.hpp"

#include <chrono>
#include <thread>

namespace {

using namespace hamel::test;
using testing::AllOf;
using testing::HasSubstr;

TEST_F(Recorded, EveryFormatHasTheSameRows) {
  const Words suslov = {"run", "suslov", "--until", "3"};
  const Outcome o = run(with(suslov, {"-o", "a.csv", "-o", "a.csv.gz", "-o", "-", "-o", "a.json"}));
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(rows("a.csv").size(), 302u);
  EXPECT_EQ(o.out, contents(file("a.csv"))) << "-o - is the CSV, and nothing else";
  ASSERT_EQ(std::system(("gzip -dk " + file("a.csv.gz") + " -c > " + file("b.csv")).c_str()), 0);
  EXPECT_EQ(contents(file("b.csv")), contents(file("a.csv")));
  // A file to resume from is made of pieces that begin anew: the same to round-off, and the same
  // each time.
  ASSERT_EQ(run(with(suslov, {"--quiet", "-o", "a.h5", "-o", "c.csv"})).status, 0);
  EXPECT_EQ(rows("c.csv"), rows("a.csv")) << "one piece";
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.csv", "a.csv.gz", "a.json", "b.csv",
                                                     "c.csv", "a.h5"));
}

struct Case {
  const char* name;
  Words words;
};

// Each resumes in the middle of its run after its file became too large, and is then the
// undisturbed run, to the last bit.
TEST_F(Recorded, GoesOnBitForBit) {
  std::ofstream(file("torque.csv")) << "t,value\n0,0\n40,3\n41,-2\n300,1\n";
  for (const char* name : {"ball_on_shaken_table", "woodpecker_toy", "rimless_wheel"})
    std::ofstream(file(name + std::string(".toml")))
        << source_file("tests/examples/" + std::string(name) + ".toml");
  const std::vector<Case> cases = {
      {"lift", {"suslov", "--until", "200"}},
      {"balance", {"chaplygin_sleigh", "--scheme", "balance", "--until", "200"}},
      {"boxed", {"suslov", "--scheme", "boxed", "--until", "200"}},
      {"rkmk4", {"falling_disk", "--scheme", "rkmk4", "--step", "0.0005", "--until", "8"}},
      {"energy_preserving", {"suslov", "--scheme", "energy_preserving", "--until", "200"}},
      {"reversible",
       {"falling_disk", "--scheme", "reversible", "--step", "0.001", "--until", "16"}},
      {"chosen",
       {"suslov_in_potential", "--scheme", "dopri5", "--rtol", "1e-10", "--until", "400"}},
      {"chosen, reversible", {"suslov_in_potential", "--rtol", "1e-6", "--until", "200"}},
      {"composed", {"rolling_disk", "--compose", "suzuki4", "--until", "200"}},
      {"another solver", {"suslov", "--solver", "hybrid", "--until", "200"}},
      {"halved", {"suslov", "--on-failure", "halve", "--until", "200"}},
      {"forced", {"roller_racer", "--until", "200"}},
      {"driven",
       {"segway", "--input", "right_torque=torque.csv", "--step", "0.002", "--until", "30"}},
      {"held", {"segway", "--input", "right_torque=torque.csv:hold", "--until", "200"}},
      {"events", {"chaplygin_sleigh", "--events", "sin(9*theta)*t=1,cusp", "--until", "200"}},
      {"rows between",
       {"chaplygin_sleigh", "--scheme", "dop853", "--rtol", "1e-9", "--output-step", "0.02",
        "--events", "cusp", "--until", "400"}},
      {"rows of lift between", {"rolling_disk", "--output-step", "0.013", "--until", "200"}},
      {"seldom", {"suslov", "--every", "20", "--until", "4000"}},
      {"impacts",
       {"ball_on_shaken_table.toml", "--slip", "--output-step", "0.005", "--until", "100"}},
      {"slips and impacts",
       {"woodpecker_toy.toml", "--slip", "--output-step", "0.002", "--until", "20"}},
      {"impacts of spokes", {"rimless_wheel.toml", "--output-step", "0.01", "--until", "150"}},
      {"impacts in steps of one size",
       {"woodpecker_toy.toml", "--slip", "--scheme", "nonsmooth", "--step", "0.001", "--until",
        "20"}},
      {"short in a long run",
       {"suslov_in_potential", "--scheme", "dop853", "--rtol", "1e-11", "--until", "1e8", "--every",
        "1", "--stop-at", "t>2000"}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Words words = with({"run"}, with(c.words, {"--quiet"}));
    const Outcome whole =
        run(with(words, {"-o", "whole.h5", "-o", "whole.csv", "-o", "whole.json"}));
    ASSERT_EQ(whole.status, 0) << whole.err;
    const auto size = std::filesystem::file_size(file("whole.h5"));
    const Outcome cut = run(with(words, {"-o", "cut.h5"}),
                            "ulimit -f " + std::to_string(size * 7 / 10 / 512) + " && exec ");
    ASSERT_EQ(cut.status, 1) << cut.err;
    EXPECT_THAT(cut.err, AllOf(HasSubstr("File too large"), HasSubstr("--continue cut.h5")));
    ASSERT_FALSE(exists("cut.h5"));
    const Outcome on =
        run({"run", "--continue", "cut.h5", "--quiet", "-o", "cut.csv", "-o", "cut.json"});
    ASSERT_EQ(on.status, 0) << on.err;
    EXPECT_FALSE(exists("cut.h5.part"));
    EXPECT_TRUE(exists("cut.h5"));
    EXPECT_TRUE(rows("cut.csv") == rows("whole.csv"));
    EXPECT_TRUE(record("cut.json") == record("whole.json"));
    EXPECT_EQ(contents(file("cut.events.csv")), contents(file("whole.events.csv")));
    for (const char* name : {"cut.h5", "whole.h5"}) std::filesystem::remove(file(name));
  }
}

TEST_F(Recorded, CtrlCKeepsWhatThereIs) {
  const Words words = {"run", "rolling_disk", "--until", "1e5",  "--quiet",
                       "-o",  "a.h5",         "-o",      "a.csv"};
  for (const int signal : {SIGINT, SIGTERM}) {
    const pid_t child = started(words);
    // As soon as it has written something.
    for (int i = 0; i < 6000 && !(exists("a.csv.part") && rows("a.csv.part").size() > 1001); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(child, signal);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 1);
    EXPECT_THAT(files(), testing::UnorderedElementsAre("a.h5.part", "a.csv.part"));
    EXPECT_GT(rows("a.csv.part").size(), 1000u);
    for (const char* name : {"a.h5.part", "a.csv.part"}) std::filesystem::remove(file(name));
  }
}

/// A file has one writer: the second is refused while the first one lives.
TEST_F(Recorded, IsWrittenByOne) {
  const Words disk = {"run", "rolling_disk", "--until", "2e4", "--quiet"};
  const Words words = with(disk, {"-o", "a.h5"});
  const pid_t child = started(with(words, {"-o", "a.csv", "-o", "a.csv.gz"}));
  for (int i = 0; i < 6000 && !exists("a.h5.part"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  kill(child, SIGSTOP);
  ASSERT_TRUE(exists("a.h5.part"));
  for (const Words& second : {words, Words{"run", "--continue", "a.h5"}}) {
    const Outcome o = run(second);
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr("another process is writing 'a.h5.part'"));
  }
  for (const std::string name : {"a.csv", "a.csv.gz"}) {
    const Outcome o = run(with(disk, {"-o", name}));
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr("another process is writing '" + name + ".part'"));
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  for (const char* name : {"a.csv.part", "a.csv.gz.part"}) std::filesystem::remove(file(name));
  EXPECT_EQ(run({"run", "--continue", "a.h5", "--quiet"}).status, 0);
  EXPECT_THAT(files(), testing::ElementsAre("a.h5"));
  ASSERT_EQ(run({"run", "rolling_disk", "--until", "1e4", "--quiet", "-o", "b.h5"},
                "ulimit -f 4000 && exec ")
                .status,
            1);
  const Outcome o = run({"run", "--continue", "./b.h5", "-o", "b.h5", "--quiet"});
  EXPECT_EQ(o.status, 0) << o.err << "one file, by two spellings";
}

TEST_F(Recorded, APipeThatIsClosed) {
  const Outcome o =
      run({"run", "rolling_disk", "--until", "1e4", "-o", "-", "-o", "a.h5"}, "", "| head -3");
  EXPECT_EQ(lines(o.out).size(), 3u);
  EXPECT_THAT(o.err, HasSubstr("Broken pipe"));
  EXPECT_THAT(files(), testing::ElementsAre("a.h5.part"));
}

/// The runs that --check adds write no files.
TEST_F(Recorded, CheckedRuns) {
  const Words checked = {"run", "suslov", "--check", "--until", "2", "--quiet"};
  Outcome o = run(with(checked, {"-o", "a.h5", "-o", "a.csv", "-o", "a.json"}));
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.h5", "a.csv", "a.json"));
  const nlohmann::json diagnostics = record("a.json")["diagnostics"];
  EXPECT_GT(diagnostics["estimated_error"], 0.0);
  o = run({"run", "--continue", "a.json", "-o", "b.h5", "--quiet"});
  ASSERT_EQ(o.status, 0) << o.err;
  // One that was ended and resumed.
  const Words longer = {"run", "rolling_disk", "--check", "--until", "500", "--quiet"};
  ASSERT_EQ(run(with(longer, {"-o", "whole.json", "-o", "whole.h5"})).status, 0);
  ASSERT_EQ(run(with(longer, {"-o", "c.h5"}), "ulimit -f 6000 && exec ").status, 1);
  o = run({"run", "--continue", "c.h5", "-o", "c.json", "--quiet"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(record("c.json"), record("whole.json"));
}

TEST_F(Recorded, BadInput) {
  const auto refused = [&](const Words& words, const std::string& why) {
    const Outcome o = run(with({"run"}, words));
    EXPECT_EQ(o.status, 2) << o.err;
    EXPECT_THAT(o.err, HasSubstr(why));
  };
  std::filesystem::create_directory(file("folder.h5"));
  std::ofstream(file("text.h5")) << "no HDF5\n";
  refused({"suslov", "-o", "a.hdf5"}, "expected");
  refused({"suslov", "-o", "folder.h5"}, "is a directory");
  refused({"suslov", "-o", "none/a.h5"}, "cannot write 'none/a.h5'");
  // A disk without any room: there is no number of steps to advise.
  EXPECT_THAT(run({"run", "suslov", "-o", "/proc/a.csv"}).err,
              AllOf(HasSubstr("room for on the disk"), testing::Not(HasSubstr("record every"))));
  refused({"suslov", "-o", "a.csv", "-o", "a.csv"}, "'a.csv' is given twice");
  refused({"suslov", "-o", "a.csv", "-o", "./a.csv"}, "'./a.csv' is given twice");
  refused({"suslov", "-o", "folder.h5/../a.h5", "-o", "a.h5"}, "'a.h5' is given twice");
  refused({"suslov", "-o", "-", "--json"}, "standard output");
  refused({"--continue", "text.h5"}, "no HDF5 file");
  refused({"--continue", "none.h5"}, "there is no such file");
  const Words disk = {"run", "rolling_disk", "--step", "0.01", "--until",
                      "1e4", "--quiet",      "-o",     "a.h5"};
  ASSERT_EQ(run(disk, "ulimit -f 4000 && exec ").status, 1);
  const std::string before = contents(file("a.h5.part"));
  refused({"rolling_disk", "-o", "a.h5"}, "--continue a.h5");
  refused({"--continue", "a.h5", "--step", "0.02"}, "step = 0.01; here: step = 0.02");
  refused({"--continue", "a.h5", "--set", "mass=3"}, "other options");
  refused({"suslov", "--continue", "a.h5"}, "other options");
  EXPECT_TRUE(contents(file("a.h5.part")) == before) << "nothing was touched";
  // Of a run that is finished the next one begins where it ended, as with a record.
  ASSERT_EQ(run({"run", "suslov", "--until", "1", "--quiet", "-o", "b.h5"}).status, 0);
  const Outcome next = run({"run", "--continue", "b.h5", "--json"});
  ASSERT_EQ(next.status, 0) << next.err;
  EXPECT_EQ(nlohmann::json::parse(next.out)["until"], 2.0);
}

// Rows take no memory: 10^6 of them, of 160 bytes and more, in a program that may have 50 MB.
TEST_F(Recorded, MemoryDoesNotGrowWithTheRows) {
#ifdef HAMEL_PROGRAM_IS_SANITIZED
  GTEST_SKIP() << "AddressSanitizer takes terabytes of addresses for itself";
#endif
  for (const char* name : {"a.h5", "a.csv", "a.json"}) {
    const Outcome o =
        run({"run", "suslov", "--no-exact", "--until", "10000", "--quiet", "-o", name},
            "ulimit -d 50000 && exec ");
    EXPECT_EQ(o.status, 0) << name << o.err;
  }
}

}  // namespace
