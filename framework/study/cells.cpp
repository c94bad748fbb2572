// From the axes to the cells: every combination, in order, and why some of them are not run.
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include <hamel/framework/run/run/plan.hpp>
#include <hamel/framework/schemes/composition.hpp>
#include <hamel/framework/study/parts.hpp>

namespace hamel {
namespace {

// The value of an axis that a study does not name: its runs have a step.
std::string text_without(const std::string& axis) {
  Config config;
  config.step = Config::kUsualStep;
  return config.completed().text(axis);
}

// The order that the scheme claims here. A composition reaches its own over a reversible step of
// order 2.
int claim(const Registry& registry, const StudyCell& cell, const SystemModel& system) {
  const SchemeInfo* scheme = registry.scheme(cell.config.scheme);
  if (cell.config.chooses_steps()) return 1;  // of the tolerance
  if (!scheme->adapted) return 0;  // of the free motion only: here it approximates nothing
  const TauTraits tau = registry.geometry(system.group.name, cell.config.retraction)->traits();
  const ClaimedOrder plain =
      scheme->claim(cell.config.s, tau, *system.mechanics, cell.config.force_at);
  for (const Composition& table : compositions()) {
    if (table.name == cell.config.compose && plain.reversible && plain.order == 2)
      return table.order;
  }
  return plain.order;
}

// The index of an axis in study_axes(), or their number.
size_t axis_index(const std::string& axis) {
  const std::vector<std::string>& all = study_axes();
  return static_cast<size_t>(std::find(all.begin(), all.end(), axis) - all.begin());
}

// Axes that a scheme makes no use of are empty in `axes` and the default in `run`, so that one cell
// represents all values.
void leave_unused(const SchemeInfo& scheme, bool halving, StudyAxes& axes, Config& run) {
  static const auto unused = std::make_shared<const std::string>();
  static const Config usual = [] {
    Config out;
    for (const std::string& axis : study_axes())
      if (axis != "system") out.set(axis, text_without(axis));
    return out;
  }();
  const auto leave = [&](const std::string& axis) {
    axes.set(axis, unused);
    Config::fields([&](const Option& option, auto member) {
      if (option.name == axis) run.*member = usual.*member;
    });
  };
  const bool chooses = scheme.estimates_error || (scheme.varies_steps && run.s == 0.5);
  if (!chooses) {
    leave("rtol");
    leave("atol");
  } else if (run.chooses_steps() && scheme.estimates_error) {
    leave("step");
  }
  for (const std::string& option : unused_options(scheme, run)) {
    if (!axes.contains(option)) continue;
    leave(option);
    if (option == "on_failure" && halving)
      axes.set(option, std::make_shared<const std::string>(run.on_failure));
  }
}

// Why a cell is another one's duplicate: "boxed does not use s: one cell represents all".
std::string same_as_above(const std::vector<StudyValues>& values, const StudyCell& cell,
                          const StudyAxes& same) {
  std::string unused;
  for (size_t k = 0; k < values.size(); ++k) {
    const std::string& axis = study_axes()[k];
    if (same.at(axis) == cell.axes.at(axis) || values[k].size() < 2) continue;
    unused += (unused.empty() ? "" : ", ") + (same.at(axis).empty() ? axis : cell.axes.at(axis));
  }
  return unused.empty() ? "the same combination is listed above"
                        : fmt::format("{} does not use {}: one cell represents all",
                                      cell.config.scheme, unused);
}

// The exclusions, for look-up.
class Exclusions {
 public:
  explicit Exclusions(const StudyConfig& config) {
    for (const StudyExclusion& exclusion : config.exclude) {
      auto& [why, values] = all_.emplace_back(exclusion.why, Values());
      for (const auto& [axis, list] : exclusion.values) values[axis] = {list.begin(), list.end()};
    }
  }
  // "" or the reason of the first exclusion that matches.
  std::string of(const StudyCell& cell) const {
    for (const auto& [why, values] : all_) {
      if (std::all_of(values.begin(), values.end(), [&](const auto& entry) {
            return entry.second.contains(cell.axes.at(entry.first));
          }))
        return why;
    }
    return "";
  }

 private:
  using Values = std::map<std::string, std::set<std::string>>;
  std::vector<std::pair<std::string, Values>> all_;
};

// The index into each axis for the i-th combination.
std::vector<size_t> indices(const StudyConfig& config, const std::vector<size_t>& sizes, size_t i) {
  std::vector<size_t> out(sizes.size());
  for (size_t k = sizes.size(); k-- > 0;) {
    if (config.zipped) {
      out[k] = sizes[k] == 1 ? 0 : i;
    } else {
      out[k] = i % sizes[k];
      i /= sizes[k];
    }
  }
  return out;
}

}  // namespace

const std::vector<std::string>& study_axes() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> out = {"system"};
    Config::fields([&](const Option& option, auto) {
      if (option.axis) out.emplace_back(option.name);
    });
    return out;
  }();
  return all;
}

