// Pages that the library writes: the same blocks as those of the program, and refusals before
// anything is written.
#include <cstdlib>
#include <filesystem>

#include <hamel/simulate.hpp>

#include "../../cli/program.hpp"

namespace {

using namespace hamel;
using namespace hamel::test;
using Json = nlohmann::json;

// Titles of the sections, and of each its blocks: kind, title, the columns of a table.
std::vector<std::string> outline(const std::string& path) {
  std::vector<std::string> out;
  const Json page = page_data(contents(path));
  for (const Json& section : page["sections"]) {
    out.push_back(section["title"]);
    for (const Json& block : section["blocks"]) {
      out.push_back("  " + block["kind"].get<std::string>() + " " + block.value("title", "") + " " +
                    block.value("columns", Json()).dump().substr(0, 200));
    }
  }
  return out;
}

class Pages : public CommandLine {
 protected:
  void SetUp() override {
    CommandLine::SetUp();
    try {
      write_page(registry(), simulate("suslov").until(0.1).run(), file("any.html"));
    } catch (const ConfigError& error) {
      HAMEL_SKIP_WITHOUT("page");
    }
  }
};

TEST_F(Pages, OfARunIsThatOfTheProgram) {
  write_page(registry(), simulate("falling_disk").step(0.01).until(2).run(), file("ours.html"));
  ASSERT_EQ(
      run({"run", "falling_disk", "--step", "0.01", "--until", "2", "--report", "theirs.html"})
          .status,
      0);
  const auto ours = outline(file("ours.html"));
  EXPECT_GT(ours.size(), 15U);
  EXPECT_EQ(ours, outline(file("theirs.html")));
}

TEST_F(Pages, OfAStudyIsThatOfTheProgram) {
  const std::string text =
      "title = \"Two\"\nuntil = 1\nrepeats = 1\nscheme = [\"lift\", \"rkmk4\"]\n"
      "step = [0.1, 0.05]\n[[system]]\nname = \"suslov\"\n";
  write("two.toml", text);
  const StudyResult result =
      Study(registry(), parse_study(text, "two.toml", registry())).threads(1).run();
  write_page(result, file("ours.html"));
  ASSERT_EQ(run({"study", "two.toml", "-o", "out"}).status, 0);
  const auto ours = outline(file("ours.html"));
  EXPECT_GT(ours.size(), 8U);
  EXPECT_EQ(ours, outline(file("out/report.html")));
}

// A member of each class moves on it: the page runs them again.
TEST_F(Pages, OfAnEnsembleHasItsMotions) {
  const std::string text =
      "system = \"rattleback\"\nuntil = 0.5\nstep = 0.01\nkeep = [\"end.omega3\"]\n"
      "class = { formula = \"end.omega3 > 0 ? 1 : 0\", names = [\"left\", \"right\"] }\n"
      "[vary]\nstart.omega3 = { values = [-3, -2, 2, 3] }\n";
  write("four.toml", text);
  const EnsembleResult result =
      Ensemble(registry(), parse_ensemble(text, "four.toml", registry())).run();
  write_page(registry(), result, file("ours.html"));
  ASSERT_EQ(run({"ensemble", "four.toml", "-o", "out"}).status, 0);
  EXPECT_EQ(outline(file("ours.html")), outline(file("out/report.html")));
  std::vector<std::string> moving;
  const Json page = page_data(contents(file("ours.html")));
  for (const Json& section : page["sections"])
    for (const Json& block : section["blocks"])
      if (block["kind"] == "members")
        for (const auto& item : block["motions"].items()) moving.push_back(item.key());
  EXPECT_EQ(moving, (std::vector<std::string>{"0", "2"}));
}

// Corners that strike at once take their energy once: with friction the box has lost what the table
// sums, but for the steps' error.
TEST_F(Pages, EnergyTakenAtContactsIsWhatTheMotionHasLost) {
  const char* root = std::getenv("HAMEL_SOURCE");
  ASSERT_NE(root, nullptr) << "set HAMEL_SOURCE to the source tree (ctest does)";
  const Result box = simulate(std::string(root) + "/tests/examples/thrown_box.toml")
                         .with(&Config::slip, true)
                         .scheme("nonsmooth")
                         .step(0.0005)
                         .until(1.2)
                         .run();
  write_page(registry(), box, file("box.html"));
  double taken = 0;
  bool together = false;
  const Json page = page_data(contents(file("box.html")));
  for (const Json& section : page["sections"])
    for (const Json& block : section["blocks"])
      if (block.value("title", "") == "Energy taken at contacts")
        for (const Json& row : block["rows"]) {
          taken += row[2].get<double>() + row[3].get<double>();
          together = together || row[0].get<std::string>().find(", ") != std::string::npos;
        }
  const std::vector<double> energy = box.trajectory.column("energy");
  EXPECT_TRUE(together);
  EXPECT_NEAR(taken, energy.front() - energy.back(), 0.01 * taken);
}

TEST_F(Pages, RefusesBeforeAnythingIsWritten) {
  const Result one = simulate("suslov").until(0.1).run();
  const auto refusal = [](const auto& write) -> std::string {
    try {
      write();
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal([&] { write_page(registry(), one, file("run.htm")); }),
              testing::HasSubstr("output format '.htm'"));
  EXPECT_THAT(refusal([&] { write_page(registry(), one, file("no/run.html")); }),
              testing::HasSubstr("no/run.html"));
  StudyConfig two;
  two.systems = {{.label = "suslov", .name = "suslov"}};
  two.axes = {{"step", {0.1, 0.05}}};
  two.until = 0.5;
  const StudyResult half = Study(registry(), two).folder(file("half")).shard({1, 2}).run();
  EXPECT_THAT(refusal([&] { write_page(half, file("half.html")); }),
              testing::HasSubstr("got a shard, expected a whole study"));
  for (const char* name : {"run.htm", "half.html"})
    EXPECT_FALSE(std::filesystem::exists(file(name))) << name;
}

}  // namespace
