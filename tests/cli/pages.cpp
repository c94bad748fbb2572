// The texts of the pages of runs, comparisons, sweeps and studies, as the program writes them.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>

#include <fmt/format.h>

#include "program.hpp"

namespace {

using hamel::test::figure_of;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Pages : public hamel::test::CommandLine {
 protected:
  /// status and text of the verdict of a run; empty without the page.
  std::pair<std::string, std::string> verdict(const std::vector<std::string>& arguments) const {
    const json page = page_of(arguments);
    if (page.is_null()) return {};
    const json& block = page["sections"][0]["blocks"][0];
    EXPECT_EQ(block["kind"], "verdict");
    return {block["status"], block["text"]};
  }
};

// OK means right: what is wrong or not known is a note.
TEST_F(Pages, OkMeansRight) {
  if (page_of({"suslov"}).is_null()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_EQ(verdict({"suslov"}).first, "ok");
  EXPECT_EQ(verdict({"rattleback", "--check"}).first, "ok");
  const auto lost = verdict({"chaplygin_sleigh", "--scheme", "unadapted", "--step", "0.05"});
  EXPECT_EQ(lost.first, "note");
  EXPECT_THAT(lost.second, HasSubstr("off by at most **3.7e+01**"));
  EXPECT_THAT(lost.second, HasSubstr("leave the constraint"));
  // A step of rkmk4 is no step along one admissible velocity; its error is known, and small.
  EXPECT_EQ(verdict({"chaplygin_sleigh", "--scheme", "rkmk4"}).first, "ok");
  const auto unknown = verdict({"falling_disk"});
  EXPECT_EQ(unknown.first, "note");
  EXPECT_THAT(unknown.second, HasSubstr("error is not known"));
  // Its estimate is small: it converges, to another motion.
  EXPECT_EQ(verdict({"chaplygin_sleigh", "--scheme", "unadapted", "--check", "--no-exact"}).first,
            "note");
}

// Backwards, far from t = 0, and ended right behind a node: the times of a page are all there, and
// rise in its motion.
TEST_F(Pages, TimesOfTheirOwn) {
  if (page_of({"suslov"}).is_null()) HAMEL_SKIP_WITHOUT("page");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"chaplygin_sleigh", "--step", "-0.01", "--until", "-5"},
        {"chaplygin_sleigh", "--from", "1e6", "--until", "1000001"},
        {"chaplygin_sleigh", "--stop-at", "theta=1.7753262"}}) {
    const json page = page_of(words);
    for (const json& section : page["sections"]) {
      for (const json& block : section["blocks"]) {
        if (block["kind"] == "animation") {
          const auto times = block["times"].get<std::vector<double>>();
          EXPECT_TRUE(std::ranges::is_sorted(times, std::less_equal<>())) << words.back();
        }
        if (block["kind"] != "plot" || block["x"] != "time t [s]") continue;
        const auto x = block["series"][0]["x"].get<std::vector<double>>();
        EXPECT_GT(std::set<double>(x.begin(), x.end()).size(), x.size() * 9 / 10) << block["title"];
      }
    }
  }
}

