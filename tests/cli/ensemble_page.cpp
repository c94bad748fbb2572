// The page of hamel ensemble: figures over what is varied, in pairs, and each member by a click.
#include <cmath>

#include "program.hpp"

namespace {

using namespace hamel::test;
using testing::HasSubstr;

class EnsemblePage : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    if (page_of({"suslov"}).is_null()) HAMEL_SKIP_WITHOUT("page");
  }
  nlohmann::json page(const std::string& text, const std::string& name = "many.toml") const {
    write(name, text);
    return page_by({"ensemble", name, "-o", "out", "--quiet", "--fresh"}, "out/report.html");
  }
  /// The first block of a kind.
  static nlohmann::json block_of(const nlohmann::json& page, const std::string& kind) {
    for (const auto& section : page["sections"])
      for (const auto& block : section["blocks"])
        if (block["kind"] == kind) return block;
    return nullptr;
  }
};

/// Two lists give heat maps, failed members are marked; draws give dots and distributions.
TEST_F(EnsemblePage, ThePageShowsWhatIsKeptOverWhatIsVaried) {
  write("grid.toml", R"toml(system = "chaplygin_sleigh"
until = 2
grid = true
keep = ["end.theta", { name = "bad", formula = "1 / (member - 4)" }]
[vary]
start.omega = { values = [-1, 1] }
offset = { values = [0.1, 0.2, 0.3] }
)toml");
  const nlohmann::json grid =
      page_by({"ensemble", "grid.toml", "-o", "out", "--quiet"}, "out/report.html");
  std::string sections;  // figures before tables, for a phone
  for (const nlohmann::json& section : grid["sections"])
    sections += section["title"].get<std::string>() + "; ";
  EXPECT_THAT(sections, testing::StartsWith("Members; What is kept over what is varied; Values; "));
  const nlohmann::json map = figure_of(grid, "end.theta [rad]");
  EXPECT_EQ(map["kind"], "heatmap");
  EXPECT_EQ(map["x"], "offset [m]");
  EXPECT_EQ(map["values"][1][1], nullptr);
  EXPECT_EQ(map["marks"][1][1], "failed");
  EXPECT_EQ(map["marks"][0][0], "");
  const std::vector<std::string> rows = lines(contents(file("out/ensemble.csv")));
  EXPECT_NEAR(map["values"][1][2].get<double>(), std::stod(split(rows[6])[3]), 1e-5);
  EXPECT_EQ(figure_of(grid, "Failed members")["rows"][0][0], 4);

  const nlohmann::json drawn = page(R"toml(system = "rattleback"
until = 1
members = 301
seed = 4
keep = ["end.omega3", { name = "bad", formula = "1 / (member - 100)" }]
[vary]
start.omega3 = { uniform = [-3, -0.5] }
skew = { normal = [0.3, 0.05] }
)toml");
  EXPECT_EQ(figure_of(drawn, "end.omega3 over skew")["series"][0]["x"].size(), 300u);
  double members = 0;
  const nlohmann::json stairs = figure_of(drawn, "Members by end.omega3")["series"][0];
  EXPECT_FALSE(stairs.contains("envelope")) << "no curve of many turns";
  EXPECT_EQ(stairs.at("low").size(), stairs.at("y").size());
  for (const auto& count : stairs.at("y"))
    members += count.get<double>() / 2;  // each bin has two edges
  EXPECT_EQ(members, 300);
}

