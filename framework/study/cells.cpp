// From the axes to the cells: every combination, in order, and why some of them are not run.
#include <algorithm>
#include <set>

#include <fmt/format.h>

#include <hamel/framework/run/run/plan/plan.hpp>
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
int claim(const Registry& registry, const Config& run, const SystemModel& system) {
  const SchemeInfo* scheme = registry.scheme(run.scheme);
  if (run.chooses_steps()) return 1;  // of the tolerance
  if (!scheme->adapted) return 0;     // of the free motion only: here it approximates nothing
  const TauTraits tau = registry.geometry(system.group.name, run.retraction)->traits();
  const ClaimedOrder plain = scheme->claim(run.s, tau, *system.mechanics, run.force_at);
  for (const Composition& table : compositions()) {
    if (table.name == run.compose && plain.reversible && plain.order == 2) return table.order;
  }
  return plain.order;
}

// The index of an axis in study_axes(), or their number.
size_t axis_index(const std::string& axis) {
  const std::vector<std::string>& all = study_axes();
  return static_cast<size_t>(std::find(all.begin(), all.end(), axis) - all.begin());
}

using AxisValue = std::shared_ptr<const StudyAxisValue>;

// With the value of every axis that a study does not name.
const Config& usual() {
  static const Config out = [] {
    Config made;
    for (const std::string& axis : study_axes())
      if (axis != "system") made.set(axis, text_without(axis));
    return made;
  }();
  return out;
}

// The axes that a scheme makes no use of; `run` gets the default there.
std::vector<std::string> leave_unused(const SchemeInfo& scheme, Config& run) {
  std::vector<std::string> out;
  const auto leave = [&](const std::string& axis) {
    out.push_back(axis);
    Config::fields([&](const Option& option, auto member) {
      if (option.name == axis) run.*member = usual().*member;
    });
  };
  const bool chooses = scheme.estimates_error || (scheme.varies_steps && run.s == 0.5);
  if (!chooses) {
    leave("rtol");
    leave("atol");
  } else if (run.chooses_steps() && scheme.estimates_error) {
    leave("step");
  }
  const std::vector<std::string>& axes = study_axes();
  for (const std::string& option : unused_options(scheme, run))
    if (std::find(axes.begin(), axes.end(), option) != axes.end()) leave(option);
  return out;
}

// An axis of a study: its values as they are used, and as texts that change nothing in a run.
struct Axis {
  std::vector<AxisValue> used, unused;

  Axis(const std::string& name, const StudyValues& texts) {
    for (const std::string& text : texts) {
      StudyAxisValue value{text};
      if (name != "system") value.config.set(name, text);
      used.push_back(std::make_shared<const StudyAxisValue>(std::move(value)));
      unused.push_back(std::make_shared<const StudyAxisValue>(StudyAxisValue{text, usual()}));
    }
  }
};

// The configuration of the cells of one system, but for their axes.
std::shared_ptr<const Config> base_of(const StudySystem& system, double until) {
  Config out;
  out.system = system.name;
  out.parameters = system.parameters;
  out.start = system.start;
  out.inputs = system.inputs;
  out.until = until;
  return std::make_shared<const Config>(std::move(out));
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
                                      cell.axes.at("scheme"), unused);
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
  return values_.at(axis_index(axis))->text;
}
bool StudyAxes::contains(const std::string& axis) const {
  return axis_index(axis) < values_.size();
}
void StudyAxes::set(const std::string& axis, AxisValue value) {
  values_.resize(study_axes().size());
  values_.at(axis_index(axis)) = std::move(value);
}
void StudyAxes::apply(Config& run) const {
  size_t k = 0;  // of the system, which is no option
  Config::fields([&](const Option& option, auto member) {
    if (option.axis) run.*member = values_.at(++k)->config.*member;
  });
}
StudyAxes StudyAxes::without(const std::string& axis) const {
  static const auto none = std::make_shared<const StudyAxisValue>();
  StudyAxes out = *this;
  out.values_.at(axis_index(axis)) = none;
  return out;
}
bool StudyAxes::operator<(const StudyAxes& other) const {
  return std::lexicographical_compare(
      values_.begin(), values_.end(), other.values_.begin(), other.values_.end(),
      [](const auto& a, const auto& b) { return a != b && a->text < b->text; });
}

StudyCells::StudyCells() : StudyCells(std::vector<StudyCell>()) {}
StudyCells::StudyCells(std::vector<StudyCell> cells)
    : cells_(std::make_shared<const std::vector<StudyCell>>(std::move(cells))) {}

Config StudyCell::config() const {
  Config out = *base;
  axes.apply(out);
  return out;
}

StudyCells study_cells(const StudyConfig& config, const Registry& registry) {
  static const auto hidden = std::make_shared<const StudyAxisValue>(StudyAxisValue{"", usual()});
  std::vector<StudyValues> values;
  std::vector<Axis> axes;
  std::vector<size_t> sizes;
  size_t count = 1;
  for (const std::string& axis : study_axes()) {
    values.push_back(config.values(axis));
    axes.emplace_back(axis, values.back());
    sizes.push_back(values.back().size());
    count = config.zipped ? std::max(count, sizes.back()) : count * sizes.back();
  }
  std::vector<SystemModel> models;
  std::vector<std::shared_ptr<const Config>> bases;
  for (const StudySystem& system : config.systems) {
    models.push_back(study::model(registry, system));
    bases.push_back(base_of(system, config.until));
  }
  const StudyValues policies = config.values("on_failure");
  const bool halving = std::find(policies.begin(), policies.end(), "halve") != policies.end();
  const auto stop =
      std::make_shared<const StudyAxisValue>(StudyAxisValue{usual().on_failure, usual()});
  const Exclusions exclusions(config);
  std::vector<StudyCell> cells;
  cells.reserve(count);
  const auto before = [](const StudyAxes* a, const StudyAxes* b) { return *a < *b; };
  std::set<const StudyAxes*, decltype(before)> seen;  // of the cells that are run
  for (size_t i = 0; i < count; ++i) {
    const std::vector<size_t> at = indices(config, sizes, i);
    StudyCell cell;
    cell.system = at[0];
    cell.base = bases[at[0]];
    for (size_t k = 0; k < at.size(); ++k) cell.axes.set(study_axes()[k], axes[k].used[at[k]]);

    const std::string& group = models[at[0]].group.name;
    Config run = cell.config();
    StudyAxes same = cell.axes;
    for (const std::string& axis : leave_unused(*registry.scheme(run.scheme), run)) {
      const size_t k = axis_index(axis);
      same.set(axis, axis == "on_failure" && halving ? stop : hidden);
      cell.axes.set(axis, axes[k].unused[at[k]]);
    }
    if (cell.why = exclusions.of(cell); !cell.why.empty()) {
      cell.skipped = "excluded";
    } else if (registry.geometry(group, run.retraction) == nullptr) {
      cell.skipped = "impossible";
      cell.why = fmt::format("{} has no retraction {}", group, run.retraction);
    } else if (run.on_failure == "retry:" + run.solver) {
      cell.skipped = "impossible";
      cell.why = fmt::format("{} is the solver that failed", run.solver);
    } else if (seen.contains(&same)) {
      cell.skipped = "duplicate";
      cell.why = same_as_above(values, cell, same);
    } else {
      cell.claimed_order = claim(registry, run, models[at[0]]);
      cell.axes = std::move(same);
    }
    cells.push_back(std::move(cell));
    if (cells.back().runs()) seen.insert(&cells.back().axes);
  }
  return StudyCells(std::move(cells));
}

}  // namespace hamel
