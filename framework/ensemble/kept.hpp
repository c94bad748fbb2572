// What is kept of a member: formulas of its states and events, evaluated as the run goes. Not
// installed.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/ensemble/vary.hpp>
#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/loop/snapshot.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel::ensemble {

/// What is measured at a state beside it (member_physics.hpp).
struct StateExtras {
  std::vector<double> reactions = {};  // the multipliers of the rows
  bool balanced = false;               // work is done, and the next two are known
  double work = 0, energy_error = 0;
};

/// The numbers of a state by name: t, the coordinates, the velocities, the momenta, and what is
/// measured.
class StateNames {
 public:
  /// measures: with the energy error, work and reactions, for which values() needs the extras.
  StateNames(const SystemModel& system, bool measures);
  /// As formulas have them.
  const std::vector<std::string>& names() const { return names_; }
  const QuantityNames& state() const { return state_; }
  const std::string& unit(size_t i) const { return units_[i]; }
  /// In the order of the names, and of nothing else.
  void values(const Snapshot& state, const StateExtras& extras, double energy_start,
              std::vector<double>& out) const;
  /// Do forces or moving constraints?
  static bool works(const Mechanics& mechanics);
  /// The names among them of reactions.
  const std::vector<std::string>& reactions() const { return reactions_; }

 private:
  void add(const std::string& name, const std::string& unit);
  QuantityNames state_;
  std::vector<std::string> names_, units_;  // "": the name of another one
  std::vector<std::string> reactions_;
  bool works_ = false;
};

/// The numbers of a member that do not change on the way: parameters, inputs, what is varied, its
/// index.
class MemberConstants {
 public:
  MemberConstants(const EnsembleConfig& config, const SystemModel& system,
                  const Variations& variations);
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<double>& values() const { return values_; }
  void begin(long member);
  /// Other names with these behind them; a name that both have is the other's.
  std::vector<std::string> behind(std::vector<std::string> others) const;

 private:
  void add(const std::string& name, double value);
  const Variations* variations_;
  std::vector<std::string> names_;
  std::vector<double> values_;
  std::vector<std::pair<size_t, size_t>> varied_;  // place, variation
};

/// A number that a member has not.
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// A column of what is kept.
struct KeptColumn {
  std::string name, unit, meaning;
};

class KeptFormulas {
 public:
  /// Adds to mistakes what cannot be read: unknown quantities, formulas, times beyond the run.
  KeptFormulas(const EnsembleConfig& config, const SystemModel& system,
               const Variations& variations, std::vector<std::string>& mistakes);

  /// The columns: what is kept, the class where there is one, and for each time of statistics_at
  /// its quantities.
  const std::vector<KeptColumn>& columns() const { return columns_; }
  size_t width() const { return columns_.size(); }
  /// How many of them are kept, without the class.
  size_t kept() const { return kept_; }
  /// The quantities of statistics_at.
  const std::vector<std::string>& quantities() const { return quantities_; }
  /// Increasing in the direction of the run; those of at(T) and statistics_at.
  const std::vector<double>& times() const { return times_; }
  /// The events to watch, as a run has them.
  const std::vector<std::string>& events() const { return events_; }
  bool wants_start() const { return wants_start_; }
  bool wants_peaks() const { return wants_peaks_; }
  /// Iterations and residuals of steps?
  bool wants_solver() const { return wants_solver_; }
  /// Constraint residuals or the group's defect?
  bool wants_defects() const { return wants_defects_; }
  bool wants_reactions() const { return wants_reactions_; }
  /// Work, or the energy error where work is done: every node is to be seen.
  bool wants_balance() const { return wants_balance_; }

  // Of one member, in this order; extras: of the next state.
  void begin(long member);
  void extras(const StateExtras& of_next) { extras_ = of_next; }
  void start(const Snapshot& state);
  void peak(const Snapshot& state);
  void at(size_t time, const Snapshot& state);
  void end(const Snapshot& state, const std::vector<EventMet>& met);
  /// The columns; the reason why there are none, else "".
  std::string finish(std::span<double> out);

 private:
  enum class From { start, end, most, least, at, count, time };
  struct Atom {
    From from;
    std::string unit;
    size_t place = 0;                   // of the time or the event
    size_t quantity = 0;                // of a state
    std::optional<Expression> formula;  // in its place
    double value = 0;
    bool missing = false;
  };
  struct Formula {
    std::string name;
    std::vector<size_t> atoms;             // used
    std::optional<Expression> expression;  // of them and the constants; none: the atom alone
  };
  class Parser;

  std::string flaw_of_name(const std::string& name, const Variations& variations) const;
  void check_histograms(const EnsembleConfig& config, std::vector<std::string>& mistakes) const;
  void settle(double sign);
  void take_atom(Atom& atom);
  void look_at(const Snapshot& state);
  void take(From from);
  double value_of(const Atom& atom) const;

  StateNames states_;
  MemberConstants constants_;
  std::vector<double> values_;  // of the state and the constants
  std::vector<Atom> atoms_;
  std::vector<std::vector<size_t>> at_;  // atoms of each time
  std::vector<size_t> peaks_;            // atoms: most and least
  std::vector<Formula> formulas_;
  std::vector<KeptColumn> columns_;
  std::vector<double> times_, arguments_;
  std::vector<std::string> events_, quantities_;
  size_t kept_ = 0, classes_ = 0;
  bool wants_start_ = false, wants_peaks_ = false, wants_solver_ = false, wants_defects_ = false;
  bool wants_reactions_ = false, wants_balance_ = false;
  StateExtras extras_;
  double energy_start_ = 0;
};

}  // namespace hamel::ensemble
