// Everything that can be wrong with a study, found before anything runs, each mistake with its
// place.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <type_traits>

#include <fmt/format.h>

#include <hamel/framework/batch/places.hpp>
#include <hamel/framework/study/parts.hpp>

namespace hamel {
namespace {

constexpr size_t kMaxCells = 200'000;

class Checks {
 public:
  Checks(const StudyConfig& study, const Registry& registry) : study_(study), registry_(registry) {
    for (const std::string& axis : study_axes()) lists_[axis] = study.values(axis);
  }

  std::vector<std::string> all() {
    plain_numbers();
    for (const std::string& axis : study_axes()) repeated(axis);
    for (size_t i = 0; i < study_.systems.size(); ++i) system(i);
    if (study_.systems.empty()) add("", "system: give at least one, headed [[system]]");
    for (const auto& [name, values] : study_.axes)
      if (std::count(study_axes().begin() + 1, study_axes().end(), name) == 0)
        add(name, unknown_name("axis", name, study_axes()));
    lengths();
    values();
    for (size_t i = 0; i < study_.exclude.size(); ++i) exclusion(i);
    if (out_.empty()) combinations();
    return std::move(out_);
  }

 private:
  void add(const std::string& key, const std::string& mistake) {
    out_.push_back(placed(study_.where, key, mistake));
  }

  void plain_numbers() {
    if (!(study_.until > 0) || !std::isfinite(study_.until))
      add("until", fmt::format("until: got {}, expected a positive number", study_.until));
    if (study_.repeats < 1 || study_.repeats > 1000)
      add("repeats", fmt::format("repeats: got {}, expected 1 to 1000", study_.repeats));
  }

  void repeated(const std::string& axis) {
    if (study_.zipped) return;
    const StudyValues& values = lists_.at(axis);
    std::set<std::string> seen;
    for (size_t i = 0; i < values.size(); ++i) {
      if (values[i].empty() || seen.insert(values[i]).second) continue;
      if (axis == "system") {
        add(fmt::format("system[{}].name", i),
            fmt::format("label: two systems are called '{}'; give each its label", values[i]));
      } else {
        add(fmt::format("{}[{}]", axis, i), fmt::format("{}: {} is listed twice", axis, values[i]));
      }
    }
  }

  // A run that is right but for what a study changes in it.
  Config sound(const StudySystem& system) const {
    Config config;
    config.step = Config::kUsualStep;
    config.system = system.name;
    config.parameters = system.parameters;
    config.start = system.start;
    config.inputs = system.inputs;
    if (!system.inputs.empty()) config.until = study_.until;  // which their tables cover
    if (const std::string group = group_of(system); !group.empty()) {
      const auto known = registry_.retractions_or_common(group);
      if (!known.empty() && registry_.geometry(group, config.retraction) == nullptr)
        config.retraction = known.front();
    }
    return config;
  }
  // "" for a system that cannot be made; the run reports why.
  std::string group_of(const StudySystem& system) const {
    if (!system.model && !names_file(system.name) && registry_.system(system.name) == nullptr)
      return "";
    try {
      return study::model(registry_, system).group.name;
    } catch (const std::invalid_argument&) {
      return "";
    }
  }
  std::vector<std::string> mistakes_of(const StudySystem& system, const Config& config) const {
    return study::simulation(registry_, system, config).mistakes();
  }

  void system(size_t i) {
    const StudySystem& given = study_.systems[i];
    const std::string prefix = fmt::format("system[{}]", i);
    if (given.name.empty()) return add(prefix, "system: give each its name");
    for (const std::string& mistake : mistakes_of(given, sound(given))) {
      std::string key = prefix + ".name";
      for (const char* start : {"configuration", "velocity", "momentum", "speed", "start"})
        if (mistake.starts_with(std::string(start) + ":")) key = prefix + "." + start;
      for (const auto& [parameter, value] : given.parameters)
        if (mistake.find("'" + parameter + "'") != std::string::npos ||
            mistake.find(parameter + ":") != std::string::npos)
          key = prefix + ".set." + parameter;
      if (mistake.starts_with("input '") || mistake.starts_with("unknown input"))
        key = prefix + ".inputs";
      add(key, mistake);
    }
  }

