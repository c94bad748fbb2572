// Ensembles whose folders hold what others left there: interrupted files, parts of another kind,
// journals with damaged numbers, and several processes that join the same parts.
#include <sys/stat.h>
#include <sys/wait.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kBodies = R"(system = "suslov"
members = 40
seed = 1
until = 0.5
step = 0.05
scheme = "lift"
keep = ["end.omega1"]
)";
const std::string kVary = "[vary]\n\"start.omega1\" = { uniform = [0.5, 1] }\n";

class HostileEnsemble : public CommandLine {
 protected:
  std::string ensemble(const std::string& more = "") const {
    return write("e.toml", kBodies + more + kVary);
  }
  Outcome run_of(const std::vector<std::string>& more, const std::string& before = "") const {
    std::vector<std::string> all = {"ensemble", file("e.toml"), "-o", file("d"), "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return run(all, "timeout 30 " + before);
  }
  void parts(int count) const {
    for (int i = 1; i <= count; ++i)
      EXPECT_EQ(run_of({"--shard", std::to_string(i) + "/" + std::to_string(count)}).status, 0);
  }
};

// As the journal seals a line: FNV-1a, 64 bits.
std::string sealed(const std::string& object) {
  const std::string body = object.substr(0, object.rfind('}'));
  uint64_t hash = 14695981039346656037u;
  for (const char c : body) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  char sum[20];
  std::snprintf(sum, sizeof sum, "%016llx", static_cast<unsigned long long>(hash));
  return body + ",\"sum\":\"" + sum + "\"}";
}

std::string hex(double x) {
  char out[20];
  std::snprintf(out, sizeof out, "%016llx",
                static_cast<unsigned long long>(std::bit_cast<uint64_t>(x)));
  return out;
}

/// Interrupted while its trajectories are written, it leaves member-3.h5.part.
TEST_F(HostileEnsemble, ResumesAmidItsTrajectories) {
  ensemble("trajectories = [3, 5]\n");
  ASSERT_EQ(run_of({}).status, 0);
  const std::string rows = file("d") + "/member-3.h5";
  std::filesystem::rename(rows, rows + ".part");
  const Outcome o = run_of({});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(std::filesystem::exists(rows));
  EXPECT_FALSE(std::filesystem::exists(rows + ".part"));
}

/// Rank 0 waits for parts that are missing, and says so; what no waiting changes ends it at once.
TEST_F(HostileEnsemble, RanksWaitForWhatIsMissingOnly) {
  ensemble();
  const std::string rank = "env OMPI_COMM_WORLD_RANK=0 OMPI_COMM_WORLD_SIZE=2 ";
  Outcome o = run({"ensemble", file("e.toml"), "-o", file("d")}, rank + "timeout 5 ");
  EXPECT_EQ(o.status, 124);
  EXPECT_THAT(o.err, HasSubstr("waiting for the other ranks: merge: shard 2/2 is missing"));
  write("e.toml", kBodies + "every = 2\n" + kVary);
  ASSERT_EQ(
      run({"ensemble", file("e.toml"), "-o", file("other"), "--shard", "2/2", "--quiet"}).status,
      0);
  ensemble();
  std::filesystem::copy(file("other") + "/journal-2-of-2.jsonl",
                        file("d") + "/journal-2-of-2.jsonl");
  o = run({"ensemble", file("e.toml"), "-o", file("d")}, rank + "timeout 5 ");
  EXPECT_EQ(o.status, 2) << o.err;
  EXPECT_THAT(o.err, HasSubstr("holds the members of another ensemble"));
}

/// Several processes join the same parts: each ends well, and what they write is whole.
TEST_F(HostileEnsemble, JoinsFromSeveralProcesses) {
  ensemble("trajectories = [1]\n");
  ASSERT_EQ(run_of({}).status, 0);
  const std::string expected = contents(file("d") + "/ensemble.csv");
  std::filesystem::remove_all(file("d"));
  parts(3);
  std::vector<pid_t> all;
  for (int k = 0; k < 6; ++k)
    all.push_back(started({"ensemble", file("e.toml"), "-o", file("d"), "--quiet", "--merge"}));
  for (const pid_t one : all) {
    int status = 0;
    waitpid(one, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  }
  EXPECT_EQ(contents(file("d") + "/ensemble.csv"), expected);
}

TEST_F(HostileEnsemble, NamesThatAreNoParts) {
  ensemble();
  parts(2);
  const std::string folder = file("d") + "/";
  for (const char* name : {"journal-1-of-3.jsonl.bak", "journal-1-of-3", "journal-x-of-3.jsonl",
                           "journal-4-of-3.jsonl", "journal-1-of-99999999999999999999.jsonl",
                           "journal--1-of-3.jsonl", "journal-1-of-3x.jsonl"})
    std::ofstream(folder + name) << "x\n";
  EXPECT_EQ(run_of({"--merge"}).status, 0);
  std::filesystem::remove(folder + "journal-1-of-2.jsonl");
  std::filesystem::remove(folder + "journal-2-of-2.jsonl");
  std::ofstream(folder + "journal-1-of-1000000000.jsonl") << "x\n";
  Outcome o = run_of({"--merge"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("shard: got 1/1000000000, expected at most 100000 parts"));
  EXPECT_THAT(run_of({"--shard", "1/1000000000"}).err, HasSubstr("at most 100000 parts"));
  std::filesystem::remove(folder + "journal-1-of-1000000000.jsonl");
  std::ofstream(folder + "journal-1-of-90000.jsonl") << "x\n";
  o = run_of({"--merge"});
  EXPECT_EQ(o.status, 2);
  EXPECT_LT(lines(o.err).size(), 40u);
}

/// A pipe that nobody writes to.
TEST_F(HostileEnsemble, PipesAreNoJournals) {
  ensemble();
  parts(2);
  const std::string name = file("d") + "/journal-2-of-2.jsonl";
  std::filesystem::remove(name);
  ASSERT_EQ(mkfifo(name.c_str(), 0600), 0);
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"--merge"}, {"--shard", "2/2"}}) {
    const Outcome o = run_of(words);
    EXPECT_EQ(o.status, 2) << o.err;
    EXPECT_THAT(o.err, HasSubstr("is no regular file"));
  }
}

