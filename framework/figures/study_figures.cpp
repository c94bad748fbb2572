// The figures of a study.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/figures/study_view.hpp>

namespace hamel::figures {
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

class StudyFigures {
 public:
  explicit StudyFigures(const StudyResult& result) : view_(result) { divide_axes(); }

  std::vector<Figure> make() {
    diagrams();
    add_growth(out_, view_);
    heat_maps();
    name_apart(out_);
    return std::move(out_);
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

  std::vector<Filter> filters() const {
    std::vector<Filter> out;
    for (const std::string& axis : filters_) out.push_back({axis, view_.values(axis)});
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
  std::vector<Curve> curves(X x, bool with_fit) const {
    std::vector<std::string> axes = names_;
    axes.insert(axes.end(), filters_.begin(), filters_.end());
    std::vector<Curve> out;
    const std::vector<StudyView::Group> groups = view_.groups(axes);
    for (size_t g = 0; g < groups.size(); g += stride(groups.size())) {
      const auto& [key, cells] = groups[g];
      Curve curve{.name = view_.words(cells.front(), names_)};
      curve.markers = true;
      for (size_t k = 0; k < filters_.size(); ++k)
        if (const std::string& value = key[names_.size() + k]; !value.empty())
          curve.tags[filters_[k]] = value;  // no tag: it fits every value
      std::vector<size_t> good;
      for (const size_t i : cells)
        if (drawn(i) && std::isfinite(x(i)) && x(i) > 0) good.push_back(i);
      std::sort(good.begin(), good.end(), [&](size_t a, size_t b) { return x(a) < x(b); });
      for (const size_t i : good) {
        curve.x.push_back(x(i));
        curve.y.push_back(view_.metrics(i).error);
      }
      if (curve.x.empty()) continue;
      const StudyMetrics& m = view_.metrics(cells.front());
      if (with_fit && std::isfinite(m.order)) {
        curve.fit =
            Fit{m.order, fmt::format("{:.2f} ({} of {})", m.order, m.order_points, m.order_of)};
      }
      out.push_back(std::move(curve));
    }
    return out;
  }

  // The whole orders that fits come close to, for triangles beside the curves.
  static std::vector<int> slopes(const std::vector<Curve>& curves) {
    std::set<int> out;
    for (const Curve& c : curves) {
      if (!c.fit) continue;
      const double order = std::round(c.fit->slope);
      if (order >= 1 && order <= 6 && std::abs(c.fit->slope - order) < kShortOfClaim)
        out.insert(static_cast<int>(order));
    }
    return {out.begin(), out.end()};
  }

  // A plot of these curves with the filters; none without curves.
  void plot(const char* section, const char* name, const char* title, Axis x,
            std::vector<Curve> curves, const std::string& note) {
    if (curves.empty()) return;
    out_.push_back({.title = title,
                    .drawing = Plot{.x = std::move(x),
                                    .y = {.label = "trajectory error", .log = true},
                                    .slopes = slopes(curves),
                                    .filters = filters()},
                    .note = note + missing_,
                    .name = name,
                    .section = section});
    std::get<Plot>(out_.back().drawing).curves = std::move(curves);
  }

  void diagrams() {
    const size_t failed = static_cast<size_t>(std::count_if(
        view_.run().begin(), view_.run().end(), [&](size_t i) { return !view_.metrics(i).ok; }));
    if (failed > 0)
      missing_ = fmt::format(" {} failed cell{} no point here: see the table of cells.", failed,
                             failed == 1 ? " has" : "s have");
    missing_ += left_out();
    plot("Work and precision", "time", "Error against time", {"time of the run", "s", true},
         curves([&](size_t i) { return view_.seconds(i); }, false),
         "Steps times the median processor time per step, nothing recorded. Lower left is better.");
    plot("Work and precision", "evaluations", "Error against evaluations",
         {"evaluations of the equation", "", true},
         curves([&](size_t i) { return static_cast<double>(view_.metrics(i).evaluations); }, false),
         "Does not depend on the machine. What an evaluation costs differs between schemes; "
         "explicit ones make none.");
    if (!view_.result().config.reference) return;  // no errors, and so no orders
    plot("Orders", "error", "Error against step", {"step h", "s", true},
         curves(
             [&](size_t i) {
               const Config c = view_.cell(i).config();
               return c.chooses_steps() ? kNotMeasured : c.step_or_usual();
             },
             true),
         "In the legend the slope by least squares, and of how many steps: those whose error is "
         "above the floor and below 0.1 of the motion.");
    if (!view_.varies("rtol")) return;
    plot("Orders", "error", "Error against tolerance", {"rtol", "", true},
         curves(
             [&](size_t i) {
               const Config c = view_.cell(i).config();
               return c.chooses_steps() ? c.errors().at(1) : kNotMeasured;
             },
             true),
         "Where steps are chosen by the error; the slope should be 1.");
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
    for (size_t i = 0; i < view_.result().cells.size(); ++i) {
      const StudyCell& cell = view_.result().cells[i];
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
    HeatMap map{.x = {"step h", "s"}, .y = {""}, .log = true, .unit = unit};
    const std::vector<std::string> steps = view_.values("step");
    for (const std::string& h : steps) map.x_values.emplace_back(std::stod(h));
    std::map<std::string, size_t> column_of, row_of;
    for (size_t k = 0; k < steps.size(); ++k) column_of[steps[k]] = k;
    const std::vector<size_t> cells = mapped_cells(panels, key);
    for (const size_t i : cells) row_of.try_emplace(view_.words(i, rows), row_of.size());
    const size_t each = stride(row_of.size());
    for (const size_t i : cells) {
      const StudyCell& cell = view_.result().cells[i];
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
    if (shows_more(map))
      out_.push_back({.title = title,
                      .drawing = std::move(map),
                      .note = not_drawn(row_of.size(), "rows"),
                      .section = "Heat maps"});
  }

  // A map of one cell, or without any value, shows nothing that the table of cells does not.
  static bool shows_more(const HeatMap& map) {
    size_t values = 0, told = 0;
    for (size_t row = 0; row < map.values.size(); ++row) {
      for (size_t column = 0; column < map.values[row].size(); ++column) {
        const bool value = std::isfinite(map.values[row][column]);
        values += value;
        told += value || !map.marks[row][column].empty();
      }
    }
    return values > 0 && told > 1;
  }

  StudyView view_;
  std::vector<std::string> names_, filters_;
  std::string missing_;  // what the diagrams leave out
  std::vector<Figure> out_;
};

}  // namespace

std::vector<Figure> of_study(const StudyResult& result) { return StudyFigures(result).make(); }

}  // namespace hamel::figures
