// hamel list, hamel describe, --help and --version.
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using Json = nlohmann::json;
using testing::HasSubstr;

class List : public CommandLine {};
class Describe : public CommandLine {};
class Help : public CommandLine {};

const std::vector<std::string> kinds = {"groups", "retractions", "schemes", "solvers", "systems"};

TEST_F(List, EveryKind) {
  for (const std::string& kind : kinds) {
    const Outcome text = run({"list", kind});
    EXPECT_EQ(text.status, 0) << text.err;
    EXPECT_EQ(text.err, "");
    EXPECT_THAT(text.out, HasSubstr(kind));
    const Outcome json = run({"list", kind, "--json"});
    EXPECT_EQ(json.status, 0);
    const Json table = Json::parse(json.out);
    ASSERT_TRUE(table.is_array()) << kind;
    EXPECT_GE(table.size(), 1u);
    for (const Json& row : table)
      EXPECT_THAT(text.out, HasSubstr(row.at("name").get<std::string>()));
  }
}

TEST_F(List, AllAtOnce) {
  const Json all = answer({"list"});
  for (const std::string& kind : kinds) {
    EXPECT_EQ(all.at(kind), answer({"list", kind})) << kind;
  }
  const Outcome text = run({"list"});
  for (const std::string& kind : kinds) EXPECT_THAT(text.out, HasSubstr(kind));
}

/// The names that scripts rely on (tools/README.md).
TEST_F(List, HasThePromisedNames) {
  const Json all = answer({"list"});
  const auto expect = [&](const char* kind, const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      EXPECT_TRUE(std::any_of(all[kind].begin(), all[kind].end(),
                              [&](const Json& row) { return row["name"] == name; }))
          << kind << " " << name;
    }
  };
  expect("groups", {"so2", "so3", "se2", "se3", "r2", "se2*so2"});
  expect("retractions", {"exp", "cayley"});
  expect("schemes", {"lift", "dla", "balance", "boxed", "boxed_literal", "unadapted"});
  expect("solvers", {"newton", "hybrid", "ceres", "ceres_tiny", "nlopt", "nlopt:lbfgs"});
  expect("systems", {"suslov", "chaplygin_sleigh", "rolling_disk"});
}

TEST_F(List, AnUnknownKind) {
  const Outcome o = run({"list", "system"});
  EXPECT_EQ(o.status, 2);
  EXPECT_EQ(o.out, "");
  EXPECT_THAT(o.err, HasSubstr("did you mean 'systems'?"));
}

TEST_F(Describe, EveryRegisteredName) {
  const Json all = answer({"list"});
  int count = 0;
  for (const std::string& kind : kinds) {
    for (const Json& row : all.at(kind)) {
      const std::string name = row.at("name");
      const Outcome text = run({"describe", name}), json = run({"describe", name, "--json"});
      EXPECT_EQ(text.status, 0) << name << text.err;
      EXPECT_EQ(json.status, 0) << name;
      EXPECT_THAT(text.out, HasSubstr(name));
      const Json description = Json::parse(json.out);
      EXPECT_EQ(description.at("name"), name);
      EXPECT_EQ(description.at("kind").get<std::string>() + "s", kind);
      const bool needs_none = kind == "groups" && (name[0] == 'r' || name.find('*') != name.npos);
      EXPECT_NE(description.value("source", "").empty(), !needs_none) << name;
      ++count;
    }
  }
  EXPECT_GE(count, 20);
}

TEST_F(Describe, ASystemSaysEverything) {
  const Json suslov = answer({"describe", "suslov"});
  for (const char* key : {"summary", "group", "formula", "parameters", "known", "source"}) {
    EXPECT_TRUE(suslov.contains(key)) << key;
  }
  EXPECT_EQ(suslov["group"], "so3");
  EXPECT_EQ(suslov["parameters"][0]["name"], "inertia");
  EXPECT_EQ(suslov["parameters"][0]["default"], Json({1.0, 10.0, 100.0}));
  EXPECT_EQ(suslov["parameters"][0]["unit"], "kg m^2");
  EXPECT_EQ(suslov["parameters"][1]["name"], "normal");
  const Json disk = answer({"describe", "rolling_disk"});
  std::vector<std::string> names;
  for (const Json& p : disk["parameters"]) names.push_back(p["name"]);
  EXPECT_THAT(names, testing::ElementsAre("mass", "radius", "spin_inertia", "yaw_inertia"));
  EXPECT_EQ(disk["parameters"][1]["range"], "positive");
  EXPECT_EQ(suslov["parameters"][0]["range"], "positive, of a rigid body");
  EXPECT_EQ(suslov["parameters"][1]["range"], "");
  EXPECT_THAT(run({"describe", "rolling_disk"}).out,
              testing::ContainsRegex("radius +=.*\\[m\\]  positive;  radius of the disk"));
  EXPECT_THAT(run({"describe", "n_trailer"}).out, HasSubstr("in [1, 60]"));
  const Json sleigh = answer({"describe", "chaplygin_sleigh"});
  names.clear();
  for (const Json& p : sleigh["parameters"]) names.push_back(p["name"]);
  EXPECT_THAT(names, testing::ElementsAre("mass", "inertia", "offset", "friction", "gravity"));
}

