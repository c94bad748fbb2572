// Bad input ends with status 2, a message on standard error that names it, and nothing written.
#include <fstream>

#include "program.hpp"

namespace {

using namespace hamel::test;
using testing::HasSubstr;

class BadInput : public CommandLine {
 protected:
  void refused(std::vector<std::string> arguments, const std::string& message) {
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"-o", "a.csv", "-o", "a.json"});
    const Outcome o = run(arguments);
    std::string line;
    for (const std::string& word : arguments) line += word + " ";
    EXPECT_EQ(o.status, 2) << line;
    EXPECT_EQ(o.out, "") << line;
    EXPECT_THAT(o.err, HasSubstr(message)) << line;
    EXPECT_TRUE(files().empty()) << line << files().front();
  }
};

TEST_F(BadInput, Numbers) {
  refused({"suslov", "--s", "1.5"}, "s: got 1.5, expected a number in [0, 1]");
  refused({"suslov", "--s", "nan"}, "s: got nan");
  refused({"suslov", "--s", "half"}, "--s");
  refused({"suslov", "--step", "0"}, "step: got 0");
  refused({"suslov", "--step", "nan"}, "step: got nan");
  refused({"suslov", "--step", "inf"}, "step: got inf");
  refused({"suslov", "--step", "-0.01"}, "until: got 20");
  refused({"suslov", "--step", "0.01", "--until", "-1"}, "until: got -1");
  refused({"suslov", "--step", "0.01", "--until", "1e12"}, "every");
  refused({"suslov", "--until", "1e12"}, "until: 1e+14 rows");
  refused({"suslov", "--step", "0.01", "--until", "1e300"}, "until");
  refused({"suslov", "--until", "1e300"}, "until");
  refused({"suslov", "--every", "0"}, "every: got 0");
  refused({"suslov", "--every", "1.5"}, "--every");
  refused({"suslov", "--tolerance", "0"}, "tolerance: got 0");
  refused({"suslov", "--step"}, "--step");
}

TEST_F(BadInput, MoreTimesThanMemoryHolds) {
  for (const char* step : {"1e-9", "1e-12", "1e-300"})
    EXPECT_THAT(run({"run", "suslov", "--until", "1", "--output-step", step}).err,
                HasSubstr("more than memory holds"));
}

TEST_F(BadInput, Names) {
  refused({"suslow"}, "did you mean 'suslov'?");
  refused({"suslov", "--scheme", "lfit"}, "did you mean 'lift'?");
  refused({"suslov", "--retraction", "cayly"}, "did you mean 'cayley'?");
  refused({"suslov", "--solver", "newtn"}, "did you mean 'newton'?");
  refused({"suslov", "--on-failure", "hlave"}, "did you mean 'halve'?");
  refused({"suslov", "--on-failure", "retry:newtn"}, "did you mean 'newton'?");
  refused({"suslov", "--compose", "suzuki"}, "did you mean 'suzuki4'?");
  refused({"suslov", "--set", "inerta=1,2,3"}, "did you mean 'inertia'?");
  refused({"chaplygin_sleigh", "--retraction", "polar"}, "unknown retraction of se2 'polar'");
  refused({"suslov", "--nonsense"}, "--nonsense");
  refused({"suslov", "extra"}, "extra");
  refused({}, "system");
}

TEST_F(BadInput, Lists) {
  refused({"suslov", "--velocity", "1,x,0"}, "'x'");
  refused({"suslov", "--velocity", "1,0"}, "velocity: got 2 values, expected 3");
  refused({"suslov", "--velocity", "1,,0"}, "--velocity");
  refused({"suslov", "--velocity", "1,nan,0"}, "not finite");
  refused({"suslov", "--velocity", "1,0,0", "--momentum", "1,0,0"}, "not both");
  refused({"suslov", "--configuration", "1,0,0"}, "configuration");
  refused({"suslov", "--configuration", "2,0,0,0,1,0,0,0,1"}, "configuration");
  // No message about the identity, which was not given.
  for (const char* system : {"falling_disk", "rattleback"}) {
    EXPECT_EQ(
        lines(run({"run", system, "--configuration", "1,0,0,0,1,0,0,0,1.1,0,0,0.25"}).err).size(),
        1u)
        << system;
  }
}

/// A list that ends in a comma, or is empty, is no list.
TEST_F(BadInput, EmptyLists) {
  refused({"suslov", "--velocity", ""}, "--velocity");
  refused({"suslov", "--velocity", "1,0,0,"}, "--velocity");
}

TEST_F(BadInput, AllMistakesAtOnce) {
  refused({"suslov", "--scheme", "lfit", "--s", "2", "--velocity", "1"}, "did you mean 'lift'?");
  const Outcome o =
      run({"run", "suslov", "--scheme", "lfit", "--s", "2", "--velocity", "1", "-o", "a.txt"});
  for (const char* piece : {"lift", "s: got 2", "velocity: got 1", ".txt"})
    EXPECT_THAT(o.err, HasSubstr(piece));
}

TEST_F(BadInput, Outputs) {
  const auto fails = [&](const std::vector<std::string>& more, const std::string& message) {
    std::vector<std::string> arguments = {"run", "suslov", "--until", "0.1", "-o", "good.csv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome o = run(arguments);
    EXPECT_EQ(o.status, 2) << o.err;
    EXPECT_THAT(o.err, HasSubstr(message));
    EXPECT_THAT(files(), testing::Not(testing::Contains("good.csv"))) << "written beside a mistake";
  };
  fails({"-o", "no/such/folder/a.csv"}, "no/such/folder/a.csv");
  fails({"-o", "a.xlsx"}, "unknown output format '.xlsx'");
  fails({"-o", "a"}, "unknown output format ''");
  fails({"-o", "/dev/null/a.csv"}, "cannot write");
  fails({"-o", ""}, "output");
  fails({"--report", "a.txt"}, ".html");
  fails({"--report", "no/such/folder/a.html"}, "");
  std::filesystem::create_directory(file("folder.csv"));
  fails({"-o", "folder.csv"}, "is a directory");
}

TEST_F(BadInput, ReproduceIntoAFile) {
  std::ofstream(file("taken")) << "precious";
  const Outcome o = run({"reproduce", "-o", "taken/figures", "--quiet"});
  EXPECT_EQ(o.status, 2);
  EXPECT_NE(o.err, "");
  EXPECT_EQ(contents(file("taken")), "precious");
}

}  // namespace
