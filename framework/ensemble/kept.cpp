#include <hamel/framework/ensemble/kept.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/batch/places.hpp>
#include <hamel/framework/ensemble/kept_parser.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/components.hpp>

namespace hamel::ensemble {

StateNames::StateNames(const SystemModel& system, bool measures)
    : state_(system),
      columns_(system, {.holonomic = true,
                        .work = measures && works(system),
                        .reactions = measures,
                        .acceleration = measures && !system.sensors.empty(),
                        .modes = measures && !system.contact_laws.empty(),
                        .paths = measures}) {
  for (size_t i = 0; i < columns_.size(); ++i) {
    bool left_out = false;
    columns_.each_source(i, [&](size_t j) {
      left_out |= !measures && columns_.of(j) == StateColumns::Of::energy_error;
    });
    const std::string name = left_out ? "" : name_in_formula(columns_.name(i));
    names_.push_back(std::ranges::find(names_, name) == names_.end() ? name : "");
  }
}

bool StateNames::works(const SystemModel& system) {
  return system.mechanics->has_force() || system.mechanics->has_drift() ||
         !system.contact_laws.empty();
}

double StateNumber::operator()(const StateColumns& columns, const Snapshot& state,
                               const StateExtras& extras, const std::vector<double>& constants,
                               std::vector<double>& work) const {
  if (!formula_) return columns.value(used_[0], state, extras);
  work.resize(columns.size() + constants.size());
  for (const size_t i : used_)
    work[i] = i < columns.size() ? columns.value(i, state, extras) : constants[i - columns.size()];
  return (*formula_)(work);
}

void StateNumber::require(const StateColumns& columns, StateParts& parts) const {
  for (const size_t i : used_)
    if (i < columns.size()) columns.require(i, parts);
}

MemberConstants::MemberConstants(const EnsembleConfig& config, const SystemModel& system,
                                 const Variations& variations)
    : variations_(&variations) {
  add("member", 0);
  for (const Field& field : system.fields)
    for (size_t i = 0; i < field.value.size(); ++i)
      add(field.value.size() == 1 ? field.name : fmt::format("{}{}", field.name, i + 1),
          field.value[i]);
  for (const auto& [name, signal] : config.run.inputs)
    if (const double* value = std::get_if<double>(&signal)) add(name, *value);
  for (const size_t v : variations.numbered()) {
    const std::string& name = variations.all()[v].name;
    if (name.starts_with("start.")) continue;
    const auto it = std::ranges::find(names_, name);
    const auto place = static_cast<size_t>(it - names_.begin());
    if (it == names_.end()) add(name, 0);
    varied_.emplace_back(place, v);
  }
}

void MemberConstants::add(const std::string& name, double value) {
  names_.push_back(name);
  values_.push_back(value);
}

void MemberConstants::begin(long member) {
  values_[0] = static_cast<double>(member);
  for (const auto& [place, variation] : varied_)
    values_[place] = variations_->number(variation, member);
}

std::vector<std::string> MemberConstants::behind(std::vector<std::string> others) const {
  const size_t count = others.size();
  for (const std::string& name : names_) {
    const auto end = others.begin() + static_cast<std::ptrdiff_t>(count);
    others.push_back(std::find(others.begin(), end, name) == end ? name : "");
  }
  return others;
}

KeptFormulas::KeptFormulas(const EnsembleConfig& config, const SystemModel& system,
                           const Variations& variations, std::vector<std::string>& mistakes)
    : states_(system, true), constants_(config, system, variations) {
  Parser parser(*this, config, system);
  const auto add = [&](const std::string& key, const std::string& name, const std::string& text) {
    try {
      parser.column(name, text);
    } catch (const std::invalid_argument& error) {
      mistakes.push_back(
          placed(config.where, key,
                 fmt::format("{}: '{}': {}", key, text, states_.state().in_words(error.what()))));
    }
  };
  for (size_t i = 0; i < config.keep.size(); ++i) {
    const Kept& kept = config.keep[i];
    const std::string key = fmt::format("keep[{}]", i),
                      name = kept.name.empty() ? kept.formula : kept.name;
    const std::string flaw =
        name.empty() && kept.function ? "a function has no name" : flaw_of_name(name, variations);
    if (!flaw.empty()) {
      mistakes.push_back(placed(
          config.where, key,
          fmt::format("{}: {}: {{ name = \"...\", formula = \"...\" }} gives another", key, flaw)));
    } else if (kept.function) {
      columns_.push_back({name, "", "a function of each member's run"});
      formulas_.push_back({name, {}, {}, kept.function, 0});
    } else {
      add(key, name, kept.formula);
    }
  }
  kept_ = columns_.size();
  check_histograms(config, mistakes);
  if (!config.classes.names.empty()) {
    add("class", "class", config.classes.formula);
    classes_ = config.classes.names.size();
  }
  quantities_ = config.statistics_of;
  if (!config.statistics_at.empty() && quantities_.empty()) quantities_ = states_.state().all();
  for (const double t : config.statistics_at) {
    for (const std::string& quantity : quantities_) {
      const std::string text = fmt::format("at({}).{}", t, quantity);
      add("statistics_at", text, text);
    }
  }
  settle(config.run.until >= config.run.from ? 1 : -1);
}

// Flaw of the name of a column; "" for none.
std::string KeptFormulas::flaw_of_name(const std::string& name,
                                       const Variations& variations) const {
  const auto has_name = [&](const auto& other) { return other.name == name; };
  if (std::ranges::any_of(columns_, has_name) || std::ranges::any_of(variations.all(), has_name) ||
      name == "class" || name == "failure" || name == "member")
    return fmt::format("there is another column '{}'", name);
  return "";
}

void KeptFormulas::check_histograms(const EnsembleConfig& config,
                                    std::vector<std::string>& mistakes) const {
  std::vector<std::string> names;
  for (const KeptColumn& column : columns_) names.push_back(column.name);
  for (const auto& [name, request] : config.histograms)
    if (std::ranges::find(names, name) == names.end())
      mistakes.push_back(placed(config.where, "histograms." + name,
                                "histograms: " + unknown_name("kept quantity", name, names)));
}

// After all formulas: times in the order of the run, with their atoms.
void KeptFormulas::settle(double sign) {
  const std::vector<double> found = times_;
  const auto before = [sign](double a, double b) { return sign * a < sign * b; };
  std::ranges::sort(times_, before);
  at_.assign(times_.size(), {});
  for (size_t i = 0; i < atoms_.size(); ++i) {
    Atom& atom = atoms_[i];
    const bool peak = atom.from == From::most || atom.from == From::least;
    if (atom.number) atom.number->require(states_.columns(), parts_);
    if (peak) {
      peaks_.push_back(i);
      atom.number->require(states_.columns(), peak_parts_);
    }
    if (atom.from != From::at) continue;
    atom.place = static_cast<size_t>(std::ranges::lower_bound(times_, found[atom.place], before) -
                                     times_.begin());
    at_[atom.place].push_back(i);
  }
}

void KeptFormulas::begin(long member) {
  constants_.begin(member);
  for (Atom& atom : atoms_) {
    const bool needs = atom.from == From::at || atom.from == From::time;
    atom.missing = needs;
    atom.value = needs                      ? kMissing
                 : atom.from == From::most  ? -std::numeric_limits<double>::infinity()
                 : atom.from == From::least ? std::numeric_limits<double>::infinity()
                                            : 0;
  }
}

double KeptFormulas::value_of(const Atom& atom, const Snapshot& state,
                              const StateExtras& extras) const {
  return (*atom.number)(states_.columns(), state, extras, constants_.values(), work_);
}

// These, or none but the energy at the start.
StateExtras KeptFormulas::with_start(const StateExtras* extras) const {
  StateExtras out = extras != nullptr ? *extras : alone_;
  out.energy_start = alone_.energy_start;
  return out;
}

void KeptFormulas::take(Atom& atom, const Snapshot& state, const StateExtras& extras) {
  atom.value = value_of(atom, state, extras);
  atom.missing = false;
}

// The atoms that the state at the start or the end gives.
void KeptFormulas::take(From from, const Snapshot& state, const StateExtras& extras) {
  for (Atom& atom : atoms_)
    if (atom.from == from) take(atom, state, extras);
}

void KeptFormulas::start(const Snapshot& state, const StateExtras* extras) {
  alone_.energy_start = state.energy;
  take(From::start, state, with_start(extras));
}

void KeptFormulas::peak(const Snapshot& state, const StateExtras* extras) {
  const StateExtras all = with_start(extras);
  for (const size_t i : peaks_) {
    Atom& atom = atoms_[i];
    const double value = value_of(atom, state, all);
    const bool better = atom.from == From::most ? value > atom.value : value < atom.value;
    if (better || !std::isfinite(value)) atom.value = value;
  }
}

void KeptFormulas::at(size_t time, const Snapshot& state, const StateExtras* extras) {
  const StateExtras all = with_start(extras);
  for (const size_t atom : at_[time]) take(atoms_[atom], state, all);
}

void KeptFormulas::end(const Snapshot& state, const std::vector<EventMet>& met,
                       const StateExtras* extras) {
  take(From::end, state, with_start(extras));
  for (const EventMet& event : met) {
    for (Atom& atom : atoms_) {
      if (atom.from != From::count && atom.from != From::time) continue;
      if (events_[atom.place] != event.name) continue;
      if (atom.from == From::count) ++atom.value;
      else if (atom.missing) {
        atom.value = event.time;
        atom.missing = false;
      }
    }
  }
}

std::string KeptFormulas::function() const {
  for (const Formula& formula : formulas_)
    if (formula.function) return formula.name;
  return "";
}

void KeptFormulas::functions(Run& run) {
  for (Formula& formula : formulas_)
    if (formula.function) formula.value = formula.function(run);
}

std::string KeptFormulas::finish(std::span<double> out) {
  for (size_t i = 0; i < formulas_.size(); ++i) {
    const Formula& formula = formulas_[i];
    if (formula.function) {
      out[i] = formula.value;
    } else if (formula.expression) {
      arguments_.clear();
      for (const size_t atom : formula.atoms) arguments_.push_back(atoms_[atom].value);
      arguments_.insert(arguments_.end(), constants_.values().begin(), constants_.values().end());
      out[i] = (*formula.expression)(arguments_);
    } else {
      out[i] = atoms_[formula.atoms.front()].value;
    }
    if (std::isfinite(out[i])) {
      const bool whole =
          out[i] == std::floor(out[i]) && out[i] >= 0 && out[i] < static_cast<double>(classes_);
      if (i != kept_ || classes_ == 0 || whole) continue;
      return fmt::format("class is {}, expected 0 to {}", out[i], classes_ - 1);
    }
    const bool missing =
        std::ranges::any_of(formula.atoms, [&](size_t a) { return atoms_[a].missing; });
    if (!missing)
      return fmt::format("'{}' is {}", formula.name,
                         std::isnan(out[i]) ? "not a number" : "infinite");
    out[i] = kMissing;
  }
  return "";
}

}  // namespace hamel::ensemble
