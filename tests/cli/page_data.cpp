// The data of a report page, as tools/report/README.md describes them. The page here is its
// placeholder alone, so that what is written is the JSON.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <nlohmann/json.hpp>

#include <hamel/framework/figures/curves.hpp>
#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/pages/page.hpp>

namespace hamel::pages {
std::string_view report_page() { return "__HAMEL_DATA__"; }
}  // namespace hamel::pages

namespace {

using namespace hamel;
using namespace hamel::figures;
using hamel::pages::Page;
using Json = nlohmann::json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The one block that `fill` puts on a page.
Json block(const std::function<void(Page&)>& fill) {
  Page page("title", "subtitle");
  page.section("one");
  fill(page);
  const auto path = std::filesystem::path(testing::TempDir()) / "hamel_page_data.json";
  page.write(path.string());
  std::ifstream file(path);
  const Json data = Json::parse(file);
  std::filesystem::remove(path);
  EXPECT_EQ(data["sections"].size(), 1);
  EXPECT_EQ(data["sections"][0]["blocks"].size(), 1);
  return data["sections"][0]["blocks"][0];
}

TEST(PageData, HeatMap) {
  const Json b = block([](Page& page) {
    page.add({.title = "Errors",
              .drawing = HeatMap{.x = {"system"},
                                 .y = {"step"},
                                 .x_values = {"suslov", "sleigh"},
                                 .y_values = {0.1, 0.05, 0.025},
                                 .values = {{1, 2}, {3, kNaN}, {1e-15, 6}},
                                 .marks = {{"", ""}, {"", "failed"}, {"", ""}},
                                 .log = true,
                                 .unit = "m"}});
  });
  EXPECT_EQ(b, Json::parse(R"({"kind": "heatmap", "title": "Errors", "x": "system", "y": "step",
      "x_values": ["suslov", "sleigh"], "y_values": [0.1, 0.05, 0.025], "log": true, "unit": "m", "note": "",
      "values": [[1.0, 2.0], [3.0, null], [1e-15, 6.0]], "marks": [["", ""], ["", "failed"], ["", ""]]})"));
}

TEST(PageData, PlotWithFitsMarkersAndFilters) {
  const Json b = block([](Page& page) {
    const Curve first{.name = "lift",
                      .x = {0.1, 0.2},
                      .y = {1, 2},
                      .markers = true,
                      .fit = figures::Fit{2.0004, "order 2.00"},
                      .tags = {{"system", "suslov"}}};
    page.add({.title = "Order",
              .drawing = Plot{.x = {"h", "", true},
                              .y = {"error", "", true},
                              .curves = {first, {"h squared", "", {0.1, 0.2}, {1, 4}}},
                              .filters = {{"system", {"suslov", "sleigh"}}}},
              .note = "note"});
  });
  EXPECT_EQ(b["filters"], Json::parse(R"([{"name": "system", "values": ["suslov", "sleigh"]}])"));
  EXPECT_EQ(b["series"][0],
            Json::parse(R"({"name": "lift", "x": [0.1, 0.2], "y": [1.0, 2.0], "dashed": false,
      "markers": true, "fit": {"slope": 2.0004, "text": "order 2.00"}, "tags": {"system": "suslov"}})"));
  EXPECT_EQ(
      b["series"][1],
      Json::parse(R"({"name": "h squared", "x": [0.1, 0.2], "y": [1.0, 4.0], "dashed": false})"));
  EXPECT_EQ(b["log_y"], true);
}

TEST(PageData, Dots) {
  const Json b = block([](Page& page) {
    const Curve dots{
        .name = "force", .unit = "N", .x = {1, 1}, .y = {0, 1}, .note = "contact", .dots = true};
    page.add({.title = "Branches",
              .drawing = Plot{.x = {"speed", "m/s"}, .y = {"count"}, .curves = {dots}}});
  });
  EXPECT_EQ(b["series"][0]["dots"], true);
  EXPECT_EQ(b["series"][0]["name"], "force [N], contact");
  EXPECT_EQ(b["x"], "speed [m/s]");
  EXPECT_EQ(b["y"], "count");
}

TEST(PageData, PlotWithFloorSlopesAndMarks) {
  const Json b = block([](Page& page) {
    page.add(
        {.title = "Velocity",
         .drawing = Plot{.x = {"t"},
                         .y = {"", "rad/s"},
                         .curves = {{.name = "omega", .x = {0, 1}, .y = {1, 2}, .key = "omega"}},
                         .floor = 2.2e-16,
                         .slopes = {1, 2},
                         .marks = {{0.5, "stop"}}}});
  });
  EXPECT_EQ(b["y"], "[rad/s]");
  EXPECT_EQ(b["floor"], 2.2e-16);
  EXPECT_EQ(b["slopes"], Json::parse("[1, 2]"));
  EXPECT_EQ(b["marks"], Json::parse(R"([{"x": 0.5, "text": "stop"}])"));
  EXPECT_EQ(b["series"][0]["key"], "omega");
}

// Of each window the largest, and the last window like the others: a small last value is no fall of
// the curve.
TEST(PageData, MaximaOverWindows) {
  std::vector<double> x, y;
  for (int i = 0; i < 1000; ++i) {
    x.push_back(i);
    y.push_back(i % 10 == 9 ? 1e-20 : 1);
  }
  const Curve s = thinned("error", x, y, true, 100);
  EXPECT_EQ(s.y, std::vector<double>(50, 1.0));
}

// A curve begins and ends where its run does, also where it is flat there.
TEST(PageData, CurvesKeepTheirEnds) {
  std::vector<double> x, y(1000, 0.5);
  for (int i = 0; i < 1000; ++i) x.push_back(i);
  y[500] = 1;
  const Curve s = thinned("angle", x, y, false, 100);
  EXPECT_EQ(s.x.front(), 0);
  EXPECT_EQ(s.x.back(), 999);
  EXPECT_EQ(*std::max_element(s.y.begin(), s.y.end()), 1);
  EXPECT_LE(s.x.size(), 102u);
  EXPECT_TRUE(std::is_sorted(s.x.begin(), s.x.end()));
}

TEST(PageData, TableWithFilter) {
  const Json b = block([](Page& page) {
    page.table("Runs", {"name", "error"}, {{"lift", 1.5}, {"boxed", kNaN}}, "note", true);
  });
  EXPECT_EQ(b, Json::parse(R"({"kind": "table", "title": "Runs", "columns": ["name", "error"],
      "rows": [["lift", 1.5], ["boxed", null]], "filter": true, "note": "note"})"));
}

TEST(PageData, Animation) {
  const Json b = block([](Page& page) {
    MovingBody disk;
    disk.name = "disk";
    disk.poses = {{{1, 2, 3}, {1, 0, 0, 0}}, {{1, 2, 4}, {0, 0.6, 0.8, 0}}};
    disk.shapes = {
        shapes::cylinder(0.5, 0.1, {.at = {0, 0, 1}, .axis = {0, 1, 0}, .color = "accent"}),
        shapes::box({1, 2, 3}),
        shapes::sphere(2, {.color = "#123456"}),
        shapes::ellipsoid({3, 2, 1}),
        shapes::line({{0, 0, 0}, {1, 0, 0}}),
        shapes::arrow({0, 0, 2}),
    };
    disk.trail = true;
    disk.trail_point = {0, 0, -1};
    page.add({.title = "Rolling",
              .drawing = Animation{.times = {0, 0.5}, .bodies = {disk}, .floor = true}});
  });
  const Json& body = b["bodies"][0];
  EXPECT_EQ(body["poses"], Json::parse("[[1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0],"
                                       " [1.0, 2.0, 4.0, 0.0, 0.6, 0.8, 0.0]]"));
  EXPECT_EQ(body["shapes"], Json::parse(R"([
      {"shape": "cylinder", "color": "accent", "at": [0.0, 0.0, 1.0], "axis": [0.0, 1.0, 0.0], "radius": 0.5, "length": 0.1},
      {"shape": "box", "color": "body", "size": [1.0, 2.0, 3.0]},
      {"shape": "sphere", "color": "#123456", "radius": 2.0},
      {"shape": "ellipsoid", "color": "body", "radii": [3.0, 2.0, 1.0]},
      {"shape": "line", "color": "body", "points": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]},
      {"shape": "arrow", "color": "body", "to": [0.0, 0.0, 2.0]}])"));
  EXPECT_EQ(body["trail"], true);
  EXPECT_EQ(body["trail_point"], Json::parse("[0.0, 0.0, -1.0]"));
  EXPECT_EQ(b["view"], "3d");
  EXPECT_EQ(b["floor"], true);
  EXPECT_EQ(b["times"], Json::parse("[0.0, 0.5]"));
}