/// dla, discrete Lagrange-d'Alembert, is lift: described as such, run as such, and the record has
/// lift.
TEST_F(Describe, AnAliasOfAScheme) {
  Json dla = answer({"describe", "dla"});
  const Json lift = answer({"describe", "lift"});
  EXPECT_EQ(dla["name"], "dla");
  EXPECT_EQ(dla["alias_of"], "lift");
  EXPECT_FALSE(lift.contains("alias_of"));
  dla["name"] = "lift";
  dla.erase("alias_of");
  EXPECT_EQ(dla, lift);
  EXPECT_THAT(run({"list", "schemes"}).out, HasSubstr("another name of lift"));

  // On a left-invariant system and on a general one.
  for (const std::string system : {"suslov", "falling_disk"}) {
    const auto by = [&](const std::string& scheme) {
      return record({system, "--scheme", scheme, "--until", "1"});
    };
    const Json by_alias = by("dla"), by_name = by("lift"), other = by("balance");
    EXPECT_EQ(by_alias["scheme"], "lift");
    EXPECT_EQ(by_alias["final"], by_name["final"]);
    EXPECT_NE(by_alias["final"], other["final"]);
  }
}

TEST_F(Describe, AnUnknownName) {
  const Outcome o = run({"describe", "suslof"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("did you mean 'suslov'?"));
  EXPECT_EQ(run({"describe"}).status, 2);
  const Outcome large = run({"describe", "so2^1000*so2"});
  EXPECT_EQ(large.status, 2);
  EXPECT_THAT(large.err, HasSubstr("its dimension is above 1000"));
}

TEST_F(Help, OfEveryCommandHasExamples) {
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{}, {"list"}, {"describe"}, {"run"}, {"reproduce"}}) {
    for (const char* flag : {"--help", "-h"}) {
      std::vector<std::string> arguments = command;
      arguments.push_back(flag);
      const Outcome o = run(arguments);
      EXPECT_EQ(o.status, 0);
      EXPECT_EQ(o.err, "");
      EXPECT_THAT(o.out, HasSubstr("Examples:"));
      EXPECT_THAT(o.out, HasSubstr("hamel "));
    }
  }
  // Every documented option is in the help of run.
  const std::string help = run({"run", "--help"}).out;
  for (const char* option :
       {"--set", "--configuration", "--velocity", "--momentum", "--scheme", "--s", "--retraction",
        "--solver", "--tolerance", "--on-failure", "--compose", "--step", "--until", "--every",
        "-o", "--report", "--config", "--json", "--quiet"}) {
    EXPECT_THAT(help, HasSubstr(option));
  }
  EXPECT_THAT(help, HasSubstr("Exit status"));
}

