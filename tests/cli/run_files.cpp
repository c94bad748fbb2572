// Files of hamel run: CSV, JSON, --every, --config.
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using Json = nlohmann::json;
using testing::HasSubstr;

class Files : public CommandLine {};

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> cells;
  std::string record;
};
Table read_csv(const std::string& text) {
  Table out;
  for (const std::string& line : lines(text)) {
    if (line.rfind("#", 0) == 0) out.record += line.substr(1) + "\n";
    else if (out.columns.empty()) out.columns = split(line);
    else out.cells.push_back(split(line));
  }
  return out;
}

const std::vector<std::string> measured = {"energy",       "energy_error", "constraint",
                                           "group_defect", "iterations",   "residual"};

/// t, the element, the velocity, the measurements, in the order of tools/README.md; later columns
/// come after.
void expect_columns(const Table& table, const std::vector<std::string>& element,
                    const std::vector<std::string>& velocity) {
  std::vector<std::string> expected = {"t"};
  expected.insert(expected.end(), element.begin(), element.end());
  expected.insert(expected.end(), velocity.begin(), velocity.end());
  expected.insert(expected.end(), measured.begin(), measured.end());
  ASSERT_GE(table.columns.size(), expected.size());
  EXPECT_EQ(std::vector<std::string>(table.columns.begin(),
                                     table.columns.begin() + static_cast<long>(expected.size())),
            expected);
}

TEST_F(Files, CsvColumnsOfEverySystem) {
  const auto table = [&](const char* system) {
    EXPECT_EQ(run({"run", system, "--until", "0.1", "-o", "a.csv", "--quiet"}).status, 0);
    return read_csv(contents(file("a.csv")));
  };
  expect_columns(table("suslov"), {"R11", "R12", "R13", "R21", "R22", "R23", "R31", "R32", "R33"},
                 {"omega1", "omega2", "omega3"});
  expect_columns(table("chaplygin_sleigh"), {"theta", "x", "y"}, {"omega", "v1", "v2"});
  expect_columns(table("rolling_disk"), {"theta", "x", "y", "roll"},
                 {"omega", "v1", "v2", "roll'"});
  // A mechanism's by its parts, as in tools/README.md.
  const auto bicycle = table("bicycle").columns;
  for (const char* name :
       {"steer.angle", "steer.rate", "holonomic", "rear.reaction1", "rear.reaction3"}) {
    EXPECT_THAT(bicycle, testing::Contains(name));
  }
}

// Events are a table beside the rows: names, times and states as the record has them.
TEST_F(Files, EventsAreATable) {
  const auto events = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", "chaplygin_sleigh", "--until", "6", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(run(words).status, 0);
  };
  events({"-o", "none.csv"});
  events({"--events", "cusp,max(theta,x)=1.5", "-o", "a.csv", "-o", "a.json", "-o", "b.csv.gz"});
  events({"--events", "theta=1000", "-o", "c.csv"});
  EXPECT_THAT(files(), testing::UnorderedElementsAre("none.csv", "a.csv", "a.events.csv", "a.json",
                                                     "b.csv.gz", "b.events.csv.gz", "c.csv",
                                                     "c.events.csv"));
  const auto table = lines(contents(file("a.events.csv")));
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[0], "name,t,theta,x,y,omega,v1,v2");
  EXPECT_EQ(contents(file("c.events.csv")), table[0] + "\n");
  const auto met = nlohmann::json::parse(contents(file("a.json")))["events"];
  ASSERT_EQ(met.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    const std::string name = met[i]["name"];
    const std::string field = name == "cusp" ? name : "\"" + name + "\"";
    ASSERT_TRUE(table[i + 1].starts_with(field + ",")) << table[i + 1];
    std::vector<double> expected = {met[i]["time"]};
    for (const char* part : {"configuration", "velocity"})
      for (const double value : met[i][part]) expected.push_back(value);
    const auto words = split(table[i + 1].substr(field.size() + 1));
    ASSERT_EQ(words.size(), expected.size());
    for (size_t k = 0; k < words.size(); ++k) EXPECT_EQ(std::stod(words[k]), expected[k]);
  }
}

