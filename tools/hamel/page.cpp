#include "page.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <span>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel::tools {
namespace {

using Json = nlohmann::ordered_json;

// Six digits are more than a plot shows, and keep the page small.
constexpr int kDigits = 6, kTimeDigits = 15;

Json number(double value, int digits = kDigits) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
}

Json numbers(std::span<const double> values, int digits = kDigits) {
  Json out = Json::array();
  for (double v : values) out.push_back(number(v, digits));
  return out;
}

// More digits for a narrow range: a run from t = 10000 on has distinct times. Less than round-off
// shows.
int digits_of(std::span<const double> values) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    least = std::min(least, v);
    most = std::max(most, v);
  }
  if (!(least < most)) return kDigits;
  const double size = std::max(std::abs(least), std::abs(most));
  return kDigits + static_cast<int>(std::clamp(std::log10(size / (most - least)) + 1, 0.0, 6.0));
}

Json coordinates(std::span<const double> values) { return numbers(values, digits_of(values)); }

// A band too narrow to be seen beside the other curves is drawn as a curve: round-off, mostly.
Json curves(const std::vector<Series>& series, bool logarithmic = false) {
  constexpr double seen = 1e-3;
  const double range = range_of(series);
  Json out = Json::array();
  for (const Series& s : series) {
    const bool band = !s.low.empty() && (logarithmic || range_of({&s, 1}) > seen * range);
    Json& curve = out.emplace_back(Json{
        {"name", s.name}, {"x", coordinates(s.x)}, {"y", coordinates(s.y)}, {"dashed", s.dashed}});
    if (s.markers) curve["markers"] = true;
    if (s.dots) curve["dots"] = true;
    if (s.fit) curve["fit"] = {{"slope", number(s.fit->slope)}, {"text", s.fit->text}};
    if (!s.tags.empty()) curve["tags"] = s.tags;
    if (!s.key.empty()) curve["key"] = s.key;
    if (band) curve["low"] = coordinates(s.low);
    if (band && s.envelope) curve["envelope"] = true;
    if (!s.members.empty()) curve["members"] = s.members;
  }
  return out;
}

Json cells(const std::vector<Cell>& values) {
  Json out = Json::array();
  for (const Cell& cell : values) {
    if (!cell.is_number) out.push_back(cell.text);
    else if (std::isfinite(cell.number)) out.push_back(cell.number);
    else out.push_back(nullptr);
  }
  return out;
}

Json shape(const BodyShape& s) {
  Json out = {{"shape", s.kind}, {"color", s.look.color}};
  if (s.look.at != Look{}.at) out["at"] = numbers(s.look.at);
  if (s.look.axis != Look{}.axis) out["axis"] = numbers(s.look.axis);
  if (s.kind == "box") out["size"] = numbers(s.sizes);
  if (s.kind == "ellipsoid") out["radii"] = numbers(s.sizes);
  if (s.kind == "cylinder" || s.kind == "sphere") out["radius"] = number(s.sizes.at(0));
  if (s.kind == "cylinder") out["length"] = number(s.sizes.at(1));
  if (s.kind == "arrow") out["to"] = numbers(s.points.at(0));
  if (s.kind == "line") {
    for (const Point& point : s.points) out["points"].push_back(numbers(point));
  }
  return out;
}

Json moving(const MovingBody& body) {
  Json poses = Json::array(), parts = Json::array();
  for (const auto& [x, q] : body.poses)
    poses.push_back(numbers(std::array{x[0], x[1], x[2], q[0], q[1], q[2], q[3]}));
  for (const BodyShape& s : body.shapes) parts.push_back(shape(s));
  return {{"name", body.name},
          {"poses", poses},
          {"shapes", parts},
          {"trail", body.trail},
          {"trail_point", numbers(body.trail_point)}};
}

constexpr std::string_view kPlaceholder = "__HAMEL_DATA__";

// "Angular velocity" -> "angular-velocity".
std::string one_word(const std::string& title) {
  std::string out;
  for (const char c : title) {
    const bool kept = c < 0 || std::isalnum(c) != 0 || c == '.' || c == '_' || c == '\'';
    if (kept) out += static_cast<char>(c < 0 ? c : std::tolower(c));
    else if (!out.empty() && out.back() != '-') out += '-';
  }
  while (out.ends_with('-')) out.pop_back();
  return out;
}

