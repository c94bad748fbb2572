// Errors of one run, and of several that are compared.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include <hamel/framework/figures/curves.hpp>
#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/figures/run_figures.hpp>
#include <hamel/framework/mechanics/components.hpp>
#include <hamel/framework/mechanics/quantities.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel::figures {
namespace {

constexpr double kRoundOff = 2.2e-16;
constexpr size_t kWindows = 240;  // maxima of errors: as many as a figure shows apart

constexpr ErrorFigure kBalance = {kEnergyError.name, "energy-error", "Defect of the energy balance",
                                  "|E - E0 - W| / max E", ""};
constexpr std::array<ErrorFigure, 6> kErrors = {{
    {kExactError.name, "error", "Error of the configuration against the exact motion",
     "|difference|", "Euclidean distance of the element's columns."},
    {kExactVelocityError.name, "velocity-error", "Error of the velocity against the exact motion",
     "|difference|", "Euclidean distance of the body velocities."},
    {kEnergyError.name, "energy-error", "Energy error", "|E - E0| / E0", ""},
    {kConstraint.name, "constraint", "Constraint residual", "|A xi/h|",
     "The step's velocity is recovered from consecutive configurations; its floor is about "
     "2e-16/h times the size of the coordinates."},
    {kHolonomic.name, "holonomic", "Holonomic residual", "|phi(g)|", ""},
    {kGroupDefect.name, "group-defect", "Group defect", "defect", ""},
}};

std::string joined(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() ? a + b : a + " " + b;
}

Figure figure_of(const ErrorFigure& error, double floor, std::vector<Curve> curves,
                 std::string note) {
  Figure out = over_time(error.title, {.label = error.label, .log = true}, std::move(curves),
                         error.name, std::move(note));
  std::get<Plot>(out.drawing).floor = floor;
  return out;
}

// The windows whose largest values are the points of each curve.
std::string windows_of(const std::vector<NamedRun>& runs, const std::string& column) {
  std::set<std::string> different;
  std::string each;
  for (const auto& [name, result] : runs) {
    const std::string note = windows_note(*result, {column});
    different.insert(note);
    if (!note.empty()) each = joined(each, fmt::format("`{}`: {}", name, note));
  }
  return different.size() == 1 ? *different.begin() : each;
}

// Figures by name and unit, so that what is called otherwise in another system is never beside it.
class ByName {
 public:
  void add(const std::string& name, const std::string& unit, Curve curve) {
    const auto at = std::find_if(figures_.begin(), figures_.end(), [&](const Figure& figure) {
      return figure.title == name && std::get<Plot>(figure.drawing).y.unit == unit;
    });
    Figure& figure =
        at != figures_.end() ? *at : figures_.emplace_back(over_time(name, {name, unit}, {}));
    std::get<Plot>(figure.drawing).curves.push_back(std::move(curve));
  }
  void add_to(std::vector<Figure>& out) const {
    out.insert(out.end(), figures_.begin(), figures_.end());
  }

 private:
  std::vector<Figure> figures_;
};

void add_motions(std::vector<Figure>& out, const std::vector<NamedRun>& runs) {
  ByName velocities, coordinates;
  for (const auto& [name, result] : runs) {
    for (const Component& c : components_of(*result->system))
      velocities.add(c.name, c.unit, curve(*result, name, c.name));
    const std::vector<std::string>&columns = result->system->group.columns,
          units = units_of_element(result->system->group);
    for (size_t i = 0; i < columns.size(); ++i)
      coordinates.add(columns[i], i < units.size() ? units[i] : "",
                      curve(*result, name, columns[i]));
  }
  velocities.add_to(out);
  coordinates.add_to(out);
}

}  // namespace

bool does_work(const Result& r) { return std::isfinite(r.work); }

Figure over_time(std::string title, Axis y, std::vector<Curve> curves, std::string name,
                 std::string note, std::vector<Mark> marks) {
  return {.title = std::move(title),
          .drawing = Plot{.x = {"time t", "s"},
                          .y = std::move(y),
                          .curves = std::move(curves),
                          .marks = std::move(marks)},
          .note = std::move(note),
          .name = std::move(name)};
}

ErrorFigure error_figure(const std::string& column, bool balance) {
  if (balance && column == kBalance.column) return kBalance;
  const auto at =
      std::ranges::find_if(kErrors, [&](const ErrorFigure& e) { return column == e.column; });
  if (at == kErrors.end()) throw std::logic_error("no error figure of " + column);
  return *at;
}