StudyValues StudyConfig::values(const std::string& axis) const {
  StudyValues out;
  if (axis == "system")
    for (const StudySystem& system : systems) out.push_back(system.label);
  else if (const auto given = axes.find(axis); given != axes.end()) out = given->second;
  else out.push_back(text_without(axis));
  return out;
}

const std::string& StudyAxes::at(const std::string& axis) const {
  return *values_.at(axis_index(axis));
}
bool StudyAxes::contains(const std::string& axis) const {
  return axis_index(axis) < values_.size();
}
void StudyAxes::set(const std::string& axis, std::shared_ptr<const std::string> value) {
  values_.resize(study_axes().size());
  values_.at(axis_index(axis)) = std::move(value);
}
StudyAxes StudyAxes::without(const std::string& axis) const {
  static const auto none = std::make_shared<const std::string>();
  StudyAxes out = *this;
  out.values_.at(axis_index(axis)) = none;
  return out;
}
bool StudyAxes::operator<(const StudyAxes& other) const {
  return std::lexicographical_compare(
      values_.begin(), values_.end(), other.values_.begin(), other.values_.end(),
      [](const auto& a, const auto& b) { return a != b && *a < *b; });
}

StudyCells study_cells(const StudyConfig& config, const Registry& registry) {
  std::vector<StudyValues> values;
  std::vector<std::vector<std::shared_ptr<const std::string>>> shared;
  std::vector<std::vector<Config>> parsed;  // with that value of that axis
  std::vector<size_t> sizes;
  size_t count = 1;
  for (const std::string& axis : study_axes()) {
    values.push_back(config.values(axis));
    auto& texts = shared.emplace_back();
    auto& configs = parsed.emplace_back(values.back().size());
    for (size_t j = 0; j < values.back().size(); ++j) {
      texts.push_back(std::make_shared<const std::string>(values.back()[j]));
      if (axis != "system") configs[j].set(axis, values.back()[j]);
    }
    sizes.push_back(values.back().size());
    count = config.zipped ? std::max(count, sizes.back()) : count * sizes.back();
  }
  std::vector<SystemModel> models;
  for (const StudySystem& system : config.systems) models.push_back(study::model(registry, system));
  const StudyValues policies = config.values("on_failure");
  const bool halving = std::find(policies.begin(), policies.end(), "halve") != policies.end();
  const Exclusions exclusions(config);
  std::vector<StudyCell> cells;
  cells.reserve(count);
  const auto before = [](const StudyAxes* a, const StudyAxes* b) { return *a < *b; };
  std::set<const StudyAxes*, decltype(before)> seen;  // of the cells that are run
  for (size_t i = 0; i < count; ++i) {
    const std::vector<size_t> at = indices(config, sizes, i);
    StudyCell cell;
    cell.system = at[0];
    const StudySystem& system = config.systems[at[0]];
    cell.config.system = system.name;
    cell.config.parameters = system.parameters;
    cell.config.start = system.start;
    cell.config.inputs = system.inputs;
    cell.config.until = config.until;
    for (size_t k = 0; k < at.size(); ++k) cell.axes.set(study_axes()[k], shared[k][at[k]]);
    size_t k = 0;
    Config::fields([&](const Option& option, auto member) {
      if (!option.axis) return;
      ++k;
      cell.config.*member = parsed[k][at[k]].*member;
    });

    const std::string& group = models[at[0]].group.name;
    StudyAxes same = cell.axes;
    leave_unused(*registry.scheme(cell.config.scheme), halving, same, cell.config);
    if (cell.why = exclusions.of(cell); !cell.why.empty()) {
      cell.skipped = "excluded";
    } else if (registry.geometry(group, cell.config.retraction) == nullptr) {
      cell.skipped = "impossible";
      cell.why = fmt::format("{} has no retraction {}", group, cell.config.retraction);
    } else if (cell.config.on_failure == "retry:" + cell.config.solver) {
      cell.skipped = "impossible";
      cell.why = fmt::format("{} is the solver that failed", cell.config.solver);
    } else if (seen.contains(&same)) {
      cell.skipped = "duplicate";
      cell.why = same_as_above(values, cell, same);
    } else {
      cell.claimed_order = claim(registry, cell, models[at[0]]);
      cell.axes = std::move(same);
    }
    cells.push_back(std::move(cell));
    if (cells.back().runs()) seen.insert(&cells.back().axes);
  }
  return StudyCells(std::move(cells));
}

}  // namespace hamel
