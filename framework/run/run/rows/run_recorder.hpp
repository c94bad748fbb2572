// Measures a run as it goes: the row of each recorded state, by column name, and the Measurements
// over all. Not installed: the builder's own.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/io/row_file.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/record/measures.hpp>
#include <hamel/framework/run/record/result.hpp>
#include <hamel/framework/run/record/state_columns.hpp>
#include <hamel/framework/run/run/rows/energy_balance.hpp>
#include <hamel/framework/run/run/rows/path_lengths.hpp>
#include <hamel/framework/run/run/rows/reactions.hpp>

namespace hamel {

/// The flaw of a state, or of a row where it is measured: a number that is not
/// finite, or a step that led to it and cannot be recovered from its two configurations.
/// Reason::converged where there is none.
Reason flaw_of(const Snapshot& state);

class RunRecorder {
 public:
  /// balance: of the run, followed or not. reactions: null without rows. motion: of what sensors
  /// measure, null without. paths: of sensors.
  RunRecorder(const SystemModel& system, const Start& start, EnergyBalance balance,
              std::shared_ptr<Reactions> reactions, std::shared_ptr<Reactions> motion,
              PathLengths paths);

  /// Does it need every node, not the recorded states only?
  bool wants_nodes() const { return balance_.active() || paths_.active(); }
  void node(const Snapshot& state) {
    if (balance_.active()) balance_.node(state);
    if (paths_.active()) paths_.node(state);
  }
  template <class Within>
  void step(double begin, const Snapshot& end, const Within& motion_within) {
    if (balance_.active()) balance_.step(begin, end, motion_within);
    if (paths_.active()) paths_.step(begin, end, motion_within);
  }
  /// The start, from which energy, invariants and the exact motion are followed, before any row.
  void begin(const Snapshot& start);
  /// An event changed the state: what that did to the energy and the invariants is no error.
  void impact(const Snapshot& before, const Snapshot& after);
  /// The measurements that a state carries.
  void take(const Snapshot& state);
  /// Measurements by the equations of motion, the invariants and the exact motion, and the state's
  /// row (the columns of tools/README.md).
  void compare(const Snapshot& state);
  /// Outputs that depend on columns which the run has not.
  const std::vector<std::string>& missing_outputs() const { return columns_.missing(); }
  /// The columns of a row.
  const std::vector<ColumnGroup>& columns() const { return columns_.groups(); }
  /// The rows that are complete and were not dropped, one after the other. Where work is done the
  /// first rows wait.
  std::span<const double> rows() const {
    return std::span(rows_).first(complete_ * columns_.size());
  }
  void drop_rows();
  /// After the last state, a row or not: no row waits.
  void finish(const Snapshot& last);
  const Measurements& all() const { return all_; }
  /// Notes for the user.
  const std::vector<std::string>& notes() const { return notes_; }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(all_, energy_start_, time_start_, last_row_, rows_, exact_lost_, notes_, pulls_, time_,
            power_, power_time_, second_work_, second_power_, second_time_, odd_,
            start_configuration_, lambda_, balance_, paths_, balanced_, measured_);
  }
  /// A resumed run: the exact motion is followed to here through the times of the rows before.
  void follow_exact(double time);

 private:
  void react(const Snapshot& state, bool start = false);
  void add_second(double power, double at);
  void look_at_reaction_work();
  void look_at_invariants(const Snapshot& state);
  std::pair<double, double> look_at_exact(const Snapshot& state);
  void finish_rows(const Snapshot& last);
  void settle();
  void settle_work(std::size_t all);
  void settle_paths(std::size_t all);
  ExactFlow exact_from_start() const;

  const SystemModel& system_;
  Start start_;
  std::vector<double> rows_;
  std::size_t complete_ = 0;                 // rows
  std::size_t balanced_ = 0, measured_ = 0;  // rows, with their work; with their paths
  std::vector<BalancedState> settled_;
  std::vector<double> lengths_;
  std::vector<double> start_configuration_;
  Measurements all_;
  bool all_holonomic_ = false;
  double energy_start_ = 0, time_start_ = 0, last_row_ = 0;
  EnergyBalance balance_;
  PathLengths paths_;
  StateColumns columns_;
  ExactFlow exact_;
  bool exact_lost_ = false;  // noted already
  std::vector<std::string> notes_;
  std::vector<char> pulls_;  // of the contacts, noted already
  // The multipliers lambda of A xi = b, from the continuous equations at each state, and their
  // power lambda . A v in the last step before it, A v recovered from the configurations
  // (Snapshot::constraint_rates) and lambda interpolated to the same time, Snapshot::time_offset
  // before the state: round-off where b = 0, the power that a moving constraint feeds in where it
  // is not.
  std::shared_ptr<Reactions> of_rows_;  // null without rows
  std::shared_ptr<Reactions> motion_;   // null without sensors
  double time_ = 0, power_ = 0, power_time_ = 0;
  // Their work by every second state, up to that one.
  double second_work_ = 0, second_power_ = 0, second_time_ = 0;
  bool odd_ = false, drifts_ = false;
  Eigen::VectorXd lambda_;
};

}  // namespace hamel
