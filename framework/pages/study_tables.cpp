#include <hamel/framework/pages/study_tables.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include <fmt/format.h>

namespace hamel::pages {
namespace {

// A value as it was given.
Cell axis_cell(const std::string& value) { return value.empty() ? kUnused : value; }

}  // namespace

void add_references(Page& page, const StudyResult& result) {
  if (!result.config.reference) {
    page.text(
        {"This study measures times, not errors (`reference = false`): nothing is compared."});
    return;
  }
  std::vector<std::vector<Cell>> rows;
  for (size_t i = 0; i < result.references.size(); ++i) {
    const StudyReference& reference = result.references[i];
    if (reference.times.empty()) continue;
    rows.push_back({result.config.systems[i].label, reference.kind, reference.bound,
                    reference.extent, static_cast<double>(reference.times.size())});
  }
  page.table("What the cells are compared with",
             {"system", "reference", "bound of its error", "extent of the motion", "times"}, rows,
             "An error is the largest Euclidean distance of the element's columns at these times, "
             "which every step reaches.");
}

void add_orders(Page& page, const StudyView& view) {
  std::vector<std::string> axes = study_axes();
  std::erase_if(axes, [](const std::string& axis) { return axis == "step" || axis == "rtol"; });
  std::vector<std::string> columns = view.varying_without({"step", "rtol"});
  const std::vector<std::string> shown = columns;
  for (const char* more : {"order", "finest", "claimed", "verdict", "points", "of", "least error"})
    columns.emplace_back(more);
  std::vector<std::vector<Cell>> rows;
  bool measured = false;
  for (const auto& [key, cells] : view.groups(axes)) {
    const StudyMetrics& m = view.metrics(cells.front());
    measured = measured || std::isfinite(m.order);
    const int claim = view.cell(cells.front()).claimed_order;
    double least = kNotMeasured;
    for (const size_t i : cells)
      if (view.metrics(i).ok) least = std::fmin(least, view.metrics(i).error);
    std::vector<Cell> row;
    for (const std::string& axis : shown)
      row.push_back(axis_cell(view.cell(cells.front()).axes.at(axis)));
    for (const Cell& cell : std::vector<Cell>{
             m.order, m.order_finest, static_cast<double>(claim), view.order_verdict(cells),
             static_cast<double>(m.order_points), static_cast<double>(m.order_of), least})
      row.push_back(cell);
    rows.push_back(std::move(row));
  }
  if (!measured) {
    page.text(
        {"No order was measured: it takes two steps or tolerances whose errors are above the "
         "floor and small beside the motion."});
    return;
  }
  page.table("Measured orders", columns, rows, "", true);
}

void add_cells(Page& page, const StudyView& view) {
  page.section("All cells");
  const Table table = view.result().table();
  std::vector<const TableColumn*> shown;
  std::vector<std::string> names;
  for (const TableColumn& column : table.columns) {
    const bool axis =
        std::find(study_axes().begin(), study_axes().end(), column.name) != study_axes().end();
    bool needed = axis ? view.varies(column.name) : false;
    for (const size_t i : view.run())
      needed = needed || (!axis && !column.text(i).empty() && column.text(i) != "0");
    if (!needed) continue;
    shown.push_back(&column);
    names.push_back(column.unit.empty() || column.unit == "1" || column.unit.starts_with("columns")
                        ? column.name
                        : fmt::format("{} [{}]", column.name, column.unit));
  }
  std::vector<std::vector<Cell>> rows;
  const size_t count = view.run().size();
  for (const size_t i : std::span(view.run()).first(std::min(count, kMostRows))) {
    std::vector<Cell> row;
    for (const TableColumn* column : shown) {
      const auto* numbers = std::get_if<std::vector<double>>(&column->values);
      const StudyAxes& axes = view.cell(i).axes;
      if (axes.contains(column->name)) row.push_back(axis_cell(axes.at(column->name)));
      else if (numbers != nullptr) row.emplace_back((*numbers)[i]);
      else row.emplace_back(column->text(i));
    }
    rows.push_back(std::move(row));
  }
  page.table(count <= kMostRows
                 ? "All cells that were run"
                 : fmt::format("The first {} of {} cells that were run", kMostRows, count),
             names, rows,
             "All cells, with the columns that are empty or equal in all rows, are in `cells.csv` "
             "and `cells.h5`.",
             true);
}

void add_skipped(Page& page, const StudyResult& result) {
  std::map<std::vector<std::string>, size_t> index;
  std::vector<std::vector<std::string>> kinds;
  std::vector<std::string> steps;
  for (const StudyCell& cell : result.cells) {
    if (cell.runs()) continue;
    std::vector<std::string> row;
    for (const std::string& axis : study_axes())
      if (axis != "step") row.push_back(cell.axes.at(axis));
    row.push_back(cell.skipped);
    row.push_back(cell.why);
    const auto [at, added] = index.try_emplace(row, kinds.size());
    if (added) {
      kinds.push_back(row);
      steps.push_back(cell.axes.at("step"));
    } else {
      steps[at->second] += ", " + cell.axes.at("step");
    }
  }
  if (kinds.empty()) return;
  std::vector<std::string> columns = study_axes();
  std::erase(columns, "step");
  columns.insert(columns.end(), {"kind", "why", "steps"});
  std::vector<std::vector<Cell>> rows;
  for (size_t i = 0; i < kinds.size(); ++i) {
    rows.emplace_back(kinds[i].begin(), kinds[i].end());
    rows.back().emplace_back(steps[i]);
  }
  page.table("Combinations that were not run", columns, rows, "", true);
}

}  // namespace hamel::pages