// The page with this data in its place.
std::string filled(const Json& data) {
  const std::string_view page = report_page();
  const size_t at = page.find(kPlaceholder);
  if (at == std::string_view::npos) {
    throw ConfigError(
        {"report: this program was built without the page (node and npm were missing "
         "at build time); run tools/setup and build again"});
  }
  // No < of a text begins anything within <script>: neither its end nor a comment.
  std::string text;
  for (const char c : data.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') text += "\\u003c";
    else text += c;
  }
  return std::string(page.substr(0, at)) + text +
         std::string(page.substr(at + kPlaceholder.size()));
}

}  // namespace

struct Page::Data {
  Json page;
  size_t count = 0;                                     // of blocks
  std::vector<std::pair<std::string, size_t>> figures;  // names and numbers
  void add(Json block) {
    ++count;
    page["sections"].back()["blocks"].push_back(std::move(block));
  }
  void add_figure(const std::string& name, Json block) {
    const std::string word = one_word(name.empty() ? block["title"].get<std::string>() : name);
    const auto like = std::count_if(figures.begin(), figures.end(), [&](const auto& figure) {
      return figure.first == word || figure.first.starts_with(word + "-no");
    });
    add(std::move(block));
    figures.emplace_back(like == 0 ? word : fmt::format("{}-no{}", word, like + 1), count);
  }
};

Page::Page(std::string title, std::string subtitle) : data_(std::make_unique<Data>()) {
  const auto now = std::chrono::system_clock::now();
  data_->page = {{"title", std::move(title)},
                 {"subtitle", std::move(subtitle)},
                 {"generated", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}",
                                           fmt::gmtime(std::chrono::system_clock::to_time_t(now)))},
                 {"version", version()},
                 {"git", git_hash()},
                 {"host", host_name()},
                 {"sections", Json::array()}};
}
Page::~Page() = default;
Page::Page(Page&&) noexcept = default;

void Page::section(const std::string& title) {
  data_->page["sections"].push_back({{"title", title}, {"blocks", Json::array()}});
}
void Page::text(const std::vector<std::string>& paragraphs) {
  data_->add({{"kind", "text"}, {"paragraphs", paragraphs}});
}
void Page::verdict(const std::string& status, const std::string& text) {
  data_->add({{"kind", "verdict"}, {"status", status}, {"text", text}});
}
void Page::table(const std::string& title, const std::vector<std::string>& columns,
                 const std::vector<std::vector<Cell>>& rows, const std::string& note, bool filter) {
  Json lines = Json::array();
  for (const auto& row : std::span(rows).first(std::min(rows.size(), kMostRows)))
    lines.push_back(cells(row));
  std::string rest;
  if (rows.size() > kMostRows)
    rest =
        fmt::format("{}The first {} of {} rows.", note.empty() ? "" : " ", kMostRows, rows.size());
  data_->add({{"kind", "table"},
              {"title", title},
              {"columns", columns},
              {"rows", lines},
              {"filter", filter},
              {"note", note + rest}});
}
void Page::record(const std::string& json) {
  data_->add({{"kind", "record"}, {"record", Json::parse(json)}});
}
void Page::plot(const std::string& title, const Axes& axes, const std::vector<Series>& series,
                const std::string& note, const std::vector<Filter>& filters) {
  Json selectors = Json::array();
  for (const Filter& f : filters) selectors.push_back({{"name", f.name}, {"values", f.values}});
  Json block = {{"kind", "plot"},
                {"title", title},
                {"x", axes.x},
                {"y", axes.y},
                {"log_x", axes.log_x},
                {"log_y", axes.log_y},
                {"series", curves(series, axes.log_y)},
                {"filters", selectors},
                {"note", note}};
  if (axes.floor > 0) block["floor"] = number(axes.floor);
  if (!axes.slopes.empty()) block["slopes"] = axes.slopes;
  for (const Mark& mark : axes.marks)
    block["marks"].push_back({{"x", number(mark.x, kTimeDigits)}, {"text", mark.text}});
  for (const Band& band : axes.bands) {
    block["bands"].push_back({{"from", number(band.from, kTimeDigits)},
                              {"to", number(band.to, kTimeDigits)},
                              {"text", band.text}});
  }
  data_->add_figure(axes.name, std::move(block));
}
void Page::path(const std::string& title, const Axes& axes, const std::vector<Series>& series) {
  data_->add_figure(axes.name, {{"kind", "path"},
                                {"title", title},
                                {"x", axes.x},
                                {"y", axes.y},
                                {"series", curves(series)}});
}
void Page::sphere(const std::string& title, const std::vector<SphereCurve>& series,
                  const std::string& note) {
  Json out = Json::array();
  for (const SphereCurve& s : series) {
    Json points = Json::array();
    for (const auto& point : s.points) points.push_back(numbers(point));
    out.push_back({{"name", s.name}, {"points", points}});
  }
  data_->add_figure("axes",
                    {{"kind", "sphere"}, {"title", title}, {"series", out}, {"note", note}});
}