  StudySystem some_system() const {
    return study_.systems.empty() ? StudySystem{} : study_.systems.front();
  }

  // The run with this value on this axis; false, and reported, for text that is none.
  bool take(Config& config, const std::string& axis, size_t i) {
    try {
      config.set(axis, lists_.at(axis)[i]);
      return true;
    } catch (const ConfigError& error) {
      for (const std::string& mistake : error.mistakes())
        add(fmt::format("{}[{}]", axis, i), mistake);
      return false;
    }
  }

  // Checks each value by a run; only for its range if it is not among the first of a long list of
  // numbers, or if there are too many combinations.
  void values() {
    constexpr size_t kFirst = 100;
    const StudySystem system = some_system();
    const Config base = sound(system);
    Config::fields([&]<class Value>(const Option& option, Value Config::*) {
      if (!option.axis) return;
      const std::string axis = option.name;
      std::vector<std::string> known = base.mistakes();
      for (size_t i = 0; i < lists_.at(axis).size(); ++i) {
        Config config = base;
        if (!take(config, axis, i)) continue;
        if (axis == "retraction") retraction(i, config.retraction);
        else if (axis == "scheme" && config.scheme.empty())  // which a run takes for none given
          add(fmt::format("scheme[{}]", i), unknown_name("scheme", "", registry_.schemes()));
        else if (axis == "step") step(i, config.step_or_usual());
        else if (too_many_ || (i >= kFirst && std::is_arithmetic_v<Value>))
          new_mistakes(axis, i, config.mistakes(), known);
        else value(axis, i, system, base, config);
      }
    });
  }

  // Mistakes of a run with this value that one without it does not have. on_failure is checked
  // beside a solver that is not the one to retry with: the two are combined in the cells.
  void value(const std::string& axis, size_t i, const StudySystem& system, Config base,
             Config config) {
    if (axis == "on_failure") {
      for (const std::string& solver : registry_.solvers())
        if (config.on_failure != "retry:" + solver) config.solver = base.solver = solver;
    }
    auto [known, fresh] = known_.try_emplace(base.solver);
    if (fresh) known->second = mistakes_of(system, base);
    new_mistakes(axis, i, mistakes_of(system, config), known->second);
  }
  void new_mistakes(const std::string& axis, size_t i, const std::vector<std::string>& mistakes,
                    const std::vector<std::string>& known) {
    for (const std::string& mistake : mistakes)
      if (std::find(known.begin(), known.end(), mistake) == known.end())
        add(fmt::format("{}[{}]", axis, i), mistake);
  }

  // Some group must have it.
  void retraction(size_t i, const std::string& name) {
    const std::vector<std::string> retractions = registry_.retractions();
    if (std::find(retractions.begin(), retractions.end(), name) == retractions.end())
      add(fmt::format("retraction[{}]", i), unknown_name("retraction", name, retractions));
  }

  // Errors are compared at times that all steps reach.
  void step(size_t i, double h) {
    const std::string key = fmt::format("step[{}]", i);
    if (!(h > 0) || !std::isfinite(h))
      return add(key, fmt::format("step: got {}, expected a positive number", h));
    if (!(study_.until > 0) || !std::isfinite(study_.until)) return;  // a mistake of its own
    const double count = study_.until / h;
    if (std::abs(count - std::round(count)) > 1e-9 * count || count < 0.5)
      add(key, fmt::format("step: {} does not divide until = {} into whole steps; {} does", h,
                           study_.until, study_.until / std::max(1.0, std::round(count))));
    else if (count > 1e9)
      add(key, fmt::format("step: {} takes {:.2g} steps, more than 1e9", h, count));
  }

