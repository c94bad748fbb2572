#include "study_page.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "study_view.hpp"

namespace hamel::tools {
namespace {

constexpr size_t kMostNames = 12;  // curves that can be told apart in one figure

class StudyPage {
 public:
  explicit StudyPage(const StudyResult& result)
      : result_(result),
        view_(result),
        page_(result.config.title,
              fmt::format("{} cells to t = {} s; times are medians of {} rounds on {} thread{}",
                          view_.run().size(), result.config.until, result.config.repeats,
                          result.threads, result.threads == 1 ? "" : "s")) {
    divide_axes();
  }

  Page make() {
    page_.section("Verdict");
    for (const Verdict& verdict : study_verdicts(result_))
      page_.verdict(verdict.status, verdict.text);
    references();
    diagrams();
    heat_maps();
    cells();
    skipped();
    page_.section("Record");
    page_.record(result_.record());
    return std::move(page_);
  }

 private:
  // Axes go into the names of the curves while these stay few; the others become filters over the figures.
  void divide_axes() {
    filters_ =
        view_.varies("system") ? std::vector<std::string>{"system"} : std::vector<std::string>{};
    for (const char* axis :
         {"solver", "scheme", "s", "retraction", "compose", "on_failure", "tolerance"}) {
      if (!view_.varies(axis)) continue;
      std::vector<std::string> longer = names_;
      longer.emplace_back(axis);
      if (names_.empty() || view_.groups(longer).size() <= kMostNames) names_ = longer;
      else filters_.emplace_back(axis);
    }
    if (names_.empty()) names_.emplace_back("scheme");
  }

  std::vector<Filter> page_filters(const std::vector<std::string>& axes) const {
    std::vector<Filter> out;
    for (const std::string& axis : axes) {
      Filter filter{axis, {}};
      for (const std::string& value : view_.values(axis))
        if (!value.empty())
          filter.values.push_back(value);  // "": an s that is not used fits every s
      out.push_back(std::move(filter));
    }
    return out;
  }

  void references() {
    std::vector<std::vector<Cell>> rows;
    for (size_t i = 0; i < result_.references.size(); ++i) {
      const StudyReference& reference = result_.references[i];
      if (reference.times.empty()) continue;
      rows.push_back({result_.config.systems[i].label, reference.kind, reference.bound,
                      reference.extent, static_cast<double>(reference.times.size())});
    }
    page_.table(
        "What the cells are compared with",
        {"system", "reference", "bound of its error", "extent of the motion", "times"}, rows,
        "An error is the largest Euclidean distance of the element's columns at these times, "
        "which every step reaches.");
  }

  // One curve for each method, by a number of each cell.
  template <class X>
  std::vector<Series> curves(X x, bool with_fit) const {
    std::vector<std::string> axes = names_;
    axes.insert(axes.end(), filters_.begin(), filters_.end());
    std::vector<Series> out;
    for (const auto& [key, cells] : view_.groups(axes)) {
      Series series{view_.words(cells.front(), names_), {}, {}};
      series.markers = true;
      for (size_t k = 0; k < filters_.size(); ++k)
        if (const std::string& value = key[names_.size() + k]; !value.empty())
          series.tags[filters_[k]] = value;
      std::vector<size_t> good;
      for (const size_t i : cells)
        if (view_.metrics(i).ok && std::isfinite(x(i))) good.push_back(i);
      std::sort(good.begin(), good.end(), [&](size_t a, size_t b) { return x(a) < x(b); });
      for (const size_t i : good) {
        series.x.push_back(x(i));
        series.y.push_back(view_.metrics(i).error);
      }
      if (series.x.empty()) continue;
      const StudyMetrics& m = view_.metrics(cells.front());
      if (with_fit && std::isfinite(m.order)) {
        series.fit =
            Fit{m.order, fmt::format("{:.2f} ({} of {})", m.order, m.order_points, m.order_of)};
      }
      out.push_back(std::move(series));
    }
    return out;
  }