// Their file is looked at before the run, as every output.
TEST_F(Files, WhatIsInTheWayOfEvents) {
  const std::vector<std::string> words = {"run", "suslov", "--events", "t=1", "--quiet"};
  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 2);
    return o.err;
  };
  EXPECT_THAT(refused({"-o", "a.events.csv", "-o", "a.csv"}),
              HasSubstr("'a.events.csv' is given, and the events of 'a.csv' go there"));
  EXPECT_THAT(refused({"-o", "a.csv", "-o", "a.events.csv"}), HasSubstr("given twice"));
  std::filesystem::create_directory(file("b.events.csv"));
  EXPECT_THAT(refused({"-o", "b.csv"}), HasSubstr("b.events.csv"));
  EXPECT_THAT(files(), testing::ElementsAre("b.events.csv"));
}

TEST_F(Files, CsvNumbersReadBackExactly) {
  ASSERT_EQ(run({"run", "suslov", "--until", "1", "-o", "a.csv", "-o", "a.json", "--quiet"}).status,
            0);
  const Table table = read_csv(contents(file("a.csv")));
  ASSERT_EQ(table.cells.size(), 101u);
  for (const auto& row : table.cells) {
    ASSERT_EQ(row.size(), table.columns.size());
    for (const std::string& cell : row) {
      char* end = nullptr;
      const double value = std::strtod(cell.c_str(), &end);
      ASSERT_EQ(*end, '\0') << cell;
      char again[40];
      std::snprintf(again, sizeof again, "%.17g", value);
      EXPECT_EQ(std::strtod(again, nullptr), value);
    }
  }
  // 17 digits: an irrational entry has them all.
  size_t digits = 0;
  for (const char c : table.cells[50][1]) digits += c >= '0' && c <= '9' ? 1u : 0u;
  EXPECT_GE(digits, 16u) << table.cells[50][1];
  // The last row is the final state of the record, to the last bit.
  const Json record = Json::parse(contents(file("a.json")));
  EXPECT_EQ(std::stod(table.cells.back()[10]), record["final"]["velocity"][0].get<double>());
  EXPECT_EQ(std::stod(table.cells.back()[13]), record["final"]["energy"].get<double>());
  // The # lines are the record.
  const Json in_csv = Json::parse(table.record);
  EXPECT_EQ(in_csv, record);
}

TEST_F(Files, UnwrappedAngles) {
  ASSERT_EQ(
      run({"run", "rolling_disk", "--until", "20", "--every", "100", "-o", "a.csv", "--quiet"})
          .status,
      0);
  const Table table = read_csv(contents(file("a.csv")));
  EXPECT_NEAR(std::stod(table.cells.back()[1]), 0.7 * 20, 0.01);
  EXPECT_NEAR(std::stod(table.cells.back()[4]), 2 * 20, 0.01);
}

TEST_F(Files, Every) {
  for (const auto& [every, rows] :
       {std::pair{"1", 11u}, {"3", 5u}, {"5", 3u}, {"10", 2u}, {"1000", 2u}}) {
    ASSERT_EQ(run({"run", "suslov", "--step", "0.01", "--until", "0.1", "--every", every, "-o",
                   "a.csv", "--quiet"})
                  .status,
              0);
    const Table table = read_csv(contents(file("a.csv")));
    EXPECT_EQ(table.cells.size(), rows) << every;
    EXPECT_EQ(std::stod(table.cells.front()[0]), 0);
    EXPECT_NEAR(std::stod(table.cells.back()[0]), 0.1, 1e-15);
  }
}

TEST_F(Files, SeveralOutputsAndOverwriting) {
  std::ofstream(file("a.csv")) << "old";
  ASSERT_EQ(run({"run", "suslov", "--until", "0.1", "-o", "a.csv", "--output", "b.csv", "-o",
                 "c.json", "--quiet"})
                .status,
            0);
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.csv", "b.csv", "c.json"));
  EXPECT_EQ(contents(file("a.csv")), contents(file("b.csv")));
}

