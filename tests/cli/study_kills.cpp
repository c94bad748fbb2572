// kill -9 at 50 random moments: nothing that was finished is lost, and the results are those of an
// undisturbed study.
#include <chrono>
#include <random>
#include <thread>

#include "study_command.hpp"

namespace {

using namespace hamel::test;

class StudyKills : public StudyCommand {};

TEST_F(StudyKills, LoseNothing) {
  const std::string name = study(R"(until = 20
repeats = 1000
scheme = ["lift", "balance", "rkmk4"]
retraction = ["cayley", "exp"]
s = [0, 0.5]
step = [0.2, 0.1]
[[system]]
name = "suslov"
set = { inertia = [2, 0.3, 0.5, 3, 0.4, 4] }
[[system]]
name = "chaplygin_sleigh"
[[system]]
name = "suslov_in_potential"
)");
  std::mt19937 random(9);
  std::uniform_int_distribution<int> moments(0, 200);  // ms
  int interrupted = 0;
  std::string kept;
  for (int i = 0; i < 50; ++i) {
    const pid_t child = started_study(name, "killed");
    std::this_thread::sleep_for(std::chrono::milliseconds(moments(random)));
    kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    interrupted += WIFSIGNALED(status);
    const std::string journal = contents(file("killed/journal.jsonl"));
    EXPECT_TRUE(journal.starts_with(kept)) << "after kill " << i;
    kept = journal.substr(0, journal.rfind('\n') + 1);  // npos + 1 = 0
  }
  EXPECT_GT(interrupted, 45);
  EXPECT_GT(lines(kept).size(), 1u);  // beside its head: how many depends on the machine
  const Outcome o = run({"study", name, "-o", "killed"});
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, testing::Not(testing::HasSubstr("damaged")));
  EXPECT_TRUE(contents(file("killed/journal.jsonl")).starts_with(kept));
  ASSERT_EQ(run({"study", name, "-o", "whole", "--quiet"}).status, 0);
  EXPECT_EQ(cells("killed"), cells("whole"));
}

}  // namespace
