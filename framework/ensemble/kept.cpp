#include <hamel/framework/ensemble/kept.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/ensemble/kept_parser.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/components.hpp>

namespace hamel::ensemble {
namespace {

// What of a snapshot is measured, by the names of a run's columns.
template <class F>
void measured(F&& f) {
  f(kConstraint, [](const Snapshot& s) { return s.constraint; });
  f(kHolonomic, [](const Snapshot& s) { return s.holonomic; });
  f(kGroupDefect, [](const Snapshot& s) { return s.group_defect; });
  f(kIterations, [](const Snapshot& s) { return static_cast<double>(s.iterations); });
  f(kResidual, [](const Snapshot& s) { return s.residual; });
}

}  // namespace

StateNames::StateNames(const SystemModel& system, bool measures) : state_(system) {
  const std::vector<Component> components = components_of(system);
  std::vector<std::string> units = units_of_element(system.group);
  units.resize(system.group.columns.size());
  units.insert(units.begin(), "s");
  for (const Component& c : components) units.push_back(c.unit);
  for (size_t i = 0; i < units.size(); ++i) add(state_.variables()[i], units[i]);
  for (size_t i = 0; i < components.size(); ++i)
    add(fmt::format("mu{}", i + 1), unit_of_momentum(components[i]));
  add(kEnergy.name, kEnergy.unit);
  add(measures ? kEnergyError.name : "", kEnergyError.unit);
  measured([&](const Quantity& quantity, auto) { add(quantity.name, quantity.unit); });
  if (!measures) return;
  works_ = works(*system.mechanics);
  if (works_) add(kWork.name, kWork.unit);
  for (int row = 0; row < system.mechanics->constraint_count(); ++row) {
    const auto i = static_cast<size_t>(row);
    reactions_.push_back(i < system.reactions.size() ? system.reactions[i]
                                                     : fmt::format("lambda{}", row + 1));
    add(reactions_.back(), unit_of_reaction(system, row));
  }
}

bool StateNames::works(const Mechanics& mechanics) {
  return mechanics.has_force() || mechanics.has_drift();
}

void StateNames::add(const std::string& name, const std::string& unit) {
  names_.push_back(std::ranges::find(names_, name) == names_.end() ? name : "");
  units_.push_back(unit);
}

void StateNames::values(const Snapshot& state, const StateExtras& extras, double energy_start,
                        std::vector<double>& out) const {
  out.assign(1, state.time);
  out.insert(out.end(), state.coordinates.begin(), state.coordinates.end());
  out.insert(out.end(), state.velocity.begin(), state.velocity.end());
  out.insert(out.end(), state.momentum.begin(), state.momentum.end());
  out.push_back(state.energy);
  out.push_back(extras.balanced ? extras.energy_error : energy_error(state.energy, energy_start));
  measured([&](const Quantity&, auto of) { out.push_back(of(state)); });
  if (works_) out.push_back(extras.work);
  for (size_t i = 0; i < reactions_.size(); ++i)
    out.push_back(extras.reactions.empty() ? 0 : extras.reactions[i]);
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
          placed(config, key,
                 fmt::format("{}: '{}': {}", key, text, states_.state().in_words(error.what()))));
    }
  };
  for (size_t i = 0; i < config.keep.size(); ++i) {
    const Kept& kept = config.keep[i];
    const std::string key = fmt::format("keep[{}]", i),
                      name = kept.name.empty() ? kept.formula : kept.name;
    const std::string flaw = flaw_of_name(name, variations);
    if (flaw.empty()) add(key, name, kept.formula);
    else
      mistakes.push_back(placed(
          config, key,
          fmt::format("{}: {}: {{ name = \"...\", formula = \"...\" }} gives another", key, flaw)));
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

// What is wrong with the name of a column; "" for nothing.
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
      mistakes.push_back(placed(config, "histograms." + name,
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
    if (atom.from == From::most || atom.from == From::least) peaks_.push_back(i);
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

double KeptFormulas::value_of(const Atom& atom) const {
  return atom.formula ? (*atom.formula)(values_) : values_[atom.quantity];
}

void KeptFormulas::look_at(const Snapshot& state) {
  states_.values(state, extras_, energy_start_, values_);
  values_.insert(values_.end(), constants_.values().begin(), constants_.values().end());
}

void KeptFormulas::take_atom(Atom& atom) {
  atom.value = value_of(atom);
  atom.missing = false;
}

// The atoms that the state at the start or the end gives.
void KeptFormulas::take(From from) {
  for (Atom& atom : atoms_)
    if (atom.from == from) take_atom(atom);
}

void KeptFormulas::start(const Snapshot& state) {
  energy_start_ = state.energy;
  look_at(state);
  take(From::start);
}

void KeptFormulas::peak(const Snapshot& state) {
  look_at(state);
  for (const size_t i : peaks_) {
    Atom& atom = atoms_[i];
    const double value = value_of(atom);
    const bool better = atom.from == From::most ? value > atom.value : value < atom.value;
    if (better || !std::isfinite(value)) atom.value = value;
  }
}

void KeptFormulas::at(size_t time, const Snapshot& state) {
  look_at(state);
  for (const size_t atom : at_[time]) take_atom(atoms_[atom]);
}

void KeptFormulas::end(const Snapshot& state, const std::vector<EventMet>& met) {
  look_at(state);
  take(From::end);
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

std::string KeptFormulas::finish(std::span<double> out) {
  for (size_t i = 0; i < formulas_.size(); ++i) {
    const Formula& formula = formulas_[i];
    if (formula.expression) {
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
