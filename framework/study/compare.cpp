// Comparisons that need several cells: the order over the steps, and whether the solvers agree.
#include <algorithm>
#include <cmath>

#include <hamel/framework/study/parts.hpp>

namespace hamel::study {
namespace {

// The cells that were run and differ in one axis only, in the order of the cells.
std::vector<std::vector<size_t>> groups(const StudyCells& cells, const char* axis) {
  std::map<StudyAxes, size_t> index;
  std::vector<std::vector<size_t>> out;
  for (size_t i = 0; i < cells.size(); ++i) {
    if (!cells[i].runs()) continue;
    const auto [at, added] = index.try_emplace(cells[i].axes.without(axis), out.size());
    if (added) out.emplace_back();
    out[at->second].push_back(i);
  }
  return out;
}

}  // namespace

void compare(const StudyConfig& config, const StudyCells& cells,
             const std::vector<std::vector<bool>>& angles,
             const std::vector<StudyReference>& references, std::vector<StudyMetrics>& metrics) {
  // Over the step; where steps are chosen over the tolerance.
  const auto size = [&](size_t i) {
    const Config c = cells[i].config();
    return c.chooses_steps() ? c.errors().at(1) : c.step_or_usual();
  };
  std::vector<std::vector<size_t>> over;
  for (const bool chosen : {false, true}) {
    for (auto& group : groups(cells, chosen ? "rtol" : "step")) {
      std::erase_if(group, [&](size_t i) { return cells[i].config().chooses_steps() != chosen; });
      over.push_back(std::move(group));
    }
  }
  for (auto& group : over) {
    std::sort(group.begin(), group.end(), [&](size_t a, size_t b) { return size(a) > size(b); });
    std::vector<double> steps, errors;
    for (const size_t i : group) {
      const StudyMetrics& m = metrics[i];
      if (m.ok && m.error > m.floor && m.error < kAsymptotic * references[cells[i].system].extent) {
        steps.push_back(std::log(size(i)));
        errors.push_back(std::log(m.error));
      }
    }
    const size_t used = steps.size();
    const double finest =
        used < 2 ? kNotMeasured
                 : slope({steps[used - 2], steps[used - 1]}, {errors[used - 2], errors[used - 1]});
    for (const size_t i : group) {
      metrics[i].order = slope(steps, errors);
      metrics[i].order_finest = finest;
      metrics[i].order_points = static_cast<int>(steps.size());
      metrics[i].order_of = static_cast<int>(group.size());
    }
  }
  if (config.values("solver").size() < 2) return;
  for (const auto& group : groups(cells, "solver")) {
    const auto first =
        std::find_if(group.begin(), group.end(), [&](size_t i) { return metrics[i].ok; });
    if (first == group.end()) continue;
    for (auto i = first + 1; i != group.end(); ++i)
      if (metrics[*i].ok)
        metrics[*i].solver_difference =
            distance(angles[cells[*i].system], metrics[*i].final, metrics[*first].final);
  }
}

}  // namespace hamel::study
