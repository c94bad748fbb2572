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

/// As of a variable of the shell that is not set.
TEST_F(BadInput, EmptyValues) {
  for (const char* option : {"--report", "--config", "--continue", "--scheme", "--stop-at", "-o"})
    EXPECT_THAT(run({"run", "suslov", "--until", "0.1", option, ""}).err,
                HasSubstr("got '', expected a value"))
        << option;
  EXPECT_EQ(run({"steady", "bicycle", "--vary", ""}).status, 2);
  EXPECT_TRUE(files().empty());
}

/// Before anything is computed; 10^9 points would take days.
TEST_F(BadInput, OutputsOfASection) {
  std::filesystem::create_directory(file("folder.csv"));
  for (const char* path : {"no/such/folder/p.csv", "folder.csv", "p.txt"}) {
    const Outcome o = run({"section", "suslov_in_potential", "--event", "xi1=0", "--count",
                           "1000000000", "-o", path});
    EXPECT_EQ(o.status, 2) << path;
    EXPECT_THAT(o.err, HasSubstr(path));
  }
  EXPECT_THAT(
      run({"section", "chaplygin_sleigh", "--event", "cusp", "--count", "1", "--until", "0"}).err,
      HasSubstr("until: got 0, expected seconds above 0"));
}

/// A configuration of a run: until is how long a section waits, what is of rows has no place.
TEST_F(BadInput, ConfigurationsOfASection) {
  const std::vector<std::string> line = {"section", "--config", "a.toml", "--event",
                                         "cusp",    "--count",  "1"};
  std::ofstream(file("a.toml")) << "system = \"chaplygin_sleigh\"\nuntil = 0.2\n";
  EXPECT_THAT(run(line).out, HasSubstr("0.2 s have passed"));
  std::ofstream(file("a.toml")) << "system = \"chaplygin_sleigh\"\nevery = 3\nstop_at = \"t=1\"\n";
  const Outcome o = run(line);
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("a.toml: every: got 3, expected none"));
  EXPECT_THAT(o.err, HasSubstr("a.toml: stop_at: got t=1, expected none"));
  // The section itself: the line wins.
  std::ofstream(file("a.toml")) << "system = \"chaplygin_sleigh\"\nuntil = 0.2\nevent = "
                                   "\"cusp\"\ncount = 1\ndirection = 1\njson = true\n";
  EXPECT_THAT(run({"section", "--config", "a.toml"}).out,
              testing::AllOf(HasSubstr("\"event\": \"cusp\""), HasSubstr("\"direction\": 1")));
  EXPECT_THAT(run({"section", "--config", "a.toml", "--event", "theta=9"}).out,
              HasSubstr("\"event\": \"theta=9\""));
  std::ofstream(file("a.toml")) << "system = \"chaplygin_sleigh\"\ncount = [\"1\", \"2\"]\n";
  EXPECT_THAT(run({"section", "--config", "a.toml"}).err,
              HasSubstr("a.toml:2:9: count: got a list, expected one value"));
  EXPECT_THAT(run({"section", "suslov"}).err,
              testing::AllOf(HasSubstr("--event is required, or event in the file of --config"),
                             HasSubstr("--count is required")));
}

/// Output times on the command line replace those of the file.
TEST_F(BadInput, RowsOfTheLineWin) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> cases = {
      {"output_step = 0.1", {"--output-times", "0.5,0.7"}},
      {"output_times = [0.5, 0.7]", {"--output-step", "0.1"}},
      {"every = 2", {"--output-step", "0.1"}},
      {"output_step = 0.1", {"--every", "2"}}};
  for (const auto& [text, more] : cases) {
    std::ofstream(file("a.toml")) << "system = \"suslov\"\nuntil = 1\n" << text << "\n";
    std::vector<std::string> line = {"run", "--config", "a.toml", "--quiet"};
    line.insert(line.end(), more.begin(), more.end());
    EXPECT_EQ(run(line).status, 0) << text << " " << more[0];
  }
}

/// A configuration says what a line says; the line wins.
TEST_F(BadInput, AConfigurationIsAWholeLine) {
  std::ofstream(file("a.toml"))
      << "system = \"suslov\"\nuntil = 1\noutput = [\"a.csv\", \"a.h5\"]\n"
      << "quiet = true\n";
  const Outcome o = run({"run", "--config", "a.toml"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.out, "");
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.csv", "a.h5", "a.toml"));
  EXPECT_EQ(run({"run", "--config", "a.toml", "-o", "b.csv"}).status, 0);
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.csv", "a.h5", "a.toml", "b.csv"));
  std::ofstream(file("a.toml")) << "system = \"suslov\"\njson = 3\nreport = \"x.txt\"\n";
  EXPECT_THAT(run({"run", "--config", "a.toml"}).err,
              HasSubstr("a.toml:2:8: json: got '3', expected true or false"));
  std::ofstream(file("a.toml")) << "system = \"suslov\"\nreport = \"x.txt\"\nroot = \"free\"\n";
  EXPECT_THAT(run({"run", "--config", "a.toml"}).err, HasSubstr("--root: for a robot, FILE.urdf"));
}

TEST_F(BadInput, FilesOfOtherKinds) {
  std::ofstream(file("e.toml")) << "system = \"suslov\"\nmembers = 2\nkeep = [\"end.omega1\"]\n"
                                << "[vary]\n\"start.omega1\" = { uniform = [2, 1] }\n";
  for (const std::vector<std::string>& line : {std::vector<std::string>{"run", "e.toml"},
                                               {"run", "--config", "e.toml"},
                                               {"study", "e.toml"}}) {
    const Outcome o = run(line);
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr("e.toml: this file is an ensemble (hamel ensemble e.toml)"));
  }
  EXPECT_THAT(run({"ensemble", "e.toml"}).err,
              HasSubstr("uniform: got [2,1], expected [least, most], least below most"));
  std::ofstream(file("a.toml")) << "system = \"suslov\"\nuntil = \"abc\"\n";
  EXPECT_THAT(run({"run", "--config", "a.toml"}).err,
              HasSubstr("a.toml:2:9: until: got 'abc', expected a number"));
  std::ofstream(file("u.csv")) << "t,value\n";
  EXPECT_THAT(run({"run", "segway", "--input", "right_torque=u.csv"}).err,
              HasSubstr("the table is empty, expected rows of a time and a value"));
}

/// The parser names its own state; the cause of the commonest mistakes is added.
TEST_F(BadInput, MistakesOfToml) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"scheme = lift", "could not determine value type; words and formulas are written in quotes"},
      {"scheme = \"lift", "; a text ends on its line, with a quote"},
      {"until = 1,5", "saw ','; a number has no unit, and a point before its decimals"},
      {"until = 1 s", "saw 's'; a number has no unit, and a point before its decimals"}};
  for (const auto& [line, message] : cases) {
    std::ofstream(file("a.toml")) << "system = \"suslov\"\n" << line << "\nstep = 0.01\n";
    const Outcome o = run({"run", "--config", "a.toml"});
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, testing::AllOf(HasSubstr("a.toml:2:"), HasSubstr(message)));
  }
}

TEST_F(BadInput, ReproduceIntoAFile) {
  std::ofstream(file("taken")) << "precious";
  const Outcome o = run({"reproduce", "-o", "taken/figures", "--quiet"});
  EXPECT_EQ(o.status, 2);
  EXPECT_NE(o.err, "");
  EXPECT_EQ(contents(file("taken")), "precious");
}

}  // namespace
