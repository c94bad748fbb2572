#include "study_view.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace hamel::tools {

std::string axis_words(const std::string& axis, const std::string& value) {
  if (axis == "s") return value.empty() ? "" : "s = " + value;
  if (axis == "step") return "h = " + value;
  if (axis == "tolerance") return "tolerance " + value;
  if (axis == "compose" && value == "none") return "not composed";
  if (axis == "on_failure") return "on failure " + value;
  return value;
}

StudyView::StudyView(const StudyResult& result) : result_(result) {
  for (size_t i = 0; i < result.cells.size(); ++i)
    if (result.cells[i].runs() && result.metrics[i].done) run_.push_back(i);
  for (const std::string& axis : study_axes())
    if (values(axis).size() > 1) varying_.push_back(axis);
}

double StudyView::seconds(size_t i) const {
  const StudyMetrics& m = metrics(i);
  return 1e-9 * m.nanoseconds_median() * static_cast<double>(m.steps);
}

bool StudyView::varies(const std::string& axis) const {
  return std::find(varying_.begin(), varying_.end(), axis) != varying_.end();
}

std::vector<std::string> StudyView::values(const std::string& axis) const {
  std::vector<std::string> out;
  for (const size_t i : run_) {
    const std::string& value = cell(i).axes.at(axis);
    if (std::find(out.begin(), out.end(), value) == out.end()) out.push_back(value);
  }
  return out;
}

std::vector<StudyView::Group> StudyView::groups(const std::vector<std::string>& axes) const {
  std::vector<Group> out;
  std::map<std::vector<std::string>, size_t> index;
  for (const size_t i : run_) {
    std::vector<std::string> key;
    for (const std::string& axis : axes) key.push_back(cell(i).axes.at(axis));
    const auto [at, added] = index.try_emplace(key, out.size());
    if (added) out.push_back({key, {}});
    out[at->second].second.push_back(i);
  }
  return out;
}

std::vector<std::string> StudyView::varying_without(const std::vector<std::string>& axes) const {
  std::vector<std::string> out;
  for (const std::string& axis : varying_)
    if (std::find(axes.begin(), axes.end(), axis) == axes.end()) out.push_back(axis);
  return out;
}

std::string StudyView::words(const std::vector<std::string>& axes,
                             const std::vector<std::string>& values) const {
  std::string out;
  for (size_t k = 0; k < axes.size(); ++k) {
    const std::string word = axis_words(axes[k], values[k]);
    if (!word.empty()) out += (out.empty() ? "" : ", ") + word;
  }
  return out;
}

std::string StudyView::words(size_t i, const std::vector<std::string>& axes) const {
  std::vector<std::string> all;
  for (const std::string& axis : axes) all.push_back(cell(i).axes.at(axis));
  return words(axes, all);
}

std::vector<std::vector<size_t>> StudyView::otherwise_equal(const std::string& axis) const {
  std::vector<std::string> rest = study_axes();
  std::erase(rest, axis);
  const auto s = static_cast<size_t>(std::find(rest.begin(), rest.end(), "s") - rest.begin());
  std::vector<Group> with, without;
  for (Group& group : groups(rest))
    (s < rest.size() && group.first[s].empty() ? without : with).push_back(std::move(group));
  std::vector<std::vector<size_t>> out;
  for (Group& alone : without) {
    bool joined = false;
    for (Group& group : with) {
      alone.first[s] = group.first[s];
      if (alone.first != group.first) continue;
      group.second.insert(group.second.end(), alone.second.begin(), alone.second.end());
      joined = true;
    }
    if (!joined) out.push_back(std::move(alone.second));
  }
  for (Group& group : with) out.push_back(std::move(group.second));
  return out;
}

std::string StudyView::where(const std::vector<size_t>& some, const std::string& known) const {
  std::string out;
  for (const std::string& axis : varying_) {
    if (axis == known) continue;
    std::set<std::string> here;
    for (const size_t i : some) here.insert(cell(i).axes.at(axis));
    const std::vector<std::string> all = values(axis);
    if (here.size() == all.size()) continue;
    std::string list;
    for (const std::string& value : all)
      if (here.contains(value) && !value.empty()) list += (list.empty() ? "" : ", ") + value;
    if (list.empty()) list = "unused";
    out += fmt::format("{}{} {}", out.empty() ? "" : "; ", axis == "step" ? "h" : axis, list);
  }
  return out.empty() ? "everywhere" : out;
}

}  // namespace hamel::tools