TEST_F(Help, IsGroupedAndNarrow) {
  for (const char* command :
       {"list", "describe", "run", "report", "study", "steady", "reproduce", "help"}) {
    const std::string help = run({"help", command}).out;
    EXPECT_THAT(help, HasSubstr(std::string("Usage: hamel ") + command + " "));
    for (const std::string& line : lines(help)) {
      EXPECT_LE(line.size(), 100u) << line;
      EXPECT_FALSE(line.ends_with(' ')) << line;
    }
  }
  const std::string help = run({"help", "run"}).out;
  const size_t motion = help.find("\nMotion:"), method = help.find("\nMethod:"),
               output = help.find("\nOutput:");
  EXPECT_LT(motion, help.find("--velocity"));
  EXPECT_LT(help.find("--velocity"), method);
  EXPECT_LT(method, help.find("--scheme"));
  EXPECT_LT(output, help.find("--output-step"));
  EXPECT_EQ(help.find("--scheme"), help.rfind("--scheme TEXT"));
  const Outcome unknown = run({"help", "rum"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'run'?"));
}

/// The examples that --help prints are commands that work.
// Without the pages, which not every build writes, and without lines of two commands.
TEST_F(Help, ExamplesWork) {
  write("torque.csv", "t,value\n0,1\n20,0\n");
  write("robot.urdf", source_file("tests/examples/diff_drive.urdf"));
  int tried = 0;
  for (const char* command : {"list", "describe", "run", "section", "steady", "--help"}) {
    const bool all = std::string(command) == "--help";
    const std::string help =
        run(all ? std::vector<std::string>{command} : std::vector<std::string>{command, "--help"})
            .out;
    for (const std::string& line : lines(help.substr(help.find("Examples:")))) {
      if (!line.starts_with("  hamel ") || line.find("&&") != std::string::npos ||
          line.find("||") != std::string::npos || (all && !line.starts_with("  hamel run")))
        continue;
      std::vector<std::string> words = split(line.substr(8), ' ');
      for (std::string& word : words) std::erase(word, '\'');
      if (const auto report = std::find(words.begin(), words.end(), "--report");
          report != words.end())
        words.erase(report, report + 2);
      const Outcome outcome = run(words);
      if (outcome.err.find("this build reads no .urdf files") != std::string::npos) continue;
      EXPECT_EQ(outcome.status, 0) << line << outcome.err;
      EXPECT_EQ((outcome.out + outcome.err).find("is not used"), std::string::npos) << line;
      ++tried;
    }
  }
  EXPECT_GT(tried, 15);
}

// A mistake on the command line has the form of all others.
TEST_F(Help, MistakesNameTheNearest) {
  const auto mistake = [&](const std::vector<std::string>& words) {
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 2);
    return outcome.err;
  };
  EXPECT_THAT(mistake({"rnu", "suslov"}),
              HasSubstr("hamel: unknown command 'rnu': expected one of"));
  EXPECT_THAT(mistake({"rnu", "--help"}), HasSubstr("did you mean 'run'?"));
  EXPECT_THAT(mistake({}), HasSubstr("hamel: a command is needed: expected one of list"));
  EXPECT_THAT(mistake({"run", "suslov", "--shceme", "lift"}),
              HasSubstr("hamel: unknown option '--shceme': expected one of"));
  EXPECT_THAT(mistake({"run", "suslov", "--shceme", "lift"}),
              HasSubstr("did you mean '--scheme'?"));
  EXPECT_THAT(mistake({"run", "suslov", "--s", "foo"}), testing::StartsWith("hamel: "));
  EXPECT_THAT(mistake({"--foo"}),
              HasSubstr("unknown option '--foo': expected one of --help, --version"));
  EXPECT_THAT(mistake({"run", "suslov", "what"}), HasSubstr("hamel: unexpected 'what'"));
}

/// A hundred bodies free in space are described; what would take hours is refused.
TEST_F(Describe, LargeMechanisms) {
  std::string text = "name = \"many\"\n";
  for (int i = 0; i < 100; ++i) {
    text += "[[body]]\nname = \"b" + std::to_string(i) + "\"\nmass = 1\ninertia = [1, 1, 1]\n";
    text += "[[joint]]\nname = \"j" + std::to_string(i) + "\"\nkind = \"free\"\nchild = \"b" +
            std::to_string(i) + "\"\n";
  }
  write(text);
  const Json described = answer({"describe", "system.toml"});
  EXPECT_EQ(described["dimension"], 600);
  EXPECT_FALSE(described.contains("verdict"));  // it takes an analysis: --analyse
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"describe", "--analyse", "system.toml"}, {"steady", "system.toml"}}) {
    const Outcome o = run(words, "timeout 20 ");
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr("its dimension 600 is above 100"));
  }
}

/// Seconds are shown, on a terminal only: the conserved quantities of car_with_differential take a
/// second.
TEST_F(Describe, AnalysisShowsItsTime) {
  if (std::system("command -v script >/dev/null") != 0) HAMEL_SKIP_WITHOUT("script(1)");
  const std::string command = "cd " + file("") + " && script -qec \"$HAMEL_PROGRAM describe " +
                              "--analyse $HAMEL_SOURCE/tests/examples/car_with_differential.toml\" "
                              "/dev/null >seen.txt </dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_THAT(contents(file("seen.txt")), HasSubstr("car_with_differential.toml is analysed: 1 s"));
  EXPECT_EQ(run({"describe", "--analyse", "suslov"}).err, "");
}

TEST_F(Help, Version) {
  const Outcome o = run({"--version"});
  EXPECT_EQ(o.status, 0);
  EXPECT_THAT(o.out, testing::ContainsRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_THAT(o.out, testing::Not(HasSubstr("formulas")));
}

TEST_F(Help, VersionSaysHowFormulasRun) {
  const Outcome o = run({"--version", "--verbose"});
  EXPECT_EQ(o.status, 0);
  EXPECT_THAT(o.out, HasSubstr("\nformulas: "));
  const Outcome without = run({"--version", "--verbose"}, "HAMEL_NO_MACHINE_CODE=1 exec ");
  EXPECT_THAT(without.out,
              HasSubstr("formulas: interpreted, since HAMEL_NO_MACHINE_CODE is set\n"));
  EXPECT_EQ(run({"--version", "--verbose", "--no-machine-code"}).out, without.out);
}

TEST_F(Help, FormulasInterpretedHaveTheSameBits) {
  const std::vector<std::string> words = {"run", "kick_scooter", "--until", "1", "-o", "-"};
  const Outcome code = run(words);
  std::vector<std::string> interpreted = words;
  interpreted.emplace_back("--no-machine-code");
  ASSERT_EQ(code.status, 0) << code.err;
  const auto rows = [](const Outcome& o) { return o.out.substr(0, o.out.find("\n#")); };
  EXPECT_EQ(rows(run(interpreted)), rows(code));
  EXPECT_THAT(run({"--help"}).out, HasSubstr("--no-machine-code"));
  EXPECT_THAT(run({"run", "suslov", "--no-machine-cod"}).err, HasSubstr("unknown option"));
}

TEST_F(Help, NothingOrAnUnknownCommandIsBadInput) {
  EXPECT_EQ(run({}).status, 2);
  EXPECT_EQ(run({"rnu", "suslov"}).status, 2);
  EXPECT_EQ(run({"list", "--jsno"}).status, 2);
}

}  // namespace
