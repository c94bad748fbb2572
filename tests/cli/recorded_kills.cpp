// kill -9 at 50 random moments of a run that is recorded: what was written is there, is taken for
// no whole, and the resumed run equals the undisturbed one. 10^7 rows take no memory.
#include "recorded.hpp"

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

#include <hamel/framework/run/record/run_file.hpp>

namespace {

using namespace hamel::test;

class RecordedKills : public Recorded {
 protected:
  // Kills the program; was it still at work?
  bool killed(const std::vector<std::string>& words, int milliseconds) {
    const pid_t child = started(words);
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    kill(child, SIGKILL);
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return WIFSIGNALED(status);
  }
  const std::vector<std::string> run_ = {"run",      "segway",      "--input", "right_torque=0.1",
                                         "--step",   "0.0005",      "--until", "150",
                                         "--events", "1_theta=0.5", "--quiet"};
  std::vector<std::string> to(const std::string& name) const {
    std::vector<std::string> out = run_;
    out.insert(out.end(), {"-o", name});
    return out;
  }
};

TEST_F(RecordedKills, OfAnHdf5FileLoseNothing) {
  const auto words = [&](const std::string& name) {
    std::vector<std::string> out =
        exists(name + ".h5.part")
            ? std::vector<std::string>{"run", "--continue", name + ".h5", "--quiet"}
            : to(name + ".h5");
    out.insert(out.end(), {"-o", name + ".csv", "-o", name + ".json"});
    return out;
  };
  ASSERT_EQ(run(words("whole")).status, 0);
  const auto same = [&] {
    EXPECT_TRUE(rows("killed.csv") == rows("whole.csv"));
    EXPECT_EQ(record("killed.json"), record("whole.json"));
    for (const char* name : {"killed.h5", "killed.csv", "killed.json"})
      std::filesystem::remove(file(name));
  };
  std::mt19937 random(9);
  std::uniform_int_distribution<int> moments(0, 600);  // ms
  int kills = 0, went_on = 0;
  size_t most = 0, ever = 0;  // rows before the last checkpoint
  while (kills < 50) {
    const bool there = exists("killed.h5.part");
    const bool at_work = killed(words("killed"), moments(random));
    kills += at_work;
    went_on += there && at_work;
    EXPECT_EQ(exists("killed.json"), !at_work) << "a run that was killed is no whole";
    if (!at_work) same();
    const size_t kept =
        exists("killed.h5.part") ? hamel::RunFile(file("killed.h5")).kept().rows : 0;
    EXPECT_TRUE(!at_work || kept >= most) << "after kill " << kills;
    most = kept;
    ever = std::max(ever, kept);
  }
  EXPECT_GT(ever, 1000u);
  EXPECT_GT(went_on, 20);
  ASSERT_EQ(run(words("killed")).status, 0);
  same();
  EXPECT_FALSE(exists("killed.h5.part"));
}

TEST_F(RecordedKills, OfACsvLoseNothing) {
  ASSERT_EQ(run(to("whole.csv")).status, 0);
  const std::vector<std::string> whole = rows("whole.csv");
  std::mt19937 random(10);
  std::uniform_int_distribution<int> moments(20, 900);  // ms
  int interrupted = 0;
  size_t most = 0;
  for (int i = 0; i < 1000 && interrupted < 50; ++i) {
    if (!killed(to("killed.csv"), moments(random))) {
      std::filesystem::remove(file("killed.csv"));
      continue;
    }
    ++interrupted;
    EXPECT_FALSE(exists("killed.csv")) << "after kill " << i;
    if (!exists("killed.csv.part")) continue;
    std::vector<std::string> part = rows("killed.csv.part");
    if (part.empty()) continue;
    part.pop_back();  // may be cut
    ASSERT_LE(part.size(), whole.size());
    EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin())) << "after kill " << i;
    most = std::max(most, part.size());
  }
  EXPECT_EQ(interrupted, 50);
  EXPECT_GT(most, 4096u);
}

TEST_F(RecordedKills, TenMillionRowsTakeNoMemory) {
  const Outcome o = run({"run", "suslov", "--no-exact", "--step", "0.01", "--until", "100000",
                         "--quiet", "-o", "a.h5"},
                        "ulimit -d 50000 && exec ");
  EXPECT_EQ(o.status, 0) << o.err;
}

}  // namespace
