// The program's texts about a system and a run: no more than was computed.
#include <cmath>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using Json = nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Words : public CommandLine {
 protected:
  static constexpr const char* kSkate =
      "group = \"se2\"\ninertia = [0.1, 1, 1]\nconstraints = [[0, 0, 1]]\n"
      "configuration = [0.3, 1, 2]\nvelocity = [1, 0.5, 0]\nforce = [\"-0.1*omega\", 0, 0]\n";
};

// ---- describe -----------------------------------------------------------------------------------

TEST_F(Words, DescribeHasTheStartWithItsConfiguration) {
  const Json disk = answer({"describe", "falling_disk"})["start"];
  EXPECT_EQ(disk["configuration"].size(), 12u);
  EXPECT_EQ(disk["velocity"].size(), 6u);
  EXPECT_GT(disk["configuration"][11], 0.4);  // its centre is up
  const Json sleigh = answer({"describe", "chaplygin_sleigh"})["start"];
  EXPECT_EQ(sleigh["configuration"], Json({0, 0, 0})) << "the identity where a system states none";
  EXPECT_EQ(answer({"describe", "n_trailer"})["start"]["configuration"].size(), 6u);
  EXPECT_THAT(run({"describe", "falling_disk"}).out,
              AllOf(HasSubstr("start        configuration ["), HasSubstr("velocity [")));
}

TEST_F(Words, DescribeReadsFiles) {
  write("skate.toml", kSkate);
  const Outcome o = run({"describe", "skate.toml", "--json"});
  ASSERT_EQ(o.status, 0) << o.err;
  const Json skate = Json::parse(o.out);
  EXPECT_EQ(skate["kind"], "system");
  EXPECT_EQ(skate["group"], "se2");
  EXPECT_EQ(skate["start"]["configuration"], Json({0.3, 1, 2}));
  EXPECT_EQ(skate["constraints"], "1 constraint row");
  EXPECT_EQ(skate["forces"], true);
}

TEST_F(Words, AFileOfAnotherKindIsCalledByItsKind) {
  write("run.toml", "system = \"suslov\"\nuntil = 1\n");
  write("study.toml", "until = 1\nstep = [0.1, 0.05]\n[[system]]\nname = \"suslov\"\n");
  write("skate.toml", kSkate);
  const auto says = [&](const std::vector<std::string>& line, const std::string& words) {
    const Outcome o = run(line);
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr(words));
  };
  says({"run", "run.toml"}, "the configuration of a run (hamel run --config run.toml)");
  says({"describe", "run.toml"}, "the configuration of a run");
  says({"run", "study.toml"}, "a study (hamel study study.toml)");
  says({"run", "--config", "study.toml"}, "a study (hamel study study.toml)");
  says({"run", "--config", "skate.toml"}, "a system by data (hamel run skate.toml)");
  says({"study", "skate.toml"}, "a system (hamel run skate.toml)");
  says({"study", "run.toml"}, "the configuration of a run (hamel run --config run.toml)");
}

/// What describe claims of gni and of energy_preserving is what is measured on Suslov's body with
/// full inertia.
TEST_F(Words, DescribeClaimsWhatIsMeasured) {
  const auto order = [&](const char* scheme, const char* retraction, const char* s,
                         const char* of) {
    const auto error = [&](const char* h) {
      return record({"suslov", "--set", "inertia=2,0.3,0.5,3,0.4,4", "--velocity", "1,0.5,0",
                     "--scheme", scheme, "--retraction", retraction, "--s", s, "--step", h,
                     "--until", "4"})["diagnostics"][of]
          .get<double>();
    };
    return std::log2(error("0.05") / error("0.025"));
  };
  for (const char* scheme : {"gni", "energy_preserving"}) {
    const Json described = answer({"describe", scheme});
    for (const auto& [key, claim] : described["claims"].items()) {
      const char* retraction =
          key.find("other retraction") != std::string::npos ? "second_kind" : "exp";
      const char* s = key.find("1/2") != std::string::npos ? "0.5" : "0";
      EXPECT_NEAR(order(scheme, retraction, s, "exact_error_final"), claim["order"], 0.2)
          << scheme << ", " << key;
    }
  }
  const Json gni = answer({"describe", "gni"});
  EXPECT_THAT(gni["constraint"].get<std::string>(), HasSubstr("up to the error of the step only"));
  EXPECT_GT(record({"suslov", "--set", "inertia=2,0.3,0.5,3,0.4,4", "--velocity", "1,0.5,0",
                    "--scheme", "gni", "--until", "4"})["diagnostics"]["constraint_max"],
            1e-4);
  const Json kept = answer({"describe", "energy_preserving"});
  EXPECT_EQ(kept["claims"].size(), 2u) << "it makes no use of s";
  EXPECT_NEAR(order("energy_preserving", "second_kind", "0.5", "exact_velocity_error_max"), 2, 0.1);
}

