#include <hamel/framework/figures/study_view.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

namespace hamel::figures {

std::string axis_words(const std::string& axis, const std::string& value) {
  if (value.empty()) return "";
  if (axis == "s") return "s = " + value;
  if (axis == "step") return "h = " + value;
  if (axis == "compose" && value == "none") return "not composed";
  if (axis == "on_failure") return "on failure " + value;
  std::string out = value;
  Config::fields([&]<class Value>(const Option& option, Value Config::*) {
    if (option.name == axis && !std::is_same_v<Value, std::string>) out = axis + " " + value;
  });
  return out;
}

StudyView::StudyView(const StudyResult& result) : result_(result) {
  for (size_t i = 0; i < result.cells.size(); ++i)
    if (result.cells[i].runs() && result.metrics[i].done) run_.push_back(i);
  for (const std::string& axis : study_axes())
    if (values(axis).size() > 1) varying_.push_back(axis);
  std::set<std::string> chosen, of_one_size;
  for (const size_t i : run_)
    (cell(i).config().chooses_steps() ? chosen : of_one_size).insert(cell(i).axes.at("scheme"));
  std::ranges::set_intersection(chosen, of_one_size, std::inserter(both_ways_, both_ways_.end()));
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
  std::set<std::string> seen;
  for (const size_t i : run_) {
    const std::string& value = cell(i).axes.at(axis);
    if (!value.empty() && seen.insert(value).second) out.push_back(value);
  }
  return out;
}

std::vector<StudyView::Group> StudyView::groups(const std::vector<std::string>& axes) const {
  std::vector<Group> out;
  std::map<std::vector<std::string>, size_t> index;
  for (const size_t i : run_) {
    std::vector<std::string> key;
    for (const std::string& axis : axes) key.push_back(cell(i).axes.at(axis));
    key.emplace_back(cell(i).config().chooses_steps() ? "chosen"
                                                      : "");  // never beside steps of one size
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
  std::string out, unused;
  for (size_t k = 0; k < axes.size(); ++k) {
    const std::string word = axis_words(axes[k], values[k]);
    if (!word.empty()) out += (out.empty() ? "" : ", ") + word;
    else unused += fmt::format("{}{} {}", unused.empty() ? "" : ", ", axes[k], kUnused);
  }
  return out.empty() ? unused : out;
}

std::string StudyView::words(size_t i, const std::vector<std::string>& axes) const {
  std::vector<std::string> all;
  for (const std::string& axis : axes) all.push_back(cell(i).axes.at(axis));
  const bool ambiguous = cell(i).config().chooses_steps() &&
                         both_ways_.contains(cell(i).axes.at("scheme")) &&
                         std::ranges::find(axes, "rtol") == axes.end();
  return words(axes, all) + (ambiguous ? ", chosen steps" : "");
}

std::string StudyView::name(size_t i) const {
  const std::vector<std::string> axes = varying_without({"step", "rtol"});
  return axes.empty() ? cell(i).config().scheme : words(i, axes);
}

std::vector<std::vector<size_t>> StudyView::otherwise_equal(const std::string& axis) const {
  std::vector<std::string> rest = study_axes();
  std::erase(rest, axis);
  std::vector<Group> all = groups(rest);
  for (Group& group : all)
    std::erase_if(group.second, [&](size_t i) { return cell(i).axes.at(axis).empty(); });
  std::map<std::vector<std::string>, size_t> index;
  std::set<std::vector<bool>> patterns;  // which of the axes some cells do not use
  const auto unused = [](const std::vector<std::string>& key) {
    std::vector<bool> out;
    for (const std::string& value : key) out.push_back(value.empty());
    return out;
  };
  for (size_t i = 0; i < all.size(); ++i) {
    index[all[i].first] = i;
    patterns.insert(unused(all[i].first));
  }
  // Each group takes in those that its key becomes when more of it is left empty.
  std::vector<std::vector<size_t>> joined(all.size()), out;
  std::vector<bool> taken(all.size());
  for (size_t i = 0; i < all.size(); ++i) {
    joined[i] = all[i].second;
    for (const std::vector<bool>& pattern : patterns) {
      std::vector<std::string> key = all[i].first;
      for (size_t k = 0; k < key.size(); ++k)
        if (pattern[k]) key[k].clear();
      const auto at = index.find(key);
      if (at == index.end() || at->second == i) continue;
      const std::vector<size_t>& more = all[at->second].second;
      joined[i].insert(joined[i].end(), more.begin(), more.end());
      taken[at->second] = true;
    }
  }
  for (size_t i = 0; i < all.size(); ++i)
    if (!taken[i] && !joined[i].empty()) out.push_back(std::move(joined[i]));
  return out;
}

const char* StudyView::order_verdict(const std::vector<size_t>& cells) const {
  const StudyMetrics& m = metrics(cells.front());
  const int claim = cell(cells.front()).claimed_order;
  if (claim == 0) return "claims none";
  if (std::isnan(m.order)) return "not measured";
  const double off = m.order - claim, finest = m.order_finest - claim;
  if (off >= -kShortOfClaim && off <= kFarAboveClaim) return "ok";
  if (m.order_points < 3) return "not asymptotic";
  if (std::abs(finest) <= kShortOfClaim) return "finest only";
  double least = std::numeric_limits<double>::infinity();
  for (const size_t i : cells)
    if (metrics(i).ok) least = std::fmin(least, metrics(i).error);
  const bool settled = std::abs(finest - off) <= kShortOfClaim &&
                       least < kSmall * result_.references[cell(cells.front()).system].extent;
  return off < 0 && settled ? "below its claim" : "not asymptotic";
}

std::string StudyView::where(const std::vector<size_t>& some, const std::string& known) const {
  std::string out;
  for (const std::string& axis : varying_) {
    if (axis == known) continue;
    std::set<std::string> here;
    for (const size_t i : some) here.insert(cell(i).axes.at(axis));
    std::string list;
    bool all = true;
    for (const std::string& value : values(axis)) {
      all = all && here.contains(value);
      if (here.contains(value)) list += (list.empty() ? "" : ", ") + value;
    }
    if (all) continue;
    if (here.contains("")) list += fmt::format("{}{}", list.empty() ? "" : ", ", kUnused);
    out += fmt::format("{}{} {}", out.empty() ? "" : "; ", axis == "step" ? "h" : axis, list);
  }
  return out.empty() ? "everywhere" : out;
}

}  // namespace hamel::figures