void Page::heatmap(const HeatMap& map) {
  Json rows = Json::array();
  for (const auto& row : map.values) rows.push_back(numbers(row));
  Json block = {{"kind", "heatmap"},
                {"title", map.title},
                {"x", map.x},
                {"y", map.y},
                {"x_values", cells(map.x_values)},
                {"y_values", cells(map.y_values)},
                {"values", rows},
                {"log", map.log},
                {"unit", map.unit},
                {"note", map.note}};
  if (!map.marks.empty()) block["marks"] = map.marks;
  if (!map.members.empty()) block["members"] = map.members;
  if (!map.classes.empty()) block["classes"] = map.classes;
  data_->add_figure("", std::move(block));
}
void Page::scatter(const ScatterMatrix& matrix) {
  Json block = {{"kind", "scatter"}, {"title", matrix.title}, {"columns", Json::array()}};
  for (const ScatterMatrix::Column& c : matrix.columns) {
    Json& column = block["columns"].emplace_back(
        Json{{"name", c.name}, {"unit", c.unit}, {"values", coordinates(c.values)}});
    if (!c.correlation.empty()) column["correlation"] = numbers(c.correlation);
  }
  block["members"] = matrix.members;
  if (!matrix.classes.empty()) {
    block["classes"] = matrix.classes;
    block["class"] = matrix.class_of;
  }
  block["note"] = matrix.note;
  data_->add_figure("scatter-matrix", std::move(block));
}
void Page::members(const Members& members) {
  Json block = {{"kind", "members"},
                {"paragraphs", members.paragraphs},
                {"command", members.command},
                {"count", members.count}};
  if (!members.index.empty()) block["index"] = members.index;
  block["columns"] = Json::array();
  for (const Members::Column& c : members.columns) {
    Json& column = block["columns"].emplace_back(Json{{"name", c.name},
                                                      {"unit", c.unit},
                                                      {"varied", c.varied},
                                                      {"values", coordinates(c.values)}});
    if (!c.names.empty()) column["names"] = c.names;
  }
  for (const auto& [member, reason] : members.failures)
    block["failures"][std::to_string(member)] = reason;
  for (const auto& [member, page] : members.motions)
    block["motions"][std::to_string(member)] = page->data_->page["sections"][0]["blocks"];
  data_->add(std::move(block));
}
void Page::animation(const Animation& animation) {
  Json bodies = Json::array();
  for (const MovingBody& body : animation.bodies) bodies.push_back(moving(body));
  Json block = {{"kind", "animation"},
                {"title", animation.title},
                {"view", animation.from_above ? "top" : "3d"},
                {"times", numbers(animation.times, kTimeDigits)},
                {"floor", animation.floor},
                {"bodies", bodies},
                {"note", animation.note}};
  for (const MovingForce& force : animation.forces) {
    Json values = Json::array();
    for (const auto& value : force.values) values.push_back(numbers(value));
    block["forces"].push_back({{"name", force.name}, {"values", values}});
  }
  data_->add_figure("motion", std::move(block));
}

void Page::write(const std::string& path) const { write_file(path, filled(data_->page)); }

std::vector<std::string> Page::figures() const {
  std::vector<std::string> out;
  for (const auto& [name, number] : data_->figures) out.push_back(name);
  return out;
}

std::string Page::picture(const std::string& figure, double width) const {
  const auto at = std::find_if(data_->figures.begin(), data_->figures.end(),
                               [&](const auto& known) { return known.first == figure; });
  Json data = data_->page;
  data["picture"] = {{"block", at->second}, {"width", width}};
  return filled(data);
}

}  // namespace hamel::tools