/// Lines whose checksum is right and whose numbers are none of this ensemble.
TEST_F(HostileEnsemble, NumbersThatAreNotOfItsMembers) {
  ensemble("class = { formula = \"end.omega1 > 0.7\", names = [\"slow\", \"fast\"] }\n");
  ASSERT_EQ(run_of({}).status, 0);
  const std::string journal = file("d") + "/journal.jsonl";
  const std::vector<std::string> whole = lines(contents(journal));
  const std::string expected = contents(file("d") + "/ensemble.csv");
  const json piece = json::parse(whole.at(1));
  const std::string rows = piece["rows"];
  for (const double number : {1e18, -1e18, 1e300, -1.0, 2.0, 0.5}) {
    for (const std::string member : {"-1", "1000000", "9223372036854775807", "1e300", "0"}) {
      json damaged = piece;
      damaged.erase("sum");
      damaged["rows"] = rows.substr(0, 16) + hex(number) + rows.substr(32);
      if (member != "0")
        damaged["failures"] = json::array({json::array({json::parse(member), hex(0), "a reason"})});
      std::ofstream out(journal);
      out << whole[0] << "\n" << sealed(damaged.dump()) << "\n";
      for (size_t i = 2; i < whole.size(); ++i) out << whole[i] << "\n";
      out.close();
      const Outcome o = run({"ensemble", file("e.toml"), "-o", file("d")}, "timeout 30 ");
      EXPECT_EQ(o.status, 0) << number << " " << member << o.err;
      EXPECT_THAT(o.out, HasSubstr("damaged (no piece of this ensemble)")) << number << member;
      EXPECT_EQ(contents(file("d") + "/ensemble.csv"), expected);
    }
  }
}

TEST_F(HostileEnsemble, ItsTableIsNoRun) {
  ensemble();
  ASSERT_EQ(run_of({}).status, 0);
  const Outcome o = run({"report", file("d") + "/ensemble.h5", "-o", file("x.html")});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, AllOf(HasSubstr("expected a run"), HasSubstr("the table of an ensemble"),
                           Not(HasSubstr("damaged"))));
}

TEST_F(HostileEnsemble, PartsThatNothingUses) {
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {"statistics_of = [\"omega9\"]\n", "e.toml:8:17: statistics_of: expected statistics_at"},
           {"feedback = { period = 0.1 }\n", "feedback: expected inputs by name"},
           {"events = { lost = \"nonsense(\" }\n", "e.toml:8:19: events.lost: "},
           {"events = { lost = \"omega9=1\" }\n", "e.toml:8:19: events.lost: "}}) {
    ensemble(text);
    const Outcome o = run_of({"--fresh"});
    EXPECT_EQ(o.status, 2) << text;
    EXPECT_THAT(o.err, HasSubstr(message)) << text;
  }
  ensemble("events = { slow = \"omega1=0.7\" }\n");
  EXPECT_EQ(run_of({"--fresh"}).status, 0);
  write("e.toml", "system = \"suslov\"\nmembers = 4\nuntil = 0.5\n[varry]\nx = { values = [1] }\n");
  EXPECT_THAT(run_of({}).err, HasSubstr("unknown key 'varry'"));
}

/// Ten thousand times take what their numbers take, and have the values of at(T).
TEST_F(HostileEnsemble, ManyTimes) {
  std::string times = "statistics_at = [";
  for (int i = 0; i < 10'000; ++i) times += (i > 0 ? ", " : "") + std::to_string(i * 5e-5);
  ensemble(times + "]\nstatistics_of = [\"omega1\"]\n");
  const json record =
      json::parse(run({"ensemble", file("e.toml"), "-o", file("d"), "--json"}, "timeout 20 ").out);
  ASSERT_EQ(record["statistics"].size(), 10'000u);
  write("e.toml", kBodies + kVary);
  std::string text = contents(file("e.toml"));
  text.replace(text.find("\"end.omega1\""), 12,
               "\"at(0.25).omega1\", \"2*at(0.25).omega1 + member\"");
  write("e.toml", text);
  const json kept = json::parse(
      run({"ensemble", file("e.toml"), "-o", file("d"), "--fresh", "--json"}).out)["kept"];
  EXPECT_EQ(record["statistics"][5000]["omega1"]["mean"], kept["at(0.25).omega1"]["mean"]);
  EXPECT_NEAR(kept["2*at(0.25).omega1 + member"]["mean"].get<double>(),
              2 * kept["at(0.25).omega1"]["mean"].get<double>() + 19.5, 1e-12);
}

}  // namespace