  void diagrams() {
    const size_t failed = static_cast<size_t>(std::count_if(
        view_.run().begin(), view_.run().end(), [&](size_t i) { return !view_.metrics(i).ok; }));
    const std::string missing =
        failed == 0 ? ""
                    : fmt::format(" {} failed cell{} no point here: see the heat maps.", failed,
                                  failed == 1 ? " has" : "s have");
    const std::vector<Filter> filters = page_filters(filters_);
    page_.section("Work and precision");
    page_.plot(
        "Error against time",
        {.x = "time of the run [s]", .y = "trajectory error", .log_x = true, .log_y = true},
        curves([&](size_t i) { return view_.seconds(i); }, false),
        "Steps times the median processor time per step, nothing recorded. Lower left is better." +
            missing,
        filters);
    page_.plot(
        "Error against evaluations",
        {.x = "evaluations of the equation", .y = "trajectory error", .log_x = true, .log_y = true},
        curves([&](size_t i) { return static_cast<double>(view_.metrics(i).evaluations); }, false),
        "Does not depend on the machine. What an evaluation costs differs between schemes." +
            missing,
        filters);
    page_.section("Orders");
    page_.plot(
        "Error against step",
        {.x = "step h [s]", .y = "trajectory error", .log_x = true, .log_y = true},
        curves([&](size_t i) { return view_.cell(i).config.step; }, true),
        "In the legend the slope by least squares, and of how many steps: those whose error is "
        "above the floor and below 0.1 of the motion." +
            missing,
        filters);
    order_table();
  }

  void order_table() {
    std::vector<std::string> axes = study_axes();
    axes.pop_back();  // the step
    std::vector<std::string> columns = view_.varying_without({"step"});
    const std::vector<std::string> shown = columns;
    for (const char* more :
         {"order", "finest", "claimed", "verdict", "points", "of", "least error"})
      columns.emplace_back(more);
    std::vector<std::vector<Cell>> rows;
    for (const auto& [key, cells] : view_.groups(axes)) {
      const StudyMetrics& m = view_.metrics(cells.front());
      const int claim = view_.cell(cells.front()).claimed_order;
      double least = kNotMeasured;
      for (const size_t i : cells)
        if (view_.metrics(i).ok) least = std::fmin(least, view_.metrics(i).error);
      std::vector<Cell> row;
      for (const std::string& axis : shown)
        row.emplace_back(view_.cell(cells.front()).axes.at(axis));
      const char* verdict = claim == 0                       ? "claims none"
                            : std::isnan(m.order)            ? "not measured"
                            : m.order >= claim - 0.25        ? "ok"
                            : m.order_finest >= claim - 0.25 ? "finest only"
                                                             : "below its claim";
      for (const Cell& cell : std::vector<Cell>{m.order, m.order_finest, static_cast<double>(claim),
                                                verdict, static_cast<double>(m.order_points),
                                                static_cast<double>(m.order_of), least})
        row.push_back(cell);
      rows.push_back(std::move(row));
    }
    page_.table("Measured orders", columns, rows, "", true);
  }

  void heat_maps() {
    page_.section("Heat maps");
    std::vector<std::string> rows = names_, panels = filters_;
    if (view_.varies("s") && std::find(rows.begin(), rows.end(), "s") == rows.end()) {
      rows.emplace_back("s");
      std::erase(panels, "s");
    }
    for (const auto& [key, cells] : view_.groups(panels)) {
      const std::string title = view_.words(panels, key);
      heat_map("Error" + (title.empty() ? "" : ": " + title), "trajectory error", rows, panels, key,
               [&](size_t i) { return view_.metrics(i).error; });
      if (view_.varies("solver"))
        heat_map("Evaluations" + (title.empty() ? "" : ": " + title), "evaluations per step", rows,
                 panels, key, [&](size_t i) {
                   const StudyMetrics& m = view_.metrics(i);
                   return static_cast<double>(m.evaluations) /
                          static_cast<double>(std::max(m.steps, 1L));
                 });
      else
        heat_map("Energy error" + (title.empty() ? "" : ": " + title), "largest |E - E0| / |E0|",
                 rows, panels, key, [&](size_t i) { return view_.metrics(i).energy_error; });
    }
  }

