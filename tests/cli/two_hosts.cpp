// MPI over ssh between two hosts, made of network namespaces (tools/cluster/two_hosts.sh): the
// bytes are those of one process, also where a rank was killed.
#include <cstdlib>

#include "program.hpp"

namespace {

using namespace hamel::test;
using testing::HasSubstr;

class TwoHosts : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    const int status = on_two_hosts("true");
    if (status == 77) GTEST_SKIP() << contents(file("log"));
    ASSERT_EQ(status, 0) << contents(file("log"));
    write("many.toml", R"toml(system = "rattleback"
until = 20
members = 601
seed = 4
keep = ["event.reversed.count", "end.omega3"]
[vary]
start.omega3 = { uniform = [-3, -0.5] }
skew = { normal = [0.3, 0.05] }
)toml");
    ASSERT_EQ(run({"ensemble", "many.toml", "-o", "one", "--quiet"}).status, 0);
  }
  /// A script on the first of them, in the test's folder; its exit status.
  int on_two_hosts(const std::string& script) const {
    write("script.sh", "cd '" + file("") + "'\n" + script + "\n");
    const std::string line = "'" + std::string(std::getenv("HAMEL_SOURCE")) +
                             "/tools/cluster/two_hosts.sh' bash '" + file("script.sh") + "' > '" +
                             file("log") + "' 2>&1";
    return WEXITSTATUS(std::system(line.c_str()));
  }
  static std::string ranks(const std::string& folder) {
    return "mpirun --host $HOSTS -n 2 '" + std::string(std::getenv("HAMEL_PROGRAM")) +
           "' ensemble many.toml -o " + folder;
  }
  void expect_same_files(const std::string& folder) const {
    for (const char* name : {"/ensemble.csv", "/ensemble.h5"})
      EXPECT_EQ(contents(file("one" + std::string(name))) == contents(file(folder + name)), true)
          << name;
  }
};

TEST_F(TwoHosts, GiveTheBytesOfOneProcess) {
  ASSERT_EQ(on_two_hosts("mpirun --host $HOSTS -n 2 hostname; " + ranks("mpi")), 0)
      << contents(file("log"));
  EXPECT_THAT(contents(file("log")), HasSubstr("hamel-b"));  // a rank was there
  expect_same_files("mpi");
}

TEST_F(TwoHosts, ARankThatIsKilledIsCompleted) {
  const std::string killed = ranks("killed") + R"sh( & all=$!
for i in $(seq 3000); do
  [ "$(cat killed/journal-2-of-2.jsonl 2> /dev/null | wc -l)" -lt 8 ] || break
  sleep 0.02
done
for pid in $(ip netns pids "$OTHER"); do
  [ "$(cat /proc/$pid/comm)" != hamel ] || kill -9 "$pid"
done
wait $all
)sh";
  EXPECT_EQ(on_two_hosts(killed), 137) << contents(file("log"));
  EXPECT_FALSE(std::filesystem::exists(file("killed/ensemble.csv")));
  const std::string before = contents(file("killed/journal-2-of-2.jsonl"));
  ASSERT_EQ(on_two_hosts(ranks("killed")), 0) << contents(file("log"));
  EXPECT_TRUE(contents(file("killed/journal-2-of-2.jsonl"))
                  .starts_with(before.substr(0, before.rfind('\n') + 1)));
  expect_same_files("killed");
}

}  // namespace
