#include "page.hpp"

#include <algorithm>
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

// As many digits of their range: a run from t = 10000 on has times of its own. Less than round-off
// shows.
int digits_of(std::span<const double> values) {
  double least = INFINITY, most = -INFINITY;
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

Json curves(const std::vector<Series>& series) {
  Json out = Json::array();
  for (const Series& s : series) {
    Json& curve = out.emplace_back(Json{
        {"name", s.name}, {"x", coordinates(s.x)}, {"y", coordinates(s.y)}, {"dashed", s.dashed}});
    if (s.markers) curve["markers"] = true;
    if (s.dots) curve["dots"] = true;
    if (s.fit) curve["fit"] = {{"slope", number(s.fit->slope)}, {"text", s.fit->text}};
    if (!s.tags.empty()) curve["tags"] = s.tags;
    if (!s.key.empty()) curve["key"] = s.key;
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

}  // namespace

struct Page::Data {
  Json page;
  Json& blocks() { return page["sections"].back()["blocks"]; }
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
  data_->blocks().push_back({{"kind", "text"}, {"paragraphs", paragraphs}});
}
void Page::verdict(const std::string& status, const std::string& text) {
  data_->blocks().push_back({{"kind", "verdict"}, {"status", status}, {"text", text}});
}
void Page::table(const std::string& title, const std::vector<std::string>& columns,
                 const std::vector<std::vector<Cell>>& rows, const std::string& note, bool filter) {
  Json lines = Json::array();
  for (const auto& row : rows) lines.push_back(cells(row));
  data_->blocks().push_back({{"kind", "table"},
                             {"title", title},
                             {"columns", columns},
                             {"rows", lines},
                             {"filter", filter},
                             {"note", note}});
}
void Page::record(const std::string& json) {
  data_->blocks().push_back({{"kind", "record"}, {"record", Json::parse(json)}});
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
                {"series", curves(series)},
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
  data_->blocks().push_back(std::move(block));
}
void Page::path(const std::string& title, const Axes& axes, const std::vector<Series>& series) {
  data_->blocks().push_back({{"kind", "path"},
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
  data_->blocks().push_back(
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
  data_->blocks().push_back(block);
}
void Page::animation(const Animation& animation) {
  Json bodies = Json::array();
  for (const MovingBody& body : animation.bodies) bodies.push_back(moving(body));
  data_->blocks().push_back({{"kind", "animation"},
                             {"title", animation.title},
                             {"view", animation.from_above ? "top" : "3d"},
                             {"times", numbers(animation.times, kTimeDigits)},
                             {"floor", animation.floor},
                             {"bodies", bodies},
                             {"note", animation.note}});
  for (const MovingForce& force : animation.forces) {
    Json values = Json::array();
    for (const auto& value : force.values) values.push_back(numbers(value));
    data_->blocks().back()["forces"].push_back({{"name", force.name}, {"values", values}});
  }
}

void Page::write(const std::string& path) const {
  const std::string_view page = report_page();
  const size_t at = page.find(kPlaceholder);
  if (at == std::string_view::npos) {
    throw ConfigError(
        {"report: this program was built without the page (node and npm were missing "
         "at build time); run tools/setup and build again"});
  }
  // No < of a text begins anything within <script>: neither its end nor a comment.
  std::string data;
  for (const char c : data_->page.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') data += "\\u003c";
    else data += c;
  }
  write_file(path, std::string(page.substr(0, at)) + data +
                       std::string(page.substr(at + kPlaceholder.size())));
}

Series thinned(std::string name, const std::vector<double>& x, const std::vector<double>& y,
               bool peaks, size_t points) {
  Series out{std::move(name), {}, {}};
  const auto add = [&](size_t i) {
    out.x.push_back(x[i]);
    out.y.push_back(y[i]);
  };
  const size_t count = y.size(), buckets = std::max<size_t>(points / 2, 1);
  if (count <= points) return {out.name, x, y};
  const auto less = [&](size_t a, size_t b) {  // NaN first, so that it is never hidden
    return std::isnan(y[a]) ? !std::isnan(y[b]) : y[a] < y[b];
  };
  for (size_t b = 0; b < buckets; ++b) {
    const size_t begin = b * count / buckets, end = (b + 1) * count / buckets;
    size_t low = begin, high = begin;
    for (size_t i = begin; i < end; ++i) {
      if (less(i, low)) low = i;
      if (less(high, i)) high = i;
    }
    if (peaks && !std::isnan(y[low])) low = high;
    if (low > high) std::swap(low, high);
    if (!peaks && b == 0 && low > 0) add(0);
    add(low);
    if (low != high) add(high);
    if (!peaks && b + 1 == buckets && high + 1 < count) add(count - 1);
  }
  return out;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

std::vector<double> magnitudes(std::vector<double> y) {
  for (double& v : y) v = std::abs(v);
  return y;
}

}  // namespace hamel::tools
