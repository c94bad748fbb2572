// The time of a step along a parameter of a system: studies whose systems differ in one number.
#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <hamel/framework/figures/study_view.hpp>

namespace hamel::figures {
namespace {

// The one scalar parameter in which the systems differ; "" when there is none, or more than one.
std::string only_difference(const std::vector<const StudySystem*>& systems) {
  std::set<std::string> names;
  for (const StudySystem* system : systems) {
    for (const auto& [name, value] : system->parameters) names.insert(name);
  }
  std::string found;
  for (const std::string& name : names) {
    std::set<std::vector<double>> values;
    bool scalar = true;
    for (const StudySystem* system : systems) {
      const auto it = system->parameters.find(name);
      const std::vector<double> value =
          it == system->parameters.end() ? std::vector<double>{} : it->second;
      scalar = scalar && value.size() == 1 && value[0] > 0;
      values.insert(value);
    }
    if (values.size() == 1) continue;
    if (!found.empty() || !scalar || values.size() < 3) return "";
    found = name;
  }
  return found;
}

// The slope of log y over log x between the last point and the first that is at least half as far.
double last_slope(const Curve& curve) {
  const size_t last = curve.x.size() - 1;
  size_t from = 0;
  while (from + 1 < last && curve.x[from] < 0.45 * curve.x[last]) ++from;
  return std::log(curve.y[last] / curve.y[from]) / std::log(curve.x[last] / curve.x[from]);
}

}  // namespace

void add_growth(std::vector<Figure>& out, const StudyView& view) {
  const std::vector<StudySystem>& all = view.result().config.systems;
  std::set<std::string> names;
  for (const StudySystem& system : all) names.insert(system.name);
  const std::vector<std::string> axes = view.varying_without({"system"});
  for (const std::string& name : names) {
    std::vector<const StudySystem*> systems;
    for (const StudySystem& system : all) {
      if (system.name == name) systems.push_back(&system);
    }
    const std::string parameter = only_difference(systems);
    if (parameter.empty()) continue;
    std::vector<Curve> curves;
    for (const auto& [key, cells] : view.groups(axes)) {
      std::vector<std::pair<double, double>> points;
      for (const size_t i : cells) {
        const StudySystem& system = all[view.cell(i).system];
        const double time = view.metrics(i).nanoseconds_median() * 1e-3;
        if (system.name != name || !view.metrics(i).ok || !std::isfinite(time)) continue;
        points.emplace_back(system.parameters.at(parameter)[0], time);
      }
      std::sort(points.begin(), points.end());
      if (points.size() < 3) continue;
      Curve curve{.name = axes.empty() ? name : view.words(axes, key)};
      curve.markers = true;
      for (const auto& [x, y] : points) {
        curve.x.push_back(x);
        curve.y.push_back(y);
      }
      const double slope = last_slope(curve);
      curve.fit = Fit{slope, fmt::format("power {:.2f} at the end", slope)};
      curves.push_back(std::move(curve));
    }
    if (curves.empty()) continue;
    out.push_back(
        {.title = fmt::format("{}: time of a step against {}", name, parameter),
         .drawing = Plot{.x = {parameter, "", true},
                         .y = {"time per step", "us", true},
                         .curves = std::move(curves)},
         .note = "Median processor time per step, nothing recorded. In the legend the slope over "
                 "the largest values.",
         .section = "Growth"});
  }
}

}  // namespace hamel::figures