// ---- describe --analyse -------------------------------------------------------------------------

class Analysis : public Words {
 protected:
  Json analysis(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"describe", "--analyse", "--json"});
    const Outcome o = run(arguments);
    EXPECT_EQ(o.status, 0) << o.err;
    return Json::parse(o.out.empty() ? "{}" : o.out);
  }
  std::vector<std::string> kept(const std::vector<std::string>& arguments) const {
    std::vector<std::string> out;
    const Json found = analysis(arguments);
    for (const Json& c : found["conserved"]) {
      out.push_back(c["expression"]);
      EXPECT_LE(c["change"], 1e-9);
    }
    return out;
  }
  // A sleigh whose mass centre is 1 mm ahead of the blade: (1, 0.5) goes to (0.974, 0.549) in 50 s.
  std::string sleigh(double mass, double moment, double offset) const {
    const std::string m = std::to_string(mass);
    std::ostringstream text;
    text.precision(17);
    text << "group = \"se2\"\ninertia = [[" << moment + mass * offset * offset << ", 0, "
         << mass * offset << "], [0, " << mass << ", 0], [" << mass * offset << ", 0, " << mass
         << "]]\nconstraints = [[0, 0, 1]]\nvelocity = [1, 0.5, 0]\n";
    write("sleigh.toml", text.str());
    return "sleigh.toml";
  }
};

/// Columns have units: of a heavy body the energy is large beside its velocities, of a light one
/// small.
TEST_F(Analysis, KeepsTheEnergyAndNothingElseWhateverTheUnits) {
  for (const auto& [mass, moment] : {std::pair{1e4, 1e4}, {1.0, 0.1}, {1e-9, 1e-12}})
    EXPECT_EQ(kept({sleigh(mass, moment, 1e-3)}), std::vector<std::string>{"E"}) << mass;
}

TEST_F(Analysis, SaysItInTheFewestTerms) {
  EXPECT_EQ(kept({"n_trailer"}), (std::vector<std::string>{"E", "omega"}));
  EXPECT_EQ(kept({"rolling_disk"}).front(), "E");
}

/// With its mass centre above the blade the sleigh keeps omega and v.
TEST_F(Analysis, TakesParameters) {
  EXPECT_EQ(kept({"chaplygin_sleigh", "--set", "offset=0"}),
            (std::vector<std::string>{"E", "omega", "v1"}));
  EXPECT_EQ(run({"describe", "--analyse", "chaplygin_sleigh", "--set", "ofset=0"}).status, 2);
  EXPECT_EQ(run({"describe", "cayley", "--set", "a=0"}).status, 2);
}

// ---- options that are not used ------------------------------------------------------------------

TEST_F(Words, OptionsThatASchemeDoesNotUseAreNotEchoed) {
  Json r = record({"chaplygin_sleigh", "--scheme", "rkmk4", "--until", "1"});
  for (const char* option : {"s", "solver", "tolerance", "on_failure"})
    EXPECT_TRUE(r[option].is_null()) << option;
  EXPECT_EQ(r["retraction"], "cayley");
  EXPECT_TRUE(r["notes"].empty());
  r = record({"chaplygin_sleigh", "--scheme", "boxed", "--s", "0.3", "--until", "1"});
  EXPECT_TRUE(r["s"].is_null());
  EXPECT_EQ(r["solver"], "newton");
  EXPECT_EQ(r["notes"], Json({"s is not used by boxed"}));
  EXPECT_EQ(record({"chaplygin_sleigh", "--s", "0.3", "--step", "0.01", "--until", "1"})["s"], 0.3);
  EXPECT_THAT(run({"run", "chaplygin_sleigh", "--scheme", "rkmk4", "--until", "1"}).out,
              AllOf(HasSubstr("chaplygin_sleigh on se2: rkmk4, cayley, h = 0.01"),
                    Not(HasSubstr("newton")), Not(HasSubstr("s ="))));
}

/// No advice is made of an infinite number of rows.
TEST_F(Words, NumbersThatAreNoneAreNotPrinted) {
  for (const std::vector<std::string>& line :
       std::vector<std::vector<std::string>>{{"--step", "0"},
                                             {"--every", "0"},
                                             {"--until", "1e300"},
                                             {"--step", "1e-300"},
                                             {"--step", "0", "--until", "0"}}) {
    std::vector<std::string> all = {"run", "suslov"};
    all.insert(all.end(), line.begin(), line.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, AllOf(Not(HasSubstr("inf")), Not(HasSubstr("nan")))) << line[0] << line[1];
  }
}