  void lengths() {
    size_t longest = 1, product = 1;
    std::string longest_axis;
    for (const std::string& axis : study_axes()) {
      const size_t size = lists_.at(axis).size();
      if (size == 0 && axis != "system" &&
          !study_.where.contains(axis))  // else the file's reader reported it
        add(axis, fmt::format("{}: give at least one value", axis));
      product = std::min(product * std::max<size_t>(size, 1), 1000 * kMaxCells);
      if (size > longest) longest_axis = axis;
      longest = std::max(longest, size);
    }
    if (!study_.zipped) {
      too_many_ = product > kMaxCells;
      if (too_many_)
        add("", fmt::format("the axes make {} or more combinations, expected at most {}", product,
                            kMaxCells));
      return;
    }
    for (const std::string& axis : study_axes()) {
      const size_t size = lists_.at(axis).size();
      if (size > 1 && size != longest)
        add(axis, fmt::format("{}: {} values, but {} has {}: zipped lists are of one length, or of "
                              "one value",
                              axis, size, longest_axis, longest));
    }
  }

  void exclusion(size_t i) {
    const StudyExclusion& given = study_.exclude[i];
    const std::string prefix = fmt::format("exclude[{}]", i);
    if (given.why.empty()) add(prefix, "exclude: say why");
    if (given.values.empty()) add(prefix, "exclude: name at least one axis with its values");
    for (const auto& [axis, values] : given.values) {
      constexpr size_t kShown = 100;  // values that a message lists
      const StudyValues known = study_.values(axis);
      const std::set<std::string> all(known.begin(), known.end());
      for (const std::string& value : values) {
        if (all.contains(value)) continue;
        add(prefix + "." + axis,
            "exclude: " + (known.size() <= kShown
                               ? unknown_name(axis, value, known)
                               : fmt::format("{} is none of the {} values of {}", shortened(value),
                                             known.size(), axis)));
      }
    }
  }

  // Mistakes that only show when the axes are combined.
  void combinations() {
    for (const auto& [axis, list] : lists_)
      if (list.empty()) return;
    std::set<std::string> seen;
    size_t count = 0;
    for (const StudyCell& cell : study_cells(study_, registry_)) {
      if (!cell.runs()) continue;
      ++count;
      const std::string key =
          fmt::format("{}/{}/{}", cell.system, cell.config().scheme, cell.config().retraction);
      if (!seen.insert(key).second) continue;
      for (const std::string& mistake : mistakes_of(study_.systems[cell.system], cell.config()))
        add(fmt::format("system[{}]", cell.system), mistake);
    }
    if (count == 0) add("exclude", "nothing is left to run");
  }

  const StudyConfig& study_;
  const Registry& registry_;
  std::map<std::string, StudyValues> lists_;               // of all axes
  bool too_many_ = false;                                  // combinations
  std::map<std::string, std::vector<std::string>> known_;  // mistakes of the run itself, by solver
  std::vector<std::string> out_;
};

}  // namespace

std::vector<std::string> StudyConfig::mistakes(const Registry& registry) const {
  return Checks(*this, registry).all();
}

std::string StudyConfig::fingerprint() const {
  std::string out = fmt::format("mode = {}\nuntil = {}\nrepeats = {}\n",
                                zipped ? "zipped" : "factorial", until, repeats);
  if (!reference) out += "reference = false\n";
  for (const StudySystem& system : systems) {
    out += fmt::format("system {} = {}, configuration ({}), velocity ({}), momentum ({})",
                       system.label, system.name, join(system.start.configuration),
                       join(system.start.velocity), join(system.start.momentum));
    for (const auto& [name, value] : system.parameters)
      out += fmt::format(", {} ({})", name, join(value));
    for (const auto& [name, signal] : system.inputs) {
      out += fmt::format(", input {} = {}", name, text_of(signal));
      if (const InputTable* table = std::get_if<InputTable>(&signal))
        out += fmt::format(" ({}) ({})", join(table->times), join(table->values));
    }
    out += '\n';
    std::istringstream lines(system.data);
    for (std::string line; std::getline(lines, line);)
      out += fmt::format("{}: {}\n", system.name, line);
  }
  for (const std::string& axis : study_axes())
    if (axis != "system") out += fmt::format("{} = {}\n", axis, join(values(axis)));
  for (const StudyExclusion& exclusion : exclude) {
    out += "exclude";
    for (const auto& [axis, excluded] : exclusion.values)
      out += fmt::format(" {} = {};", axis, join(excluded));
    out += '\n';
  }
  return out;
}

}  // namespace hamel