/// In the plane of what is varied, and over each: a colour for each class, one for failures.
TEST_F(EnsemblePage, ThePageColoursClassesAndFailures) {
  write("classes.toml", R"toml(system = "chaplygin_sleigh"
until = 2
members = 40
keep = ["end.theta", { name = "bad", formula = "1 / (member - 4)" }]
class = { formula = "start.omega > 0 ? 1 : 0", names = ["right", "left"] }
[vary]
start.omega = { uniform = [-1, 1] }
offset = { uniform = [0.1, 0.3] }
)toml");
  const nlohmann::json page =
      page_by({"ensemble", "classes.toml", "-o", "out", "--quiet"}, "out/report.html");
  std::map<std::string, std::vector<double>> spins;
  const nlohmann::json plane = figure_of(page, "Members over start.omega and offset");
  for (const auto& series : plane["series"])
    spins[series["name"]] = series["x"].get<std::vector<double>>();
  ASSERT_EQ(spins["failed"].size(), 1u);
  EXPECT_EQ(spins["right"].size() + spins["left"].size(), 39u);
  for (const double spin : spins["right"]) EXPECT_LE(spin, 0);
  for (const double spin : spins["left"]) EXPECT_GT(spin, 0);
  const nlohmann::json over = figure_of(page, "end.theta over offset")["series"];
  EXPECT_EQ(over[0]["name"], "right");
  EXPECT_EQ(over[0]["x"].size(), spins["right"].size());
}

/// A combination is a cell of the class of its members, by colour and name; a click shows the
/// member.
TEST_F(EnsemblePage, AMapOfClassesHasTheirNames) {
  const nlohmann::json shown = page(R"toml(system = "chaplygin_sleigh"
until = 1
grid = true
members = 12
keep = ["end.theta", "end.v1", "start.v1"]
class = { formula = "member == 3 ? 2 : start.omega > 0 ? 1 : 0", names = ["right", "left", "third"] }
[vary]
start.omega = { values = [-1, 1] }
offset = { values = [0.1, 0.2, 0.3] }
)toml");
  const nlohmann::json map = figure_of(shown, "class");
  EXPECT_EQ(map["classes"], nlohmann::json({"right", "left", "third"}));
  EXPECT_EQ(map["values"], nlohmann::json({{0, 0, 0}, {1, 1, 1}}));  // 1 and 2: the first of equals
  EXPECT_EQ(map["members"], nlohmann::json({{0, 1, 2}, {3, 4, 5}}));
  EXPECT_THAT(std::string(map["note"]), HasSubstr("most frequent class of its 2 members"));
  EXPECT_FALSE(figure_of(shown, "end.theta [rad]").contains("classes"));

  const nlohmann::json members = block_of(shown, "members");
  EXPECT_EQ(members["count"], 12);
  EXPECT_EQ(members["command"], "hamel ensemble many.toml --member {} -o FOLDER");
  EXPECT_EQ(members["columns"].back()["names"][2], "third");
  EXPECT_EQ(members["columns"].back()["values"][3], 2);
  // One member of each class moves; what is drawn of it is that of its own run.
  ASSERT_EQ(members["motions"].size(), 3u);
  for (const char* k : {"0", "3", "4"})
    EXPECT_EQ(members["motions"][k][0]["kind"], "animation") << k;
  EXPECT_EQ(members["motions"]["0"][0]["times"].back(), 1);
}

/// Pairs of what is kept: what does not vary is left out, and said so; correlations are of all.
TEST_F(EnsemblePage, WhatIsKeptInPairs) {
  const nlohmann::json shown = page(R"toml(system = "chaplygin_sleigh"
until = 0.1
members = 9000
step = 0.05
scheme = "lift"
keep = [{ name = "first", formula = "start.omega" }, { name = "twice", formula = "-2 * start.omega" }, { name = "square", formula = "(start.omega)^2" },
  { name = "one", formula = "1" }, { name = "a", formula = "start.omega + 1" }, { name = "b", formula = "start.omega + 2" },
  { name = "c", formula = "member < 4500 ? start.omega : sqrt(-1)" }, { name = "d", formula = "start.omega + 4" }]
[vary]
start.omega = { range = [-1, 1, 9000] }
)toml");
  const nlohmann::json matrix = figure_of(shown, "What is kept, in pairs");
  ASSERT_EQ(matrix["columns"].size(), 6u);
  EXPECT_EQ(matrix["columns"][1]["name"], "twice");
  EXPECT_NEAR(matrix["columns"][0]["correlation"][1].get<double>(), -1, 1e-9);
  // Half of the members fail: x and x^2 are uniform on [-1, 0].
  EXPECT_NEAR(matrix["columns"][0]["correlation"][2].get<double>(), -std::sqrt(15) / 4, 1e-3);
  EXPECT_EQ(matrix["members"][1], 3);
  EXPECT_EQ(matrix["members"].size(), 1500u);  // those that have not failed
  EXPECT_THAT(std::string(matrix["note"]), HasSubstr("Each 3rd member."));
  EXPECT_THAT(std::string(matrix["note"]), HasSubstr("Left out: d."));
  EXPECT_THAT(std::string(matrix["note"]), HasSubstr("The same in all members: one."));
  const nlohmann::json curve = figure_of(shown, "a over start.omega");
  EXPECT_EQ(curve["series"][0]["members"][2], 6);
}

