#include <hamel/framework/pages/page.hpp>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <span>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/figures/json.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel::pages {
namespace {

using figures::Json;

constexpr std::string_view kPlaceholder = "__HAMEL_DATA__";
constexpr const char* kWithoutPage =
    "this hamel was built without the page (HAMEL_REPORT_PAGE is OFF, or node and npm were missing "
    "at build time); run tools/setup and build again";

// The page with this data in its place.
std::string filled(const Json& data) {
  const std::string_view page = report_page();
  const size_t at = page.find(kPlaceholder);
  if (at == std::string_view::npos) throw ConfigError({std::string("report: ") + kWithoutPage});
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

std::vector<std::string> page_mistakes(const std::string& path,
                                       const std::vector<std::string>& formats) {
  std::vector<std::string> mistakes;
  const std::string extension = std::filesystem::path(path).extension();
  if (std::find(formats.begin(), formats.end(), extension) == formats.end())
    mistakes.push_back(unknown_name("output format", extension, formats) + " in '" + path + "'");
  else if (const std::string reason = unwritable(path); !reason.empty()) mistakes.push_back(reason);
  if (report_page().empty()) mistakes.emplace_back(kWithoutPage);
  return mistakes;
}

struct Page::Data {
  Json page;
  size_t count = 0;                                     // of blocks
  std::vector<std::pair<std::string, size_t>> figures;  // names and numbers
  void add(Json block) {
    ++count;
    page["sections"].back()["blocks"].push_back(std::move(block));
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
    lines.push_back(figures::cells(row));
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
void Page::add(const Figure& figure) {
  data_->add(figures::json_of(figure));
  data_->figures.emplace_back(figure.name, data_->count);
}
void Page::add(const std::vector<Figure>& figures, const std::string& section) {
  for (const Figure& figure : figures)
    if (figure.section == section) add(figure);
}
void Page::add_section(const std::vector<Figure>& figures, const std::string& title) {
  const bool any =
      std::ranges::any_of(figures, [&](const Figure& figure) { return figure.section == title; });
  if (any) section(title);
  add(figures, title);
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
                                                      {"values", figures::coordinates(c.values)}});
    if (!c.names.empty()) column["names"] = c.names;
  }
  for (const auto& [member, reason] : members.failures)
    block["failures"][std::to_string(member)] = reason;
  for (const auto& [member, page] : members.motions)
    block["motions"][std::to_string(member)] = page->data_->page["sections"][0]["blocks"];
  data_->add(std::move(block));
}
void Page::write(const std::string& path) const { write_file(path, filled(data_->page)); }

std::vector<std::string> Page::figures() const {
  std::vector<std::string> out;
  for (const auto& [name, number] : data_->figures) out.push_back(name);
  return out;
}

std::string Page::picture(const std::string& figure, const PictureOptions& options) const {
  const auto at = std::find_if(data_->figures.begin(), data_->figures.end(),
                               [&](const auto& known) { return known.first == figure; });
  Json data = data_->page;
  Json& picture = data["picture"];
  picture = {{"block", at->second}, {"width", options.width}};
  if (options.height > 0) picture["height"] = options.height;
  if (options.sharper > 0) picture["sharper"] = options.sharper;
  if (!options.at.empty()) picture["at"] = options.at;
  if (!options.strobe.empty()) picture["strobe"] = options.strobe;
  for (const auto& [name, set] : {std::pair("frames", options.frames),
                                  {"transparent", options.transparent},
                                  {"player", options.player}})
    if (set) picture[name] = true;
  return filled(data);
}

}  // namespace hamel::pages
