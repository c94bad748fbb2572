#include "study_page.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "study_growth.hpp"
#include "study_tables.hpp"
#include "study_view.hpp"

namespace hamel::tools {
namespace {

constexpr size_t kMostNames = 12;    // curves that can be distinguished in one figure
constexpr size_t kMostCurves = 200;  // of one figure with all its filters; rows of a heat map

// Distance of the curves that are drawn, of so many.
size_t stride(size_t curves) { return (curves + kMostCurves - 1) / kMostCurves; }

std::string not_drawn(size_t curves, const char* what) {
  const size_t each = stride(curves);
  if (each <= 1) return "";
  return fmt::format(" {} of {} {}, at equal distances in the order of the file.",
                     (curves + each - 1) / each, curves, what);
}

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
    for (const Verdict& verdict : study_verdicts(result_)) {
      page_.verdict(verdict.status, verdict.text);
      if (!verdict.rows.empty())
        page_.table("By " + verdict.columns.front(), verdict.columns, verdict.rows);
    }
    add_references(page_, result_);
    diagrams();
    add_growth(page_, view_);
    heat_maps();
    add_cells(page_, view_);
    add_skipped(page_, result_);
    page_.section("Record");
    page_.record(result_.record());
    return std::move(page_);
  }

 private:
  // Axes go into the names of the curves up to kMostNames of these; the others become filters over
  // the figures.
  void divide_axes() {
    filters_ =
        view_.varies("system") ? std::vector<std::string>{"system"} : std::vector<std::string>{};
    std::vector<std::string> axes = {"solver", "scheme", "s"};
    for (const std::string& axis : study_axes())
      if (std::find(axes.begin(), axes.end(), axis) == axes.end()) axes.push_back(axis);
    for (const std::string& axis : axes) {
      if (!view_.varies(axis) || axis == "system" || axis == "step" || axis == "rtol") continue;
      std::vector<std::string> longer = names_;
      longer.emplace_back(axis);
      if (names_.empty() || view_.groups(longer).size() <= kMostNames) names_ = longer;
      else filters_.emplace_back(axis);
    }
    if (names_.empty()) names_.emplace_back("scheme");
  }

  std::vector<Filter> page_filters(const std::vector<std::string>& axes) const {
    std::vector<Filter> out;
    for (const std::string& axis : axes) out.push_back({axis, view_.values(axis)});
    return out;
  }

  // Note on the curves that `curves` leaves out.
  std::string left_out() const {
    std::vector<std::string> axes = names_;
    axes.insert(axes.end(), filters_.begin(), filters_.end());
    return not_drawn(view_.groups(axes).size(), "curves");
  }

  bool drawn(size_t i) const {
    return view_.metrics(i).ok && std::isfinite(view_.metrics(i).error);
  }

