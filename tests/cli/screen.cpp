// Standard output and standard error that are closed, full or of a limited size: exit statuses and
// files are those that they were, and what is lost on standard output is not done.
#include "program.hpp"

namespace {

using namespace hamel::test;
using testing::HasSubstr;
using Words = std::vector<std::string>;

constexpr const char* kStudy = R"(title = "Small"
until = 1
step = [0.1, 0.05]
scheme = ["lift", "balance"]
repeats = 1
[[system]]
name = "suslov"
)";

class Screen : public CommandLine {
 protected:
  // Each command, with what it prints.
  std::vector<Words> commands() const {
    return {{"list"},
            {"describe", "suslov"},
            {"describe", "suslov", "--analyse"},
            {"run", "suslov", "--until", "1"},
            {"run", "suslov", "--until", "1", "--json"},
            {"run", "suslov", "--until", "1", "-o", "-"},
            {"steady", "segway", "--speed", "0"},
            {"steady", "segway", "--speed", "0", "--json"},
            {"study", write("small.toml", kStudy), "-o", "out", "--json"},
            {"study", write("small.toml", kStudy), "-o", "out"},
            {"--help"},
            {"run", "--help"}};
  }
  static std::string joined(const Words& words) {
    std::string out;
    for (const std::string& word : words) out += word + " ";
    return out;
  }
};

TEST_F(Screen, MessagesThatCannotBeWrittenChangeNothing) {
  const Words failing = {"run", "suslov", "--step", "1e3", "--until", "1e4", "--quiet"};
  ASSERT_EQ(run(failing).status, 1);
  for (const char* lost : {"2>&-", "2>/dev/full"}) {
    SCOPED_TRACE(lost);
    for (const Words& words :
         {Words{"run", "nosuch"}, Words{"run", "suslov", "--nosuch"}, Words{"report", "nosuch.h5"},
          Words{"study", "nosuch.toml"}, Words{"list", "nosuch"}, Words{"steady", "nosuch"}})
      EXPECT_EQ(run(words, "", lost).status, 2) << joined(words);
    EXPECT_EQ(run(failing, "", lost).status, 1);
    for (const Words& words : commands())
      EXPECT_EQ(run(words, "", lost).status, 0) << joined(words);
  }
  // No file of the run becomes the closed one.
  Words recorded = failing;
  recorded.insert(recorded.end(), {"-o", "a.csv", "-o", "a.json"});
  EXPECT_EQ(run(recorded, "", "2>&-").status, 1);
  for (const char* name : {"a.csv", "a.json"}) {
    EXPECT_THAT(contents(file(name)), HasSubstr("\"failed\""));
    EXPECT_EQ(contents(file(name)).find("hamel: "), std::string::npos) << name;
  }
}

TEST_F(Screen, TextThatCannotBeWrittenIsNotDone) {
  for (const char* lost : {">/dev/full)", ">&-)"}) {
    SCOPED_TRACE(lost);
    for (const Words& words : commands()) {
      const Outcome o = run(words, "(", lost);
      EXPECT_EQ(o.status, 1) << joined(words);
      EXPECT_THAT(o.err, HasSubstr("cannot write ")) << joined(words);
    }
    EXPECT_EQ(run({"run", "nosuch"}, "(", lost).status, 2);
    EXPECT_EQ(run({"run", "suslov", "--until", "1", "--quiet"}, "(", lost).status, 0);
  }
}

/// A limit on files is a full disk, for studies and pages too.
TEST_F(Screen, NoRoomForFiles) {
  write("small.toml", kStudy);
  const auto limited = [&](const Words& words, int blocks) {  // of 512 bytes
    return run(words, "(ulimit -f " + std::to_string(blocks) + " && exec ", "2>&1) | cat").out;
  };
  for (const int blocks : {0, 1, 4, 16}) {
    SCOPED_TRACE(blocks);
    EXPECT_THAT(limited({"study", "small.toml", "-o", "out", "--quiet"}, blocks),
                HasSubstr("File too large"));
    EXPECT_FALSE(std::filesystem::exists(file("out/cells.h5")));
    std::filesystem::remove_all(file("out"));
  }
  EXPECT_EQ(run({"study", "small.toml", "-o", "out"}, "ulimit -f 0 && exec ").status, 1);
  EXPECT_THAT(limited({"reproduce", "-o", "figures", "--quiet"}, 0), HasSubstr("File too large"));
}

}  // namespace
