// Common part of all time loops: it counts, chooses steps, composes them of substeps, and handles
// one that fails. All that depends on the types, a substep first of all, is behind virtual
// functions that loop.hpp compiles: one call a substep, none
// inside.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <hamel/framework/loop/error_control.hpp>
#include <hamel/framework/loop/kernel.hpp>

namespace hamel {

class TimeLoop : public Kernel {
 public:
  // Virtual functions are inline here, so that every library has the vtable and the type of this
  // class (localise makes them local).
  Status advance(long count) final { return take_steps(count); }
  const SolverStats& stats() const final { return stats_; }
  long whole_steps() const final { return whole_; }
  bool off_grid() const final { return off_grid_; }
  double time() const final {
    return chooses_steps() || off_grid_ ? time_ : from_ + static_cast<double>(whole_ - first_) * h_;
  }
  void set_end_time(double t) final { limit_ = t; }
  double next_step() const final { return h_; }
  void turn_back() final { reverse(); }
  void restart(double t, std::span<const double> coordinates, std::span<const double> velocity,
               double step) final {
    put(t, coordinates, velocity);
    begin_anew(t, step);
  }
  void restart_near(Nearby to, double t, std::span<const double> coordinates,
                    std::span<const double> velocity) final {
    put(t, coordinates, velocity);
    go_on(t, to);
  }

 protected:
  explicit TimeLoop(const KernelSetup& setup);

  /// A state between steps is put away where a composed or rescued step goes back to when it fails.
  enum class Kept { step, rescue };
  /// State at which the last step began: the node before, or one that was put away.
  enum class Beginning { previous, step, rescue };

  /// A substep of size h, with what is remembered of the earlier ones of its place in the
  /// composition. One that fails leaves the state alone. Sets t_, and error_ where errors_ are
  /// controlled.
  virtual void substep(int place, double h, SolveReport& report) = 0;
  virtual void put_away(Kept where) = 0;
  virtual void fetch(Kept where) = 0;  // sets t_
  /// Keeps what is remembered of steps for a state next to the last one.
  virtual void move_history(Nearby to) = 0;
  /// Drops what the step remembers of forces.
  virtual void forget_forces() = 0;
  /// The size of the next step by a reversible control; h_ where there is none.
  virtual double controlled_size(double epsilon) = 0;
  /// The time of the last node is t, but for round-off.
  virtual void end_at(double t) = 0;
  /// Another state: as if nothing had been before.
  virtual void put(double t, std::span<const double> coordinates,
                   std::span<const double> velocity) = 0;

  /// The node to the log.
  virtual void log_node() = 0;

  StateLog* log_ = nullptr;

  bool chooses_steps() const { return setup_.errors.chooses_steps(); }

  KernelSetup setup_;
  double h_;
  double limit_ = std::copysign(std::numeric_limits<double>::infinity(), h_);
  double from_, time_;          // where steps were first counted; of the last step's end
  double t_;                    // of the node
  long first_ = 0, whole_ = 0;  // steps that are no parts: before from_, and all
  bool in_parts_ = false;       // the node is within a whole step
  bool off_grid_ = false;       // and in no place of steps of one size
  long inputs_changed_ = 0;     // seen
  SolveReport last_;
  long steps_ = 0;
  SolverStats stats_;
  Beginning beginning_ = Beginning::previous;
  std::optional<ErrorControl> errors_;  // of explicit pairs whose steps are chosen
  double error_ = 0;

 private:
  // False: the steps end here.
  bool logged() {
    if (log_ == nullptr || log_->every == 0 || steps_ % log_->every != 0) return true;
    log_node();
    return !log_->flawed;
  }

  Status take_steps(long count);
  Status take_plain_steps(long count);
  Status lost(const SolveReport& report);
  void reverse();
  void begin_anew(double t, double step);
  void go_on(double t, Nearby to);
  SolveReport one_step();
  SolveReport composed_step();
  SolveReport chosen_step();
  SolveReport fixed_step();
  SolveReport part_of_step(double end, bool whole);
  SolveReport error_controlled_step();
  void enter_inputs();
  double end_of_step(double t) const;
  double end_of_part(double end) const;
  bool ends_run(double t) const;
  double smallest_step(double t) const;
  void count_from(double t);
  void tally(const SolveReport& report);
  SolveReport recover(SolveReport failed);
  SolveReport rescued(const SolveReport& failed);
  SolveReport halve(int level, int& parts);
  Status failure(const SolveReport& report) const;
};

}  // namespace hamel