  template <class Value>
  void heat_map(const std::string& title, const std::string& unit,
                const std::vector<std::string>& rows, const std::vector<std::string>& panels,
                const std::vector<std::string>& key, Value value) {
    HeatMap map;
    map.title = title;
    map.unit = unit;
    map.log = true;
    map.x = "step h [s]";
    map.y = "";
    const std::vector<std::string> steps = view_.values("step");
    for (const std::string& h : steps) map.x_values.emplace_back(std::stod(h));
    std::vector<std::string> names;
    for (size_t i = 0; i < result_.cells.size(); ++i) {
      const StudyCell& cell = result_.cells[i];
      bool here = true;
      for (size_t k = 0; k < panels.size(); ++k) here = here && cell.axes.at(panels[k]) == key[k];
      if (!here || cell.skipped == "duplicate") continue;
      const std::string name = view_.words(i, rows);
      size_t row = static_cast<size_t>(std::find(names.begin(), names.end(), name) - names.begin());
      if (row == names.size()) {
        names.push_back(name);
        map.y_values.emplace_back(name);
        map.values.emplace_back(steps.size(), kNotMeasured);
        map.marks.emplace_back(steps.size(), "");
      }
      const auto column = static_cast<size_t>(
          std::find(steps.begin(), steps.end(), cell.axes.at("step")) - steps.begin());
      if (column == steps.size()) continue;  // a step that no cell was run with
      if (!cell.runs()) map.marks[row][column] = cell.skipped == "excluded" ? "excluded" : "none";
      else if (!view_.metrics(i).ok) map.marks[row][column] = "failed";
      else map.values[row][column] = value(i);
    }
    page_.heatmap(map);
  }

  // Every cell that was run, without the columns that say the same in each row.
  void cells() {
    page_.section("All cells");
    const Table table = result_.table();
    std::vector<const TableColumn*> shown;
    std::vector<std::string> names;
    for (const TableColumn& column : table.columns) {
      const bool axis =
          std::find(study_axes().begin(), study_axes().end(), column.name) != study_axes().end();
      bool needed = axis ? view_.varies(column.name) : false;
      for (const size_t i : view_.run())
        needed = needed || (!axis && !column.text(i).empty() && column.text(i) != "0");
      if (!needed) continue;
      shown.push_back(&column);
      names.push_back(column.unit.empty() || column.unit == "1" ||
                              column.unit.starts_with("columns")
                          ? column.name
                          : fmt::format("{} [{}]", column.name, column.unit));
    }
    std::vector<std::vector<Cell>> rows;
    for (const size_t i : view_.run()) {
      std::vector<Cell> row;
      for (const TableColumn* column : shown) {
        const auto* numbers = std::get_if<std::vector<double>>(&column->values);
        const auto axis = view_.cell(i).axes.find(column->name);
        if (axis != view_.cell(i).axes.end()) row.emplace_back(axis->second);  // as it was given
        else if (numbers != nullptr) row.emplace_back((*numbers)[i]);
        else row.emplace_back(column->text(i));
      }
      rows.push_back(std::move(row));
    }
    page_.table(
        "All cells that were run", names, rows,
        "The same, and what is empty or equal in all rows, is in `cells.csv` and `cells.h5`.",
        true);
  }

  // One row for all steps of a kind.
  void skipped() {
    std::vector<std::vector<std::string>> kinds;
    std::vector<std::string> steps;
    for (const StudyCell& cell : result_.cells) {
      if (cell.runs()) continue;
      std::vector<std::string> row;
      for (const std::string& axis : study_axes())
        if (axis != "step") row.push_back(cell.axes.at(axis));
      row.push_back(cell.skipped);
      row.push_back(cell.why);
      const auto at =
          static_cast<size_t>(std::find(kinds.begin(), kinds.end(), row) - kinds.begin());
      if (at == kinds.size()) {
        kinds.push_back(row);
        steps.push_back(cell.axes.at("step"));
      } else {
        steps[at] += ", " + cell.axes.at("step");
      }
    }
    if (kinds.empty()) return;
    std::vector<std::string> columns = study_axes();
    columns.back() = "kind";
    columns.insert(columns.end(), {"why", "steps"});
    std::vector<std::vector<Cell>> rows;
    for (size_t i = 0; i < kinds.size(); ++i) {
      rows.emplace_back(kinds[i].begin(), kinds[i].end());
      rows.back().emplace_back(steps[i]);
    }
    page_.table("Combinations that were not run", columns, rows, "", true);
  }

  const StudyResult& result_;
  StudyView view_;
  Page page_;
  std::vector<std::string> names_, filters_;
};

}  // namespace

Page study_page(const StudyResult& result) { return StudyPage(result).make(); }

}  // namespace hamel::tools
