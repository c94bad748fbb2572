#include "page.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/errors.hpp>
#include <hamel/framework/result.hpp>
#include <hamel/framework/version.hpp>

namespace hamel::tools {
namespace {

using Json = nlohmann::ordered_json;

// Six digits are more than a plot shows, and keep the page small.
Json numbers(const std::vector<double>& values) {
  Json out = Json::array();
  for (double v : values) {
    if (std::isfinite(v)) out.push_back(std::strtod(fmt::format("{:.6g}", v).c_str(), nullptr));
    else out.push_back(nullptr);
  }
  return out;
}

Json curves(const std::vector<Series>& series) {
  Json out = Json::array();
  for (const Series& s : series) {
    out.push_back(
        {{"name", s.name}, {"x", numbers(s.x)}, {"y", numbers(s.y)}, {"dashed", s.dashed}});
  }
  return out;
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
                 const std::vector<std::vector<Cell>>& rows, const std::string& note) {
  Json cells = Json::array();
  for (const auto& row : rows) {
    Json line = Json::array();
    for (const Cell& cell : row) {
      if (!cell.is_number) line.push_back(cell.text);
      else if (std::isfinite(cell.number)) line.push_back(cell.number);
      else line.push_back(nullptr);
    }
    cells.push_back(line);
  }
  data_->blocks().push_back(
      {{"kind", "table"}, {"title", title}, {"columns", columns}, {"rows", cells}, {"note", note}});
}
void Page::record(const std::string& json) {
  data_->blocks().push_back({{"kind", "record"}, {"record", Json::parse(json)}});
}
void Page::plot(const std::string& title, const Axes& axes, const std::vector<Series>& series,
                const std::string& note) {
  data_->blocks().push_back({{"kind", "plot"},
                             {"title", title},
                             {"x", axes.x},
                             {"y", axes.y},
                             {"log_x", axes.log_x},
                             {"log_y", axes.log_y},
                             {"series", curves(series)},
                             {"note", note}});
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

void Page::write(const std::string& path) const {
  const std::string_view page = report_page();
  const size_t at = page.find(kPlaceholder);
  if (at == std::string_view::npos) {
    throw ConfigError(
        {"report: this program was built without the page (node and npm were missing "
         "at build time); run tools/setup and build again"});
  }
  std::string data = data_->page.dump();
  for (size_t i = 0; (i = data.find("</", i)) != std::string::npos; i += 3)
    data.replace(i, 2, "<\\/");
  write_file(path, std::string(page.substr(0, at)) + data +
                       std::string(page.substr(at + kPlaceholder.size())));
}

Series thinned(std::string name, const std::vector<double>& x, const std::vector<double>& y,
               bool peaks, size_t points) {
  Series out{std::move(name), {}, {}};
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
    for (size_t i : {std::min(low, high), std::max(low, high)}) {
      out.x.push_back(x[i]);
      out.y.push_back(y[i]);
      if (low == high) break;
    }
  }
  out.x.push_back(x.back());
  out.y.push_back(y.back());
  return out;
}

std::vector<double> magnitudes(std::vector<double> y) {
  for (double& v : y) v = std::abs(v);
  return y;
}

}  // namespace hamel::tools
