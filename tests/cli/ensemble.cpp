// hamel ensemble: equal bytes for any number of threads and shards, and after interruptions.
#include <signal.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "program.hpp"

namespace {

using namespace hamel::test;
using testing::HasSubstr;

class EnsembleCommand : public CommandLine {
 protected:
  /// About a second of work.
  std::string many() const {
    write("many.toml", R"toml(system = "rattleback"
until = 20
members = 301
seed = 4
keep = ["event.reversed.count", "end.omega3", { name = "bad", formula = "1 / (member - 100)" }]
statistics_at = [3]
statistics_of = ["omega3"]
histograms = { "end.omega3" = 10 }
[vary]
start.omega3 = { uniform = [-3, -0.5] }
skew = { normal = [0.3, 0.05] }
)toml");
    return "many.toml";
  }
  Outcome whole(const std::string& folder, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"ensemble", many(), "-o", folder, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// Without the members that differ: seconds, ranks, threads.
  static std::string compared(const std::string& text) {
    return text.substr(0, text.find("\"seconds\""));
  }
  void expect_same_files(const std::string& a, const std::string& b) const {
    for (const char* name : {"/ensemble.csv", "/ensemble.h5"})
      EXPECT_EQ(contents(file(a + name)) == contents(file(b + name)), true) << b << name;
  }
};

TEST_F(EnsembleCommand, ThreadsAndShardsGiveEqualBytes) {
  const Outcome one = whole("one", {"--threads", "1"});
  ASSERT_EQ(one.status, 0) << one.err;
  const nlohmann::json first = nlohmann::json::parse(one.out);
  EXPECT_EQ(first["members"], 301);
  EXPECT_EQ(first["failed"], 1);
  EXPECT_EQ(first["failures"][0]["member"], 100);
  EXPECT_THAT(std::string(first["failures"][0]["reason"]), HasSubstr("'bad' is inf"));
  EXPECT_EQ(first["kept"]["end.omega3"]["members"], 300);
  EXPECT_EQ(first["statistics"][0]["t"], 3);
  EXPECT_EQ(first["file"], "many.toml");
  std::this_thread::sleep_for(std::chrono::seconds(1));  // no time of writing in the files
  const Outcome two = whole("two", {"--threads", "2"});
  EXPECT_EQ(compared(two.out), compared(one.out));
  expect_same_files("one", "two");
  for (const std::string count : {"2", "3"}) {
    const std::string folder = "shards" + count;
    for (int i = 1; i <= std::stoi(count); ++i)
      ASSERT_EQ(whole(folder, {"--shard", std::to_string(i) + "/" + count}).status, 0);
    const Outcome merged = whole(folder, {"--merge"});
    EXPECT_EQ(merged.status, 0) << merged.err;
    EXPECT_EQ(compared(merged.out), compared(one.out));
    expect_same_files("one", folder);
  }
  const std::vector<std::string> rows = lines(contents(file("one/ensemble.csv")));
  const nlohmann::json member = answer({"ensemble", many(), "--member", "17", "-o", "alone"});
  EXPECT_EQ(member["kept"]["end.omega3"], std::stod(split(rows[18])[4])) << rows[18];
  const nlohmann::json again = record({"--config", "alone/member-17.toml"});
  EXPECT_NEAR(again["final"]["velocity"][2].get<double>(), member["kept"]["end.omega3"], 1e-6);
}

// Ranks as a launcher states them, here without one.
TEST_F(EnsembleCommand, RanksGiveEqualBytes) {
  const Outcome one = whole("one", {"--threads", "2"});
  ASSERT_EQ(one.status, 0) << one.err;
  const std::vector<std::string> line = {"ensemble", "many.toml", "-o", "ranks", "--json"};
  EXPECT_EQ(run(line, "OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=2 ").out, "");
  const Outcome first = run(line, "OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=2 ");
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(compared(first.out), compared(one.out));
  EXPECT_EQ(nlohmann::json::parse(first.out)["ranks"], 2);
  expect_same_files("one", "ranks");
  const Outcome wrong = run(line, "PMI_RANK=2 PMI_SIZE=2 ");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("PMI_RANK: got 2, expected less than PMI_SIZE = 2"));
}
TEST_F(EnsembleCommand, UnderMpirun) {
  if (std::system("command -v mpirun > /dev/null") != 0) HAMEL_SKIP_WITHOUT("mpirun");
  const Outcome one = whole("one", {"--threads", "2"});
  ASSERT_EQ(one.status, 0) << one.err;
  const Outcome two = run({"ensemble", "many.toml", "-o", "mpi", "--json"},
                          "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun "
                          "--oversubscribe -n 2 ");
  ASSERT_EQ(two.status, 0) << two.err;
  EXPECT_EQ(compared(two.out), compared(one.out));
  expect_same_files("one", "mpi");
}

// The shipped scripts: the tasks of an array as Slurm states them, here without one.
TEST_F(EnsembleCommand, TasksOfAnArrayJoinTheirParts) {
  ASSERT_EQ(whole("one", {"--threads", "2"}).status, 0);
  const std::string script = std::string(std::getenv("HAMEL_SOURCE")) + "/tools/cluster/";
  for (const char* task : {"2", "1", "3"}) {
    EXPECT_FALSE(std::filesystem::exists(file("array/ensemble.csv"))) << task;
    const std::string line = "cd '" + file("") + "' && HAMEL='" + std::getenv("HAMEL_PROGRAM") +
                             "' SLURM_ARRAY_TASK_COUNT=3 SLURM_ARRAY_TASK_ID=" + task + " '" +
                             script + "slurm_array.sh' many.toml array > task.log 2>&1";
    ASSERT_EQ(std::system(line.c_str()), 0) << contents(file("task.log"));
  }
  expect_same_files("one", "array");
}
TEST_F(EnsembleCommand, WorkersOfDaskJoinTheirParts) {
  if (std::system("/usr/bin/python3 -c 'import dask.distributed' 2> /dev/null") != 0)
    HAMEL_SKIP_WITHOUT("dask.distributed");
  ASSERT_EQ(whole("one", {"--threads", "2"}).status, 0);
  const std::string program = std::getenv("HAMEL_PROGRAM");
  const std::string line = "cd '" + file("") + "' && PATH='" +
                           program.substr(0, program.rfind('/')) + "':$PATH /usr/bin/python3 '" +
                           std::getenv("HAMEL_SOURCE") +
                           "/tools/cluster/dask_shards.py' many.toml dask 3 > dask.log 2>&1";
  ASSERT_EQ(std::system(line.c_str()), 0) << contents(file("dask.log"));
  expect_same_files("one", "dask");
}

TEST_F(EnsembleCommand, MergeRefusesWhatDoesNotFit) {
  const std::string name = many();
  EXPECT_THAT(run({"ensemble", name, "-o", "parts", "--merge"}).err, HasSubstr("has no shards"));
  ASSERT_EQ(run({"ensemble", name, "-o", "parts", "--shard", "2/3", "--quiet"}).status, 0);
  const Outcome missing = run({"ensemble", name, "-o", "parts", "--merge"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("merge: shard 1/3 is missing"));
  EXPECT_THAT(missing.err, HasSubstr("merge: shard 3/3 is missing"));
  EXPECT_FALSE(std::filesystem::exists(file("parts/ensemble.csv")));
  ASSERT_EQ(run({"ensemble", name, "-o", "parts", "--shard", "1/3", "--quiet"}).status, 0);
  ASSERT_EQ(run({"ensemble", name, "-o", "parts", "--shard", "3/3", "--quiet"}).status, 0);

  const std::string journal = contents(file("parts/journal-1-of-3.jsonl"));
  std::ofstream(file("parts/journal-1-of-3.jsonl")) << journal.substr(0, journal.size() / 2);
  EXPECT_THAT(run({"ensemble", name, "-o", "parts", "--merge"}).err,
              HasSubstr("shard 1/3 is incomplete: "));
  std::ofstream(file("parts/journal-1-of-3.jsonl")) << journal;

  const std::string other = contents(file(name));
  write("other.toml", "# another\n" + other);
  EXPECT_EQ(run({"ensemble", "other.toml", "-o", "parts", "--merge", "--quiet"}).status, 0);
  write("seed.toml", std::string(other).replace(other.find("seed = 4"), 8, "seed = 5"));
  const Outcome seed = run({"ensemble", "seed.toml", "-o", "parts", "--merge"});
  EXPECT_EQ(seed.status, 2);
  EXPECT_THAT(seed.err, HasSubstr("holds the members of another ensemble or program"));
  EXPECT_THAT(seed.err, HasSubstr("here:  seed = 5"));
  ASSERT_EQ(run({"ensemble", name, "-o", "parts", "--shard", "1/2", "--quiet"}).status, 0);
  EXPECT_THAT(run({"ensemble", name, "-o", "parts", "--merge"}).err,
              HasSubstr("has shards of 2 and of 3"));
  EXPECT_THAT(run({"ensemble", name, "--shard", "3/2"}).err, HasSubstr("1 <= i <= n"));
  EXPECT_THAT(run({"ensemble", name, "--shard", "half"}).err, HasSubstr("expected i/n"));
  EXPECT_THAT(run({"ensemble", name, "--member", "301"}).err, HasSubstr("expected 0 to 300"));
}

/// kill -9 and Ctrl-C, twenty times, each when one more part in 22 of the journal is there: the
/// same command completes it.
TEST_F(EnsembleCommand, InterruptionsLoseNothing) {
  const std::string name = many();
  ASSERT_EQ(run({"ensemble", name, "-o", "whole", "--quiet"}).status, 0);
  const auto size = [&](const char* folder) {
    std::error_code absent;
    const auto bytes =
        std::filesystem::file_size(file(std::string(folder) + "/journal.jsonl"), absent);
    return absent ? 0 : bytes;
  };
  const auto all = size("whole");
  std::string kept;
  int interrupted = 0;
  for (unsigned i = 0; i < 20; ++i) {
    const pid_t child = started({"ensemble", name, "-o", "killed"});
    int status = 0;
    pid_t ended = 0;
    while (size("killed") < all * (i + 1) / 22 && ended == 0) {
      std::this_thread::yield();
      ended = waitpid(child, &status, WNOHANG);
    }
    ASSERT_EQ(ended, 0) << "ended before kill " << i;
    kill(child, i % 4 == 3 ? SIGINT : SIGKILL);
    ASSERT_EQ(waitpid(child, &status, 0), child);
    interrupted += WIFSIGNALED(status) || WEXITSTATUS(status) != 0;
    const std::string journal = contents(file("killed/journal.jsonl"));
    EXPECT_TRUE(journal.starts_with(kept)) << "after kill " << i;
    kept = journal.substr(0, journal.rfind('\n') + 1);
  }
  EXPECT_GT(interrupted, 10);
  const Outcome end = run({"ensemble", name, "-o", "killed"});
  ASSERT_EQ(end.status, 0) << end.err;
  EXPECT_THAT(end.out, testing::Not(HasSubstr("damaged")));
  expect_same_files("whole", "killed");

  // One that is stopped has not ended, and its journal is its own.
  const pid_t child = started({"ensemble", name, "-o", "busy", "--threads", "1"});
  while (size("busy") == 0) std::this_thread::yield();
  ASSERT_EQ(kill(child, SIGSTOP), 0);
  const Outcome second = run({"ensemble", name, "-o", "busy"});
  EXPECT_EQ(second.status, 2);
  EXPECT_THAT(second.err, HasSubstr("another ensemble is running in 'busy'"));
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
}

/// The ready files; of Suslov's body the angle between the axes in space is known.
TEST_F(EnsembleCommand, ReadyFilesRun) {
  for (const std::string name : {"rattleback_reversals", "sleigh_basin", "segway_monte_carlo"}) {
    write(name + ".toml", source_file("tools/studies/" + name + ".toml"));
    EXPECT_EQ(answer({"ensemble", name + ".toml", "--member", "21"})["failed"], false) << name;
  }
  write("scattering.toml", source_file("tools/studies/suslov_scattering.toml"));
  ASSERT_EQ(run({"ensemble", "scattering.toml", "-o", "out", "--quiet"}).status, 0);
  const std::vector<std::string> rows = lines(contents(file("out/ensemble.csv")));
  EXPECT_EQ(split(rows[0])[2], "angle");
  for (size_t i = 1; i < rows.size(); ++i)  // it starts 1e-6 from the axis
    EXPECT_NEAR(std::stod(split(rows[i])[2]), std::stod(split(rows[i])[3]), 2e-6) << rows[i];
  EXPECT_EQ(rows.size(), 62u);
}

/// Lorenz's equations as a system by data, fewer of them: a stable rest is where it is known to be.
TEST_F(EnsembleCommand, LorenzComesToRestWhereItIsStable) {
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  write("lorenz_system.toml", source_file("tools/studies/lorenz_system.toml"));
  write("lorenz.toml", with(with(source_file("tools/studies/lorenz_ensemble.toml"),
                                 "system = \"tools/studies/", "system = \""),
                            "members = 10000", "members = 300"));
  const nlohmann::json record = answer({"ensemble", "lorenz.toml", "-o", "out"});
  EXPECT_EQ(record["failed"], 0);
  const std::vector<std::string> rows = lines(contents(file("out/ensemble.csv")));
  ASSERT_EQ(rows[0].substr(0, 39), "member,sigma,rho,beta,end.X,end.Y,end.Z");
  int at_origin = 0, at_rest = 0;
  for (size_t i = 1; i < rows.size(); ++i) {
    std::vector<double> of;
    for (const std::string& cell : split(rows[i])) of.push_back(std::stod(cell));
    const double sigma = of[1], rho = of[2], beta = of[3], x = of[4], z = of[6];
    if (sigma < 1 || beta < 0.5) continue;  // too slow
    const double unstable =
        sigma > beta + 1 ? sigma * (sigma + beta + 3) / (sigma - beta - 1) : HUGE_VAL;
    if (rho < 0.8) {
      EXPECT_LT(of[7], 1e-3) << rows[i];
      ++at_origin;
    } else if (rho > 2 && rho < 0.7 * unstable) {
      EXPECT_NEAR(z, rho - 1, 0.02 * rho) << rows[i];
      EXPECT_NEAR(x * x, beta * (rho - 1), 0.04 * beta * rho) << rows[i];
      ++at_rest;
    }
  }
  EXPECT_GE(at_origin, 2);
  EXPECT_GE(at_rest, 50);
}

/// A range without members, an unknown quantity, in one answer, before anything is written.
TEST_F(EnsembleCommand, BadInputIsRefusedBeforeAnythingRuns) {
  write("bad.toml",
        "system = 'rattleback'\nmembers = 3\nkeep = ['end.omga3']\n[vary]\n"
        "mass = { uniform = [-1, 1] }\n");
  const Outcome bad = run({"ensemble", "bad.toml", "-o", "out"});
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, HasSubstr("bad.toml:3:9: keep[0]: 'end.omga3': unknown quantity"));
  EXPECT_THAT(bad.err, HasSubstr("bad.toml:5:8: vary.mass: got -1,1, expected positive"));
  EXPECT_FALSE(std::filesystem::exists(file("out")));
}

}  // namespace