  // Curves, one for each method, by a number of each cell.
  template <class X>
  std::vector<Series> curves(X x, bool with_fit) const {
    std::vector<std::string> axes = names_;
    axes.insert(axes.end(), filters_.begin(), filters_.end());
    std::vector<Series> out;
    const std::vector<StudyView::Group> groups = view_.groups(axes);
    for (size_t curve = 0; curve < groups.size(); curve += stride(groups.size())) {
      const auto& [key, cells] = groups[curve];
      Series series{view_.words(cells.front(), names_), {}, {}};
      series.markers = true;
      for (size_t k = 0; k < filters_.size(); ++k)
        if (const std::string& value = key[names_.size() + k]; !value.empty())
          series.tags[filters_[k]] = value;  // no tag: it fits every value
      std::vector<size_t> good;
      for (const size_t i : cells)
        if (drawn(i) && std::isfinite(x(i)) && x(i) > 0) good.push_back(i);
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

  // The whole orders that fits come close to, for triangles beside the curves.
  static std::vector<int> slopes(const std::vector<Series>& series) {
    std::set<int> out;
    for (const Series& s : series) {
      if (!s.fit) continue;
      const double order = std::round(s.fit->slope);
      if (order >= 1 && order <= 6 && std::abs(s.fit->slope - order) < kShortOfClaim)
        out.insert(static_cast<int>(order));
    }
    return {out.begin(), out.end()};
  }

  void diagrams() {
    const size_t failed = static_cast<size_t>(std::count_if(
        view_.run().begin(), view_.run().end(), [&](size_t i) { return !view_.metrics(i).ok; }));
    std::string missing =
        failed == 0 ? ""
                    : fmt::format(" {} failed cell{} no point here: see the table of cells.",
                                  failed, failed == 1 ? " has" : "s have");
    missing += left_out();
    const std::vector<Filter> filters = page_filters(filters_);
    const auto plot = [&](const char* title, const Axes& axes, const std::vector<Series>& series,
                          const std::string& note) {
      if (!series.empty()) page_.plot(title, axes, series, note + missing, filters);
    };
    if (std::any_of(view_.run().begin(), view_.run().end(), [&](size_t i) { return drawn(i); }))
      page_.section("Work and precision");
    plot("Error against time",
         {.x = "time of the run [s]", .y = "trajectory error", .log_x = true, .log_y = true},
         curves([&](size_t i) { return view_.seconds(i); }, false),
         "Steps times the median processor time per step, nothing recorded. Lower left is better.");
    plot(
        "Error against evaluations",
        {.x = "evaluations of the equation", .y = "trajectory error", .log_x = true, .log_y = true},
        curves([&](size_t i) { return static_cast<double>(view_.metrics(i).evaluations); }, false),
        "Does not depend on the machine. What an evaluation costs differs between schemes; "
        "explicit ones make none.");
    if (!result_.config.reference) return;  // no errors, and so no orders
    page_.section("Orders");
    const std::vector<Series> by_step = curves(
        [&](size_t i) {
          const Config c = view_.cell(i).config();
          return c.chooses_steps() ? kNotMeasured : c.step_or_usual();
        },
        true);
    plot("Error against step",
         {.x = "step h [s]",
          .y = "trajectory error",
          .log_x = true,
          .log_y = true,
          .slopes = slopes(by_step)},
         by_step,
         "In the legend the slope by least squares, and of how many steps: those whose error is "
         "above the floor and below 0.1 of the motion.");
    if (view_.varies("rtol")) {
      plot("Error against tolerance",
           {.x = "rtol", .y = "trajectory error", .log_x = true, .log_y = true},
           curves(
               [&](size_t i) {
                 const Config c = view_.cell(i).config();
                 return c.chooses_steps() ? c.relative() + c.absolute() : kNotMeasured;
               },
               true),
           "Where steps are chosen by the error; the slope should be 1.");
    }
    add_orders(page_, view_);
  }

  void heat_maps() {
    std::vector<std::string> rows = names_, panels = filters_;
    if (view_.varies("s") && std::find(rows.begin(), rows.end(), "s") == rows.end()) {
      rows.emplace_back("s");
      std::erase(panels, "s");
    }
    for (const auto& [key, cells] : view_.groups(panels)) {
      const std::string title = view_.words(panels, key);
      heat_map("Error" + (title.empty() ? "" : ": " + title), "trajectory error", rows, panels, key,
               [&](size_t i) { return view_.metrics(i).error; });
      const bool solved = std::any_of(cells.begin(), cells.end(), [&](size_t i) {
        return !view_.cell(i).axes.at("solver").empty();
      });
      if (view_.varies("solver") && solved)
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

  // The cells with that key on the axes of the panels, in their order.
  std::vector<size_t> mapped_cells(const std::vector<std::string>& panels,
                                   const std::vector<std::string>& key) const {
    std::vector<size_t> out;
    for (size_t i = 0; i < result_.cells.size(); ++i) {
      const StudyCell& cell = result_.cells[i];
      bool here = cell.skipped != "duplicate" && !cell.config().chooses_steps();
      for (size_t k = 0; k < panels.size(); ++k) here = here && cell.axes.at(panels[k]) == key[k];
      if (here) out.push_back(i);
    }
    return out;
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
    std::map<std::string, size_t> column_of, row_of;
    for (size_t k = 0; k < steps.size(); ++k) column_of[steps[k]] = k;
    const std::vector<size_t> cells = mapped_cells(panels, key);
    for (const size_t i : cells) row_of.try_emplace(view_.words(i, rows), row_of.size());
    const size_t each = stride(row_of.size());
    for (const size_t i : cells) {
      const StudyCell& cell = result_.cells[i];
      const std::string name = view_.words(i, rows);
      if (row_of[name] % each != 0) continue;
      const size_t row = row_of[name] / each;
      if (row == map.values.size()) {
        map.y_values.emplace_back(name);
        map.values.emplace_back(steps.size(), kNotMeasured);
        map.marks.emplace_back(steps.size(), "");
      }
      const auto column = column_of.find(cell.axes.at("step"));
      if (column == column_of.end()) continue;  // a step that no cell was run with
      std::string& mark = map.marks[row][column->second];
      if (!cell.runs()) mark = cell.skipped == "excluded" ? "excluded" : "none";
      else if (!view_.metrics(i).ok) mark = "failed";
      else map.values[row][column->second] = value(i);
    }
    map.note += not_drawn(row_of.size(), "rows");
    add_heat_map(map);
  }

  // A map of one cell, or without any value, shows nothing that the table of cells does not.
  void add_heat_map(const HeatMap& map) {
    size_t values = 0, told = 0;
    for (size_t row = 0; row < map.values.size(); ++row) {
      for (size_t column = 0; column < map.values[row].size(); ++column) {
        const bool value = std::isfinite(map.values[row][column]);
        values += value;
        told += value || !map.marks[row][column].empty();
      }
    }
    if (values == 0 || told < 2) return;
    if (!mapped_) page_.section("Heat maps");
    mapped_ = true;
    page_.heatmap(map);
  }

  const StudyResult& result_;
  StudyView view_;
  Page page_;
  std::vector<std::string> names_, filters_;
  bool mapped_ = false;  // the section of the heat maps has begun
};

}  // namespace

Page study_page(const StudyResult& result) { return StudyPage(result).make(); }

}  // namespace hamel::tools