// ---- runs that go on ----------------------------------------------------------------------------

/// The torque of the roller racer depends on the time: a run in two parts is the whole, with the
/// time of the second.
TEST_F(Words, ARunGoesOnWhereARecordEnds) {
  for (const char* system : {"roller_racer", "snakeboard", "falling_disk", "chaplygin_sleigh"}) {
    const Json whole = record({system, "--until", "2", "--step", "0.02"});
    record({system, "--until", "1", "--step", "0.02", "-o", "first.json"});
    const Json rest = record({"--continue", "first.json"});
    EXPECT_EQ(rest["system"], system);
    EXPECT_EQ(rest["from"], 1.0);
    EXPECT_EQ(rest["time"], 2.0);
    EXPECT_EQ(rest["step"], 0.02);
    for (const char* part : {"configuration", "velocity"}) {
      for (size_t i = 0; i < whole["final"][part].size(); ++i) {
        EXPECT_NEAR(rest["final"][part][i], whole["final"][part][i].get<double>(), 1e-10)
            << system << " " << part << " " << i;
      }
    }
  }
  const Json other = record({"--continue", "first.json", "--until", "1.5", "--scheme", "balance"});
  EXPECT_EQ(other["time"], 1.5);
  EXPECT_EQ(other["scheme"], "balance");
  record({"suslov", "--until", "1", "--output-times", "0,0.5,1", "-o", "first.json"});
  const Json times = record({"--continue", "first.json"})["output_times"];
  EXPECT_EQ(times, Json({1.0, 1.5, 2.0}));
  write("no.json", "{}");
  EXPECT_THAT(run({"run", "--continue", "no.json"}).err, HasSubstr("not the record of a run"));
  EXPECT_THAT(run({"run", "suslov", "--step", "0.01", "--from", "1", "--until", "0.5"}).err,
              HasSubstr("until: got 0.5, expected a time beyond from, 1"));
}

// ---- the exact motion ---------------------------------------------------------------------------

TEST_F(Words, TheExactMotionCanBeLeftOut) {
  const Json with = record({"chaplygin_sleigh", "--until", "1"}),
             without = record({"chaplygin_sleigh", "--until", "1", "--no-exact"});
  EXPECT_TRUE(with["diagnostics"]["exact_error_max"].is_number());
  for (const char* none : {"exact_error_final", "exact_error_max", "exact_velocity_error_max"})
    EXPECT_TRUE(without["diagnostics"][none].is_null()) << none;
  run({"run", "chaplygin_sleigh", "--until", "1", "--no-exact", "-o", "a.csv"});
  EXPECT_THAT(contents(file("a.csv")), Not(HasSubstr("exact_error,")));
}

/// At 1e12 rad/s the path would take 1e15 evaluations; from a later time a rider's motion has no
/// closed form here.
TEST_F(Words, AnExactMotionThatCannotBeFollowedIsSaidToBeLeftOut) {
  const Json fast = record(
      {"chaplygin_sleigh", "--velocity", "1e12,1e12,0", "--step", "1e-14", "--until", "1e-13"});
  EXPECT_TRUE(fast["diagnostics"]["exact_error_max"].is_number()) << fast["notes"];
  const Json faster = record({"chaplygin_sleigh", "--velocity", "1,1e12,0", "--step", "0.01"});
  EXPECT_TRUE(faster["diagnostics"]["exact_error_max"].is_null());
  EXPECT_THAT(faster["notes"].dump(), HasSubstr("the exact motion was not followed to t = 0.01"));
  const Json later = record({"snakeboard", "--from", "0.5", "--until", "1"});
  EXPECT_TRUE(later["diagnostics"]["exact_error_max"].is_null());
  EXPECT_THAT(later["notes"].dump(), HasSubstr("known from t = 0 on only"));
  // One that does not know the time is compared with from any.
  EXPECT_LT(record({"chaplygin_sleigh", "--from", "5", "--until",
                    "6"})["diagnostics"]["exact_velocity_error_max"],
            1e-3);
}

// ---- the terminal -------------------------------------------------------------------------------

TEST_F(Words, ListsFitEightyColumns) {
  for (const std::string& line : lines(run({"list"}).out)) EXPECT_LE(line.size(), 80u) << line;
}

TEST_F(Words, ATerminalShowsNoMarkdown) {
  write("study.toml",
        "until = 2\nscheme = [\"lift\", \"boxed\"]\nstep = [0.2, 0.1, 0.05]\nrepeats = 1\n"
        "[[system]]\nname = \"suslov\"\n");
  const Outcome o = run({"study", "study.toml"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("scheme, "), Not(HasSubstr("`")), Not(HasSubstr("**"))));
}

}  // namespace