// The estimate is described by the runs it was made of.
TEST_F(Pages, HowTheErrorIsKnown) {
  if (page_of({"suslov"}).is_null()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_THAT(verdict({"rattleback", "--step", "0.01", "--until", "2", "--check"}).second,
              HasSubstr("By half and a quarter of the step"));
  EXPECT_THAT(verdict({"falling_disk", "--scheme", "dop853", "--rtol", "1e-8", "--check"}).second,
              HasSubstr("By a tenth and a hundredth of the tolerance"));
  EXPECT_THAT(verdict({"suslov", "--no-exact"}).second, HasSubstr("left out (`--no-exact`)"));
  // No step makes it better: its step size cancels.
  const std::string stuck =
      verdict({"suslov", "--scheme", "boxed_literal", "--no-exact", "--check"}).second;
  EXPECT_THAT(stuck, HasSubstr("give no estimate"));
  EXPECT_THAT(stuck, Not(HasSubstr("--check")));
}

// A contact that ceased to push between two recorded states is not reported to push all along.
TEST_F(Pages, ContactThatIsLost) {
  const json page =
      page_of({"falling_disk", "--scheme", "dop853", "--rtol", "1e-10", "--output-step", "0.05",
               "--stop-at", "contact_lost,fallen", "--velocity", "0.5,0,0,0,0,0"});
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  const std::string note = figure_of(page, "Reaction forces")["note"];
  EXPECT_THAT(note, HasSubstr("**ceases to push** at t = 0.556143 (`contact_lost`)"));
  EXPECT_THAT(note, Not(HasSubstr("all along")));
  EXPECT_THAT(page["sections"][0]["blocks"][0]["text"].get<std::string>(),
              HasSubstr("It stopped at contact_lost"));
  EXPECT_THAT(figure_of(page_of({"rattleback"}), "Reaction forces")["note"].get<std::string>(),
              HasSubstr("at the recorded states the contact pushes"));
}

// A ball that falls from 1 m, with e = 0.5, loses m g h (1 - e^2) at its first strike, a quarter of
// that at the next.
TEST_F(Pages, EventsHaveWhatStrikesTake) {
  const json page = page_of({"rolling_ball", "--set", "friction=0.2", "--set", "restitution=0.5",
                             "--slip", "--configuration", "1,0,0,0,1,0,0,0,1,0,0,1.1", "--set",
                             "radius=0.1", "--set", "mass=2", "--until", "1"});
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  const auto table = [&page](const std::string& title) {
    for (const json& section : page["sections"])
      for (const json& block : section["blocks"])
        if (block.value("title", "") == title) return block;
    return json();
  };
  const json events = table("Events"), taken = table("Energy taken at contacts");
  ASSERT_FALSE(events.is_null());
  ASSERT_FALSE(taken.is_null());
  const std::vector<std::string> columns = events["columns"];
  EXPECT_THAT(columns, testing::ElementsAre("name", "time [s]", "omega1 [rad/s]", "omega2 [rad/s]",
                                            "omega3 [rad/s]", "x' [m/s]", "y' [m/s]", "z' [m/s]",
                                            "energy taken [J]"));
  EXPECT_EQ(events["rows"][0][0], "contact.strikes");
  EXPECT_EQ(events["rows"][0][7], "-4.429 \u2192 2.215");
  EXPECT_NEAR(events["rows"][0].back().get<double>(), 2 * 9.81 * 0.75, 1e-6);
  EXPECT_EQ(taken["rows"][0][1], 2);
  EXPECT_NEAR(taken["rows"][0][2].get<double>(), 2 * 9.81 * 0.75 * 1.25, 1e-6);
  EXPECT_EQ(taken["rows"][0][3], 0);  // it does not slip
}

// A block that slides: its cone stands on the ground, and the reaction lies on it.
TEST_F(Pages, MotionHasTheConesOfFriction) {
  const std::string block = write("block.toml", R"toml(
body = [{ name = "block", mass = 1, at = [0, 0, 0.1], inertia = [0.01, 0.01, 0.01] }]
joint = [{ name = "root", kind = "free", child = "block", at = [0, 0, 0.1] }]
point = [{ name = "foot", body = "block", at = [0, 0, 0], friction = 0.3 }]
[start]
v1 = 2
w1 = 0
w2 = 0
w3 = 0
)toml");
  const json page = page_of({block, "--slip", "--until", "0.05"});
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  const json force = figure_of(page, "Motion")["forces"][0];
  ASSERT_TRUE(force.contains("cone")) << force.dump().substr(0, 300);
  EXPECT_EQ(force["cone"]["friction"], 0.3);
  EXPECT_EQ(force["cone"]["normals"], json::parse("[[0, 0, 1]]"));
  EXPECT_EQ(force["modes"][0], 2);
  for (const json& value : force["values"])
    EXPECT_NEAR(std::hypot(value[3].get<double>(), value[4].get<double>()),
                0.3 * value[5].get<double>(), 1e-4);
}

// The rows of which the points are the largest are stated.
TEST_F(Pages, LargestOfSoMany) {
  const json page = page_of({"suslov", "--until", "6"});  // 601 states, 240 points
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_EQ(figure_of(page, "Group defect")["note"],
            "Each point is the largest of 2 or 3 recorded states.");
  const json many = page_of({"suslov", "--step", "0.0005", "--until", "60"});  // 120001 states
  const std::string largest =
      fmt::format("{:.2g}", many["sections"]
                                .back()["blocks"][0]["record"]["diagnostics"]["group_defect_max"]
                                .get<double>());
  EXPECT_EQ(figure_of(many, "Group defect")["note"],
            "Each point is the largest of 250 or 251 states, one in 2 of those recorded. The "
            "largest of all recorded: " +
                largest + ".");
}

// Axes that turn too often for a figure are shown for as long as the curve is that of the motion.
TEST_F(Pages, AxesOnTheSphereAreNotAliased) {
  const auto widest = [](const json& figure) {
    double out = 0;
    for (const json& series : figure["series"]) {
      const json& points = series["points"];
      for (size_t i = 1; i < points.size(); ++i) {
        double square = 0;
        for (size_t k = 0; k < 3; ++k)
          square += std::pow(points[i][k].get<double>() - points[i - 1][k].get<double>(), 2);
        out = std::max(out, std::sqrt(square));
      }
    }
    return out;
  };
  const json page = page_of({"rattleback", "--until", "400"});
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  const json fast = figure_of(page, "Motion of the body axes"),
             slow = figure_of(page_of({"suslov"}), "Motion of the body axes");
  EXPECT_LT(widest(fast), 0.15);
  EXPECT_THAT(fast["note"].get<std::string>(), HasSubstr("To t = "));
  EXPECT_LT(widest(slow), 0.15);
  EXPECT_EQ(slow["note"], "Columns of R; drag to turn.");
}

// Multipliers of contacts are forces; of others nothing is known.
TEST_F(Pages, ReactionsOfContactsAreForces) {
  const json page = page_of({"bicycle", "--until", "0.1"});
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_EQ(figure_of(page, "Reaction forces: rear")["y"], "lambda [N]");
  EXPECT_EQ(figure_of(page_of({"chaplygin_sleigh"}), "Reaction forces")["y"], "lambda");
}

// The reactions of each part have a figure; spins of wheels are not among the angles of the shape.
TEST_F(Pages, PartsAndSpinsHaveFiguresOfTheirOwn) {
  const auto bicycle = curves({"bicycle", "--speed", "5", "--until", "0.1"});
  if (bicycle.empty()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_THAT(bicycle.at("Reaction forces: front"),
              testing::ElementsAre("front.reaction1 [N]", "front.reaction2 [N]",
                                   "front.reaction3 [N], contact"));
  EXPECT_THAT(bicycle.at("Reaction forces: rear"),
              testing::ElementsAre("rear.reaction1 [N]", "rear.reaction2 [N]",
                                   "rear.reaction3 [N], contact"));
  EXPECT_THAT(bicycle.at("Spin of wheels and rotors"),
              testing::UnorderedElementsAre("front.rate [rad/s]", "rear.rate [rad/s]"));
  EXPECT_EQ(bicycle.at("Angular velocity").size(), 4u);
  EXPECT_THAT(bicycle.at("Angles of the shape"), testing::ElementsAre("steer.angle [rad]"));
  EXPECT_THAT(bicycle.at("Angles of wheels and rotors"),
              testing::UnorderedElementsAre("front.angle [rad]", "rear.angle [rad]"));
  const auto rolling = curves({"rolling_disk", "--until", "1"});
  EXPECT_EQ(rolling.count("Angles of the shape"), 0u);
  EXPECT_EQ(rolling.at("Angles of wheels and rotors").size(), 1u);
}

// Eigenvalues along a parameter: curves by the names of what moves, one colour in both figures,
// where nothing grows shaded; what the page was made from.
TEST_F(Pages, EigenvaluesAreCurves) {
  const json page =
      page_by({"steady", "bicycle", "--vary", "speed=4:6.5:6", "--report", "page.html"});
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  const json real = figure_of(page, "Real parts of the eigenvalues"),
             imaginary = figure_of(page, "Imaginary parts of the eigenvalues");
  EXPECT_EQ(real["x"], "speed [m/s]");
  ASSERT_EQ(real["series"].size(), 4u);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_FALSE(real["series"][i].value("dots", false));
    EXPECT_EQ(real["series"][i]["name"], imaginary["series"][i]["name"]);
    EXPECT_EQ(real["series"][i]["y"].size(), 6u);
  }
  EXPECT_THAT(real["series"][0]["name"].get<std::string>(), HasSubstr("steer.rate"));
  ASSERT_EQ(real["bands"].size(), 1u);
  EXPECT_NEAR(real["bands"][0]["from"], 4.29238253634111, 1e-8);
  EXPECT_NEAR(real["bands"][0]["to"], 6.02426201538837, 1e-8);
  const std::string text = page.dump();
  EXPECT_THAT(text, HasSubstr("hamel steady bicycle --vary speed=4:6.5:6"));
  EXPECT_THAT(text, HasSubstr("wheelbase"));
  const json segway =
      page_by({"steady", "segway", "--vary", "height=0.5:1:3", "--report", "page.html"});
  EXPECT_EQ(figure_of(segway, "Real parts of the eigenvalues")["x"], "height [m]");
}

// A study has no figure of one cell or of none, and no table of what was not measured.
TEST_F(Pages, NoEmptyFiguresOfAStudy) {
  if (page_of({"suslov"}).is_null()) HAMEL_SKIP_WITHOUT("page");
  const auto look = [&](const std::string& more) {
    write("small.toml",
          "until = 1\nrepeats = 1\nscheme = \"lift\"\n" + more +
              "[[system]]\nname = \"suslov\"\nlabel = \"one\"\n"
              "[[system]]\nname = \"suslov\"\nlabel = \"two\"\nset = {inertia = [2, 3, 4]}\n");
    return page_by({"study", "small.toml", "-o", "out", "--fresh", "--quiet"}, "out/report.html");
  };
  const auto titles = [](const json& page) {
    std::string out;
    for (const json& section : page["sections"]) {
      out += section["title"].get<std::string>() + "; ";
      for (const json& block : section["blocks"])
        out += block.value("title", block["kind"].get<std::string>()) + "; ";
    }
    return out;
  };
  EXPECT_EQ(titles(look("reference = false\nstep = 0.1\n")),
            "Verdict; verdict; Notes; text; All cells; All cells that were run; Record; record; ");
  // A page of 100 000 cells would take 400 MB: the table has the first ones.
  std::string list = "0";
  for (int i = 1; i <= 2000; ++i) list += ", " + std::to_string(i * 4e-4);
  EXPECT_THAT(titles(look("reference = false\nstep = 0.5\ns = [" + list + "]\n")),
              HasSubstr("The first 2000 of 4002 cells that were run"));
  const std::string one = titles(look("step = 0.1\n"));
  EXPECT_THAT(one, HasSubstr("What the cells are compared with"));
  EXPECT_THAT(one, Not(HasSubstr("Measured orders")));
  EXPECT_THAT(one, Not(HasSubstr("Heat maps")));
  const std::string many = titles(look("step = [0.1, 0.05, 0.025]\n"));
  EXPECT_THAT(many, HasSubstr("Measured orders"));
  // Figures before tables: a phone has the first one below the verdict.
  EXPECT_THAT(many, HasSubstr("Verdict; verdict; "));
  EXPECT_LT(many.find("Work and precision; "), many.find("What the cells are compared with"));
  EXPECT_THAT(many, HasSubstr("Heat maps; Error: one"));
}

// The names of a figure's curves.
std::vector<std::string> names(const json& figure) {
  std::vector<std::string> out;
  for (const json& series : figure["series"]) out.push_back(series["name"]);
  return out;
}

class Comparisons : public Pages {
 protected:
  void SetUp() override {
    Pages::SetUp();
    std::filesystem::create_directory(file("A"));
    std::filesystem::create_directory(file("B"));
    first_ = run({"run", "chaplygin_sleigh", "--quiet", "-o", "A/run.h5"});
    if (first_.err.find("HDF5") != std::string::npos) HAMEL_SKIP_WITHOUT("HDF5");
    ASSERT_EQ(first_.status, 0) << first_.err;
    if (page_of({"suslov"}).is_null()) HAMEL_SKIP_WITHOUT("page");
  }
  json compared(const std::vector<std::string>& arguments) const {
    EXPECT_EQ(run(arguments).status, 0);
    return page_by({"report", "A/run.h5", "B/run.h5", "-o", "page.html"});
  }

 private:
  hamel::test::Outcome first_;
};

// By their files where they do not differ.
TEST_F(Comparisons, RunsAreCalledByWhatDiffers) {
  const json alike = compared({"run", "chaplygin_sleigh", "--quiet", "-o", "B/run.h5"});
  EXPECT_THAT(names(figure_of(alike, "omega")), testing::ElementsAre("A/run", "B/run"));
  for (const auto& [file, step, offset] :
       {std::array<std::string, 3>{"1", "0.1", "0.2"}, {"2", "0.05", "0.2"}, {"3", "0.1", "0.3"}}) {
    ASSERT_EQ(run({"run", "chaplygin_sleigh", "--step", step, "--set", "offset=" + offset,
                   "--quiet", "-o", file + ".h5"})
                  .status,
              0);
  }
  const json page = page_by({"report", "1.h5", "2.h5", "3.h5", "1.h5", "-o", "page.html"});
  EXPECT_THAT(names(figure_of(page, "omega")),
              testing::ElementsAre("h = 0.1, offset = 0.2 (1)", "h = 0.05, offset = 0.2",
                                   "h = 0.1, offset = 0.3", "h = 0.1, offset = 0.2 (1 (2))"));
  EXPECT_EQ(page["sections"][0]["blocks"][0]["rows"][1][1], "2.h5");
}

TEST_F(Comparisons, MethodsOfOneSystem) {
  const json page =
      compared({"run", "chaplygin_sleigh", "--step", "0.001", "--quiet", "-o", "B/run.h5"});
  const json omega = figure_of(page, "omega"), residual = figure_of(page, "Constraint residual");
  EXPECT_THAT(names(omega), testing::ElementsAre("dop853", "lift"));
  EXPECT_EQ(omega["y"], "omega [rad/s]");
  EXPECT_EQ(figure_of(page, "theta")["y"], "theta [rad]");
  EXPECT_EQ(figure_of(page, "x")["y"], "x [m]");
  // As on the page of one run: of the constraint over the step, here the smaller one; of the group
  // alone.
  EXPECT_GT(residual["floor"], 1000 * figure_of(page, "Group defect")["floor"].get<double>());
  EXPECT_EQ(figure_of(page, "Group defect")["floor"], 2.2e-16);
  EXPECT_EQ(figure_of(page, "Energy error, or defect of the energy balance")["floor"], 2.2e-16);
  // Each curve has its own windows.
  EXPECT_THAT(residual["note"].get<std::string>(), HasSubstr("`dop853`: Each"));
  EXPECT_THAT(residual["note"].get<std::string>(), HasSubstr("`lift`: Each"));
}

// Curves of different meaning are never in one figure.
TEST_F(Comparisons, DifferentSystems) {
  const json page = compared({"run", "falling_disk", "--quiet", "-o", "B/run.h5"});
  EXPECT_EQ(page["subtitle"], "of chaplygin_sleigh, falling_disk");
  EXPECT_THAT(names(figure_of(page, "v1")),
              testing::ElementsAre("chaplygin_sleigh", "falling_disk"));
  EXPECT_EQ(figure_of(page, "v1")["y"], "v1 [m/s]");
  EXPECT_THAT(names(figure_of(page, "omega")), testing::ElementsAre("chaplygin_sleigh"));
  EXPECT_THAT(names(figure_of(page, "omega2")), testing::ElementsAre("falling_disk"));
}

}  // namespace
