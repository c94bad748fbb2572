// Measures a run as it goes: the row of each recorded state, by column name, and the Measurements over all.
// Not installed: the builder's own.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/equations_of_motion.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/energy_balance.hpp>
#include <hamel/framework/run/measures.hpp>
#include <hamel/framework/run/result.hpp>
#include <hamel/framework/schemes/erased.hpp>

namespace hamel {

class Meter {
 public:
  /// geometry: null for a group that is not registered. acting: mechanics,
  /// without its rows where the scheme does not keep them.
  Meter(const SystemModel& system, const Start& start, std::shared_ptr<const Geometry> geometry,
        std::shared_ptr<const Mechanics> mechanics, const std::shared_ptr<const Mechanics>& acting,
        std::shared_ptr<const Inputs> inputs);

  /// Does it want every node, not the recorded states only?
  bool wants_nodes() const { return balance_.active(); }
  void node(const Snapshot& state) { balance_.node(state); }
  /// Begins the row of a state with what the kernel measured of it (the columns of tools/README.md).
  void take(const Snapshot& state);
  /// Ends it with what the equations of motion, the invariants and the exact motion say.
  void compare(const Snapshot& state);
  /// The names of the row's columns, after the first.
  const std::vector<std::string>& columns() const { return columns_; }
  const std::vector<double>& row() const { return row_; }
  /// After the last state; completes the columns of the rows.
  Measurements finish(Trajectory& rows);
  /// What the user should know.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  // Adds to the row, and to the names of its columns while it is the first.
  void add(const char* name, double value);
  void add(const std::vector<std::string>& names, std::span<const double> values);
  void add_numbered(const char* name, std::span<const double> values);
  void react(const Snapshot& state);

  const SystemModel& system_;
  Start start_;
  std::vector<std::string> columns_;
  std::vector<double> row_;
  Measurements all_;
  bool first_ = true, holonomic_ = false;
  double energy_start_ = 0, time_start_ = 0;
  EnergyBalance balance_;
  ExactFlow exact_;
  bool exact_lost_ = false;  // said already
  std::vector<std::string> notes_;
  std::vector<bool> pulls_;  // of the contacts, said already
  // The multipliers lambda of A xi = b, from the continuous equations at each state, and their power
  // lambda . A v in the last step before it, A v recovered from the configurations (Snapshot::row_rates) and
  // lambda interpolated to the same time, Snapshot::lag before the state: round-off where b = 0, the power that a
  // moving constraint feeds in where it is not.
  std::shared_ptr<const Geometry> geometry_;
  std::unique_ptr<EquationsOfMotion<Erased>> motion_;  // null without rows
  double time_ = 0, power_ = 0, power_time_ = 0;
  Eigen::VectorXd g_, xi_, lambda_;
};

}  // namespace hamel