Curve curve(const Result& result, const std::string& name, const std::string& column) {
  return drawable(name, result.trajectory.column("t"), result.trajectory.column(column));
}

Curve magnitude(const Result& result, const std::string& name, const std::string& column) {
  std::vector<double> y = result.trajectory.column(column);
  for (double& v : y) v = std::abs(v);
  return thinned(name, result.trajectory.column("t"), y, true, 2 * kWindows);
}

std::string windows_note(const Result& result, const std::vector<std::string>& columns) {
  const size_t rows = result.trajectory.rows(), stride = result.trajectory.stride();
  if (rows <= 2 * kWindows) return "";
  const size_t least = rows / kWindows;  // windows differ by one state
  const std::string count =
      rows % kWindows == 0 ? fmt::format("{}", least) : fmt::format("{} or {}", least, least + 1);
  if (stride == 1) return fmt::format("Each point is the largest of {} recorded states.", count);
  std::string out = fmt::format(
      "Each point is the largest of {} states, one in {} of those recorded.", count, stride);
  std::string all;
  Measurements::fields([&](const Quantity& quantity, const char* suffix, auto member) {
    const bool here = std::find(columns.begin(), columns.end(), quantity.name) != columns.end();
    if (here && std::string_view(suffix) == "_max" && std::isfinite(result.*member))
      all += fmt::format("{} {:.2g}", all.empty() ? "" : " and", result.*member);
  });
  return all.empty() ? out : out + fmt::format(" The largest of all recorded:{}.", all);
}

double round_off(const Result& result) {
  double size = 1;
  for (size_t i : thin_rows(result, 500))
    for (double v : element(result, i)) size = std::max(size, std::abs(v));
  return kRoundOff * size;
}

double floor_of(const Result& result, const std::string& column) {
  if (column == kConstraint.name)
    return round_off(result) / std::abs(result.config.step_or_usual());
  const bool of_size =
      column == kExactError.name || column == kExactVelocityError.name || column == kHolonomic.name;
  return of_size ? round_off(result) : kRoundOff;
}

void add_accuracy(std::vector<Figure>& out, const Result& r) {
  const auto add = [&](const ErrorFigure& error, std::vector<Curve> curves,
                       const std::vector<std::string>& columns) {
    if (curves.size() == 1) {  // its name is the title: the page leaves out the legend
      curves[0].name = error.title;
      curves[0].key = "accuracy";
    }
    out.push_back(figure_of(error, floor_of(r, error.column), std::move(curves),
                            joined(windows_note(r, columns), error.note)));
  };
  const bool known = r.trajectory.has(kExactVelocityError.name);
  if (known) {
    add({kExactError.name, "error", "Error against the exact motion", "|difference|",
         "Euclidean distance of the element's columns, and of the body velocities."},
        {magnitude(r, "configuration", kExactError.name),
         magnitude(r, "velocity", kExactVelocityError.name)},
        {kExactError.name, kExactVelocityError.name});
  }
  for (const ErrorFigure& error : kErrors) {
    const std::string column = error.column;
    if (column == kExactError.name || column == kExactVelocityError.name) continue;
    if (r.trajectory.has(column))
      add(error_figure(column, does_work(r)), {magnitude(r, "", column)}, {column});
  }
}

std::vector<Figure> of_runs(const std::vector<NamedRun>& runs) {
  std::vector<Figure> out;
  for (ErrorFigure error : kErrors) {
    double floor = 0;
    std::vector<Curve> curves;
    std::vector<NamedRun> shown;
    for (const auto& [name, result] : runs) {
      if (!result->trajectory.has(error.column)) continue;
      curves.push_back(magnitude(*result, name, error.column));
      shown.push_back({name, result});
      floor = std::max(floor, floor_of(*result, error.column));
    }
    if (curves.empty()) continue;
    if (std::string_view(error.column) == kEnergyError.name) {
      error.title = "Energy error, or defect of the energy balance";
      error.label = "relative";
    }
    out.push_back(figure_of(error, floor, std::move(curves), windows_of(shown, error.column)));
  }
  for (Figure& figure : out) figure.section = "Accuracy";
  const size_t errors = out.size();
  add_motions(out, runs);
  for (size_t i = errors; i < out.size(); ++i) out[i].section = "Motion";
  name_apart(out);
  return out;
}

}  // namespace hamel::figures