TEST_F(Files, TheCommandLineWinsOverTheConfig) {
  std::ofstream(file("run.toml")) << R"(system = "chaplygin_sleigh"
velocity = [0.5, 1, 0]
scheme = "balance"
s = 0.25
retraction = "exp"
step = 0.02
until = 1
every = 5
[set]
mass = 2
offset = 0.4
)";
  const auto with = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--config", "run.toml"});
    return record(arguments);
  };
  const Json plain = with({});
  EXPECT_EQ(plain["system"], "chaplygin_sleigh");
  EXPECT_EQ(plain["scheme"], "balance");
  EXPECT_EQ(plain["s"], 0.25);
  EXPECT_EQ(plain["retraction"], "exp");
  EXPECT_EQ(plain["steps"], 50);
  EXPECT_EQ(plain["parameters"]["mass"], 2.0);
  EXPECT_EQ(plain["parameters"]["offset"], 0.4);
  EXPECT_EQ(plain["parameters"]["inertia"], 0.1);
  const Json over =
      with({"--scheme", "lift", "--set", "mass=3", "--step", "0.1", "--momentum", "1,2,0"});
  EXPECT_EQ(over["scheme"], "lift");
  EXPECT_EQ(over["s"], 0.25);
  EXPECT_EQ(over["steps"], 10);
  EXPECT_EQ(over["parameters"]["mass"], 3.0);
  EXPECT_EQ(over["parameters"]["offset"], 0.4);
  // A system on the command line replaces the file's, whose parameters then do not fit.
  const Outcome other = run({"run", "suslov", "--config", "run.toml"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("mass"));
}

/// A system by data resumes from its file, not by the name in it.
TEST_F(Files, ASystemByDataGoesOn) {
  std::ofstream(file("scooter.toml")) << source_file("tests/examples/scooter_by_rows.toml");
  for (const std::string name : {"a.json", "a.h5"}) {
    Outcome o = run({"run", "scooter.toml", "--until", "1", "-o", name, "--quiet"});
    if (o.err.find("no HDF5") != std::string::npos) continue;
    ASSERT_EQ(o.status, 0) << o.err;
    const Json on = record({"--continue", name});
    EXPECT_EQ(on["system"], "kick scooter");
    EXPECT_EQ(on["system_file"], "scooter.toml");
    EXPECT_EQ(on["until"], 2.0);
  }
}

TEST_F(Files, AConfigThatDoesNotFit) {
  std::ofstream(file("bad.toml")) << "system = \"suslov\"\nstpe = 0.1\n";
  const Outcome o = run({"run", "--config", "bad.toml", "-o", "a.csv"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, testing::AllOf(HasSubstr("bad.toml:2:"), HasSubstr("did you mean 'step'?")));
  EXPECT_THAT(files(), testing::ElementsAre("bad.toml"));
  EXPECT_EQ(run({"run", "--config", "missing.toml"}).status, 2);
}

/// A motion that leaves what elements can hold ends as any numerical failure does: status 1, the
/// good rows in the files, which can be continued from.
TEST_F(Files, AnAngleBeyondTheElements) {
  const std::string system = write("group = \"so2\"\ninertia = [1]\nvelocity = [1e7]\n");
  const Outcome o =
      run({"run", system, "--until", "1000", "--quiet", "-o", file("x.csv"), "-o", file("x.json")});
  EXPECT_EQ(o.status, 1) << o.err;
  EXPECT_THAT(o.err, HasSubstr("expected an angle in radians below 1e9"));
  EXPECT_GT(lines(contents(file("x.csv"))).size(), 5000u);
  EXPECT_FALSE(std::filesystem::exists(file("x.csv.part")));
  EXPECT_EQ(run({"run", "--continue", file("x.json"), "--quiet"}).status, 1);
}

}  // namespace
