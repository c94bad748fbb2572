// Kept quantities of a member: formulas of its states and events, evaluated as the run goes. Not
// installed.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/ensemble/vary.hpp>
#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/loop/snapshot.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/record/result.hpp>
#include <hamel/framework/run/record/state_columns.hpp>

namespace hamel::ensemble {

/// The numbers of a state by name, as formulas have them: t, the coordinates, the velocities, the
/// momenta, and what is measured.
class StateNames {
 public:
  /// measures: with the energy error, work and reactions.
  StateNames(const SystemModel& system, bool measures);
  /// "": the name of another one.
  const std::vector<std::string>& names() const { return names_; }
  const QuantityNames& state() const { return state_; }
  const StateColumns& columns() const { return columns_; }
  /// Do forces, moving constraints or friction?
  static bool works(const SystemModel& system);

 private:
  QuantityNames state_;
  StateColumns columns_;
  std::vector<std::string> names_;
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

/// The velocity alone.
inline constexpr StateParts kNoParts = {false, false, false, false, false};

/// A number of a state: of one column, or a formula of some and the constants.
class StateNumber {
 public:
  explicit StateNumber(size_t column) : used_{column} {}
  /// Over the names with the constants behind them.
  explicit StateNumber(Expression formula) : used_(formula.used()), formula_(std::move(formula)) {}
  /// Places of the names in it.
  const std::vector<size_t>& used() const { return used_; }
  /// work: of any content.
  double operator()(const StateColumns& columns, const Snapshot& state, const StateExtras& extras,
                    const std::vector<double>& constants, std::vector<double>& work) const;
  /// The parts of a state that it needs.
  void require(const StateColumns& columns, StateParts& parts) const;

 private:
  std::vector<size_t> used_;
  std::optional<Expression> formula_;  // none: the column
};

/// A number that a member has not.
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// Numbers that a state does not carry itself.
struct WantedPhysics {
  bool reactions = false, accelerations = false, modes = false;
  bool balance = false;  // work, or the energy error where work is done: every node is to be seen
  bool paths = false;    // of sensors: the same
  bool nodes() const { return balance || paths; }
  bool any() const { return reactions || accelerations || modes || nodes(); }
};

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
  const WantedPhysics& wants() const { return wants_; }
  /// The name of a function of the run among them; "" for none.
  std::string function() const;

  /// Parts of the states that are needed: at peaks; at all of them; at the start, whose energy
  /// others are compared with.
  const StateParts& peak_parts() const { return peak_parts_; }
  const StateParts& parts() const { return parts_; }
  StateParts start_parts() const {
    StateParts out = parts_;
    out.energy = out.energy || wants_start_;
    return out;
  }

  // Calls for one member, in this order.
  void begin(long member);
  void start(const Snapshot& state, const StateExtras* extras = nullptr);
  void peak(const Snapshot& state, const StateExtras* extras = nullptr);
  void at(size_t time, const Snapshot& state, const StateExtras* extras = nullptr);
  void end(const Snapshot& state, const std::vector<EventMet>& met,
           const StateExtras* extras = nullptr);
  /// The functions, of the run that has ended.
  void functions(Run& run);
  /// The columns; the reason why there are none, else "".
  std::string finish(std::span<double> out);

 private:
  enum class From { start, end, most, least, at, count, time };
  struct Atom {
    From from;
    std::string unit;
    size_t place = 0;                   // of the time or the event
    std::optional<StateNumber> number;  // of a state
    double value = 0;
    bool missing = false;
  };
  struct Formula {
    std::string name;
    std::vector<size_t> atoms;                  // used
    std::optional<Expression> expression;       // of them and the constants; none: the atom alone
    std::function<double(Run&)> function = {};  // in their place
    double value = 0;                           // of the function
  };
  class Parser;

  std::string flaw_of_name(const std::string& name, const Variations& variations) const;
  void check_histograms(const EnsembleConfig& config, std::vector<std::string>& mistakes) const;
  void settle(double sign);
  void take(Atom& atom, const Snapshot& state, const StateExtras& extras);
  void take(From from, const Snapshot& state, const StateExtras& extras);
  double value_of(const Atom& atom, const Snapshot& state, const StateExtras& extras) const;
  StateExtras with_start(const StateExtras* extras) const;

  StateNames states_;
  MemberConstants constants_;
  mutable std::vector<double> work_;
  std::vector<Atom> atoms_;
  std::vector<std::vector<size_t>> at_;  // atoms of each time
  std::vector<size_t> peaks_;            // atoms: most and least
  std::vector<Formula> formulas_;
  std::vector<KeptColumn> columns_;
  std::vector<double> times_, arguments_;
  std::vector<std::string> events_, quantities_;
  size_t kept_ = 0, classes_ = 0;
  bool wants_start_ = false, wants_peaks_ = false, wants_solver_ = false;
  WantedPhysics wants_;
  StateParts parts_ = kNoParts, peak_parts_ = kNoParts;
  StateExtras alone_;  // with the energy at the start
};

}  // namespace hamel::ensemble
