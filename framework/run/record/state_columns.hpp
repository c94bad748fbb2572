// The numbers of a state by name: columns of a run's rows, what an ensemble keeps, the variables of
// formulas. One list of names, units and meanings; the value of each is found when it is asked for.
// Not installed.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/io/row_file.hpp>
#include <hamel/framework/loop/snapshot.hpp>
#include <hamel/framework/mechanics/output_formulas.hpp>
#include <hamel/framework/mechanics/quantities.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// Numbers that are known beside a state.
struct StateExtras {
  double energy_start = 0;
  std::span<const double> reactions = {};     // the multipliers of all rows
  std::span<const double> acceleration = {};  // xi'; left out where it is not known
  double reaction_power = 0;
  std::span<const double> modes = {};  // of the contacts that may slide and open
  std::span<const double> paths = {};  // of the sensors that have one
  double work = 0;
  std::optional<double> balance_error = {};  // of the energy, where work is done
  double exact_error = 0, exact_velocity_error = 0;
};

class StateColumns {
 public:
  enum class Of {
    time,
    coordinate,
    velocity,
    energy,
    energy_error,
    constraint,
    group_defect,
    iterations,
    residual,
    holonomic,
    momentum,
    work,
    reaction,
    reaction_power,
    sensor,
    acceleration,  // of a sensor
    path,          // of a sensor
    mode,
    friction_work,  // of a contact
    exact_error,
    exact_velocity_error,
    output
  };
  /// Columns that not every system and every use has.
  struct Has {
    bool holonomic = false, work = false, reactions = false, reaction_power = false, exact = false;
    bool acceleration = false;
    bool modes = false;
    bool paths = false;
    bool friction_works = false;  // of contacts
  };
  StateColumns(const SystemModel& system, const Has& has);

  std::size_t size() const { return columns_.size(); }
  const std::vector<ColumnGroup>& groups() const { return groups_; }
  const std::string& name(std::size_t i) const { return columns_[i].name; }
  const std::string& unit(std::size_t i) const { return columns_[i].unit; }
  Of of(std::size_t i) const { return columns_[i].of; }
  /// The first column of that kind; none.
  std::optional<std::size_t> find(Of of) const;
  double value(std::size_t i, const Snapshot& state, const StateExtras& extras) const;
  /// Outputs, which are the last columns.
  std::size_t output_count() const { return outputs_.size(); }
  /// The outputs of a row whose other columns are there.
  void complete(std::span<double> row) const;
  /// Calls visit(j) for the columns that column i depends on, or i alone.
  template <class Visit>
  void each_source(std::size_t i, const Visit& visit) const {
    if (columns_[i].of != Of::output) return visit(i);
    for (const std::size_t j : outputs_[columns_[i].place].formula.used()) each_source(j, visit);
  }
  /// Outputs that depend on columns which are not here.
  const std::vector<std::string>& missing() const { return missing_; }
  /// Adds the parts of a state that column i needs.
  void require(std::size_t i, StateParts& parts) const;

 private:
  struct Column {
    Of of;
    std::size_t place;  // within the vector
    std::string name, unit;
  };
  void add(Of of, const Quantity& quantity);
  // The columns of a group, in the order of these places; the unit of all where one is known.
  void add(Of of, ColumnGroup group, const std::vector<std::string>& units,
           const std::vector<std::size_t>& places = {});
  void add_sensors(const Has& has);
  void add_outputs(const SystemModel& system);
  static void require(Of of, StateParts& parts);
  double measured(std::size_t place, const Snapshot& state, const StateExtras& extras) const;
  // Apart: what few columns need is no part of the others' calls.
  [[gnu::noinline]] double output(std::size_t place, const Snapshot& state,
                                  const StateExtras& extras) const;
  std::vector<Column> columns_;
  std::vector<ReadyOutput> outputs_;
  mutable std::vector<double> values_;  // of the columns that an output depends on
  std::vector<std::string> missing_;
  std::vector<Sensor> sensors_;  // whose numbers are counted one behind the other
  std::vector<ColumnGroup> groups_;
};

}  // namespace hamel
