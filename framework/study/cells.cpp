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

// What a scheme makes no use of is empty in `axes` and the default in `run`, so that one cell
// stands for all values.
void leave_unused(const SchemeInfo& scheme, bool halving, std::map<std::string, std::string>& axes,
                  Config& run) {
  const auto leave = [&](const char* axis) {
    axes[axis] = "";
    run.set(axis, text_without(axis));
  };
  const bool chooses = scheme.estimates_error || (scheme.varies_steps && run.s == 0.5);
  if (!chooses) {
    leave("rtol");
    leave("atol");
  } else if (run.chooses_steps() && scheme.estimates_error) {
    leave("step");
  }
  for (const std::string& option : unused_options(scheme, run)) {
    leave(option.c_str());
    if (option == "on_failure" && halving) axes[option] = run.on_failure;
  }
}

// Why a cell is another one's duplicate: "boxed does not use s: one cell stands for all".
std::string same_as_above(const std::vector<StudyValues>& values, const StudyCell& cell,
                          const std::map<std::string, std::string>& same) {
  std::string unused;
  for (size_t k = 0; k < values.size(); ++k) {
    const std::string& axis = study_axes()[k];
    if (same.at(axis) == cell.axes.at(axis) || values[k].size() < 2) continue;
    unused += (unused.empty() ? "" : ", ") + (same.at(axis).empty() ? axis : cell.axes.at(axis));
  }
  return unused.empty() ? "the same combination stands above"
                        : fmt::format("{} does not use {}: one cell stands for all",
                                      cell.config.scheme, unused);
}

// What is excluded, to be looked up.
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

std::vector<StudyCell> study_cells(const StudyConfig& config, const Registry& registry) {
  std::vector<StudyValues> values;
  std::vector<size_t> sizes;
  size_t count = 1;
  for (const std::string& axis : study_axes()) {
    values.push_back(config.values(axis));
    sizes.push_back(values.back().size());
    count = config.zipped ? std::max(count, sizes.back()) : count * sizes.back();
  }
  std::vector<SystemModel> models;
  for (const StudySystem& system : config.systems) models.push_back(study::model(registry, system));
  const StudyValues policies = config.values("on_failure");
  const bool halving = std::find(policies.begin(), policies.end(), "halve") != policies.end();
  const Exclusions exclusions(config);
  std::vector<StudyCell> cells;
  std::set<std::map<std::string, std::string>> seen;
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
    for (size_t k = 0; k < at.size(); ++k) {
      const std::string& axis = study_axes()[k];
      cell.axes[axis] = values[k][at[k]];
      if (axis != "system") cell.config.set(axis, cell.axes[axis]);
    }

    const std::string& group = models[at[0]].group.name;
    std::map<std::string, std::string> same = cell.axes;
    leave_unused(*registry.scheme(cell.config.scheme), halving, same, cell.config);
    if (cell.why = exclusions.of(cell); !cell.why.empty()) {
      cell.skipped = "excluded";
    } else if (registry.geometry(group, cell.config.retraction) == nullptr) {
      cell.skipped = "impossible";
      cell.why = fmt::format("{} has no retraction {}", group, cell.config.retraction);
    } else if (cell.config.on_failure == "retry:" + cell.config.solver) {
      cell.skipped = "impossible";
      cell.why = fmt::format("{} is the solver that failed", cell.config.solver);
    } else if (!seen.insert(same).second) {
      cell.skipped = "duplicate";
      cell.why = same_as_above(values, cell, same);
    } else {
      cell.claimed_order = claim(registry, cell, models[at[0]]);
      cell.axes = std::move(same);
    }
    cells.push_back(std::move(cell));
  }
  return cells;
}

}  // namespace hamel