// What oscillates more often than a figure can show is a band from its least to its greatest
// values; round-off on a curve is no oscillation, and few swings are drawn as they are.
TEST(PageData, ManyOscillationsAreABand) {
  std::vector<double> x, fast, slow, noisy;
  for (int i = 0; i <= 20000; ++i) {
    const double t = i * 1e-3;
    x.push_back(t);
    fast.push_back((1 + 0.1 * t) * std::sin(250 * t));
    slow.push_back(std::sin(10 * t));
    noisy.push_back(t + 1e-3 * (i % 2));
  }
  const Curve band = drawable("fast", x, fast);
  ASSERT_EQ(band.low.size(), band.y.size());
  EXPECT_EQ(band.x.front(), 0);
  EXPECT_EQ(band.x.back(), 20);
  for (size_t i = 1; i < band.x.size(); ++i) {
    ASSERT_LT(band.x[i - 1], band.x[i]);
    EXPECT_NEAR(band.y[i], 1 + 0.1 * band.x[i], 0.02);
    EXPECT_NEAR(band.low[i], -1 - 0.1 * band.x[i], 0.02);
  }
  EXPECT_TRUE(drawable("slow", x, slow).low.empty());
  EXPECT_TRUE(drawable("noisy", x, noisy).low.empty());
  const auto drawn = [](std::vector<Curve> curves) {
    return block([&](Page& page) {
      page.add(
          {.title = "Band", .drawing = Plot{.x = {"t"}, .y = {"x"}, .curves = std::move(curves)}});
    });
  };
  const Json b = drawn({band});
  EXPECT_EQ(b["series"][0]["low"].size(), band.y.size());
  EXPECT_TRUE(b["series"][0].value("envelope", false));
  // Round-off beside a velocity is no band.
  Curve narrow = band, still{.name = "v", .x = {0, 20}, .y = {4, 4}};
  for (std::vector<double>* values : {&narrow.y, &narrow.low})
    for (double& v : *values) v *= 1e-17;
  const Json beside = drawn({still, narrow});
  EXPECT_FALSE(beside["series"][1].contains("low"));
}

// Further figures of one name get a number, and no name has a space.
TEST(PageData, NamesOfFigures) {
  std::vector<Figure> all = {{.title = "Inputs", .drawing = Plot{}},
                             {.title = "Inputs", .drawing = Plot{}},
                             {.title = "Angular velocity", .drawing = Plot{}},
                             {.title = "Energy error", .drawing = Plot{}, .name = "energy-error"}};
  name_apart(all);
  EXPECT_EQ(all[0].name, "inputs");
  EXPECT_EQ(all[1].name, "inputs-no2");
  EXPECT_EQ(all[2].name, "angular-velocity");
  const Json json = Json::parse(to_json(all));
  EXPECT_EQ(json.size(), 4u);
  EXPECT_EQ(json["energy-error"]["title"], "Energy error");
}

}  // namespace
