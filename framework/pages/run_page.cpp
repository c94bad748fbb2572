#include <hamel/framework/pages/run_page.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/pages/event_table.hpp>
#include <hamel/framework/pages/run_verdict.hpp>

namespace hamel::pages {
namespace {

using Json = nlohmann::ordered_json;

// A value of a record as a cell shows it.
Cell cell(const Json& value) {
  if (value.is_number()) return value.get<double>();
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// The list of objects `member` of the record as a table.
void add_list(Page& page, const Json& record, const char* member, const std::string& title) {
  if (!record.contains(member) || !record[member].is_array() || record[member].empty()) return;
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
  for (const Json& entry : record[member]) {
    if (!entry.is_object()) return;
    if (columns.empty())
      for (const auto& [key, value] : entry.items())
        if (value.is_primitive()) columns.push_back(key);
    rows.emplace_back();
    for (const std::string& key : columns)
      rows.back().push_back(entry.contains(key) ? cell(entry[key]) : Cell(""));
  }
  page.table(title, columns, rows);
}

}  // namespace

Page run_page(const Registry& registry, const Result& r, const std::string& record) {
  Page page(fmt::format("{}: {} with {}", r.system->name, r.config.scheme, r.config.retraction),
            fmt::format("{}: {}, {}", r.system->group.name, r.method(), r.steps_in_words()));
  const Json values = Json::parse(record);
  const std::vector<Figure> figures = figures::of_run(registry, r);

  page.section("Result");
  const RunVerdict verdict = run_verdict(r);
  page.verdict(verdict.status, verdict.text);
  if (!r.notes.empty()) page.text(r.notes);
  if (const size_t stride = r.trajectory.stride(); stride > 1)
    page.text({fmt::format("The figures show one recorded state in {}.", stride)});
  page.add(figures, "Motion");
  add_events(page, registry, r);
  add_list(page, values, "inputs", "Inputs");
  page.add_section(figures, "Velocity, shape and reactions");
  page.add_section(figures, "Accuracy");
  page.section("Record");
  page.record(record);
  return page;
}

}  // namespace hamel::pages