/// 10^5 members: the page says how many it shows, and is small.
TEST_F(EnsemblePage, ManyMembersAreThinned) {
  const nlohmann::json shown = page(R"toml(system = "suslov"
until = 0.1
step = 0.1
scheme = "lift"
grid = true
members = 100000
keep = ["end.omega1", "end.omega2"]
trajectories = [50001]
[vary]
start.omega1 = { range = [-1, 1, 400] }
start.omega2 = { range = [-1, 1, 250] }
)toml");
  const nlohmann::json members = block_of(shown, "members"), map = block_of(shown, "heatmap");
  EXPECT_EQ(members["count"], 100000);
  // 27 shares no factor with 400 and 250; the member that moves is there too.
  EXPECT_EQ(members["index"].size(), 3705u);
  EXPECT_EQ(members["index"][1], 27);
  EXPECT_THAT(members["index"], testing::Contains(50001));
  EXPECT_TRUE(members["motions"].contains("50001"));
  EXPECT_EQ(members["columns"][0]["values"].size(), 3705u);
  EXPECT_THAT(members["paragraphs"].dump(), HasSubstr("3705 of the 100000 members: each 27th"));
  EXPECT_EQ(map["values"].size(), 100u);
  EXPECT_EQ(map["values"][0].size(), 84u);  // 3 of 250 together
  EXPECT_THAT(std::string(map["note"]), HasSubstr("4 x 3 combinations are one cell"));
  EXPECT_LT(std::filesystem::file_size(file("out/report.html")), 3'000'000u);
}

/// The members that the file names are written as runs, and move on the page.
TEST_F(EnsemblePage, TrajectoriesThatAreNamed) {
  const std::string text = R"toml(system = "rattleback"
until = 1
members = 5
trajectories = [4, 1]
keep = ["end.omega3", { name = "bad", formula = "1 / (member - 2)" }]
[vary]
start.omega3 = { uniform = [-3, -0.5] }
)toml";
  const nlohmann::json members = block_of(page(text), "members");
  ASSERT_EQ(members["motions"].size(), 2u);
  EXPECT_TRUE(members["motions"].contains("4") && members["motions"].contains("1"));
  EXPECT_EQ(members["failures"].size(), 1u);
  EXPECT_THAT(std::string(members["failures"]["2"]), HasSubstr("'bad' is inf"));
  for (const std::string k : {"1", "4"}) {
    EXPECT_TRUE(std::filesystem::exists(file("out/member-" + k + ".toml")));
    EXPECT_TRUE(std::filesystem::exists(file("out/member-" + k + ".h5")) ||
                std::filesystem::exists(file("out/member-" + k + ".csv")));
    const nlohmann::json again = record({"--config", "out/member-" + k + ".toml"});
    EXPECT_NEAR(again["final"]["velocity"][2].get<double>(),
                members["columns"][1]["values"][std::stoul(k)].get<double>(), 1e-4);
  }
  // A name that a shell would read otherwise is quoted.
  const nlohmann::json spaced = block_of(page(text, "it's many.toml"), "members");
  EXPECT_EQ(spaced["command"], "hamel ensemble 'it'\\''s many.toml' --member {} -o FOLDER");
}

}  // namespace
