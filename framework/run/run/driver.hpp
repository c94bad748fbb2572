// The driver of a run: it takes the steps, and its observers follow them: events with their
// impacts, rows with their measurements, files and checkpoints. Not installed: the insides of
// Run.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/run/record/run_file.hpp>
#include <hamel/framework/run/record/sink.hpp>
#include <hamel/framework/run/run/dense_output.hpp>
#include <hamel/framework/run/run/events.hpp>
#include <hamel/framework/run/run/occupancy.hpp>
#include <hamel/framework/run/run/plan/plan.hpp>
#include <hamel/framework/run/run/rows/logged_rows.hpp>
#include <hamel/framework/run/run/rows/rows_watch.hpp>
#include <hamel/framework/run/run/rows/run_recorder.hpp>
#include <hamel/framework/run/run/step_follower.hpp>
#include <hamel/framework/run/run/steps/restarted_kernel.hpp>
#include <hamel/framework/run/run/steps/step_watch.hpp>

namespace hamel {

class Driver {
 public:
  /// plan: without mistakes.
  Driver(RunPlan plan, RunRequest request);

  Status step(long count);
  Status step_towards(double t);
  Status advance_to(double t);
  Status complete();
  void turn_back();
  void input(const std::string& name, double value);
  void restart(const Start& start);
  /// Its steps are shown to that too, also behind restart(); null: to none. Before the first step.
  void follow(StepFollower* follower);
  const Snapshot& at(double t);
  const Snapshot& state(const StateParts& parts);
  double time();
  const std::vector<EventMet>& events() const { return result_.events; }
  bool over() const { return over_; }
  /// The run in a file is resumed.
  void resume(const RunFile& file);
  /// The last row and the measurements; the run is over. Files are unfinished until close().
  Result& end();
  void close();
  /// Both, once. State and events stay.
  Result finish();
  Occupancy& occupancy() { return occupancy_; }

  const RunPlan& plan() const { return plan_; }
  const SolverStats& stats() const { return kernel().stats(); }
  long impacts_met() const { return impacts_met_; }
  /// Rows and measurements of the result that are computed when they are read; null where all are.
  LoggedRows* unread() const { return logged_.get(); }
  /// Impacts by the names of their events.
  const std::map<std::string, Impact>& impacts() const { return request_.impacts; }
  double next_step() const { return kernel().next_step(); }
  /// The mechanics as the scheme treats it.
  std::shared_ptr<const Mechanics> acting() const;
  /// The balance of its energy, from its start on.
  EnergyBalance balance() const;
  /// The paths of its sensors, from its start on.
  PathLengths paths() const { return {plan_.geometry, *plan_.system, plan_.setup.inputs}; }
  /// Place and velocity within the last step (Kernel::motion_within).
  bool motion_within(double t, Snapshot& out) const { return kernel().motion_within(t, out); }

 private:
  using Clock = std::chrono::steady_clock;
  // Adds its lifetime.
  struct Timed {
    explicit Timed(Clock::duration& to) : sum(to) {}
    ~Timed() { sum += Clock::now() - begin; }
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;
    Clock::duration& sum;
    const Clock::time_point begin = Clock::now();
  };

  RestartedKernel& kernel() const;
  void begin();
  void make_observers();
  // Steps, so many, or to the end of the run, each of them followed by the observers.
  Status advance(long count, bool to_end = false);
  Status take_unseen(long count);
  // Steps in so many pieces that what watches them sees each: the largest next piece.
  long piece_of(long count) const;
  // After a piece: not ok where the run would not end, or has taken all the steps that it may.
  std::optional<std::string> why_steps_end(long steps, double t);
  Status steps_go_on(long steps, const Snapshot& now);
  bool count_tries(long steps);
  void limit_grid(long count);
  void take_steps(long count, bool to_end);
  long steps_at_once(long count, bool to_end) const;
  bool reached_end() const;
  // Not ok behind finish(), and where t is not finite.
  Status steppable(double t) const;
  Status covered(double t) const;
  Status refuse(double t, const std::string& reason) const;
  DenseOutput& dense();

  // Observes the last step; false: the run ends here.
  bool observe_step(double begin);
  bool observe_steps(long before, double begin, bool at_end);
  bool observe_event(const Events::Found& event, double begin, bool& go_on);
  // contact_observer: a switch of contacts that ended the last step.
  std::optional<ContactSwitch> take_switch();
  bool observe_switch(const ContactSwitch& met);
  void balance_step(double begin, const Snapshot& end);
  void observe_start();
  // Rows at the output times up to t.
  bool output(double t);
  bool record_node();
  bool may_log() const;
  // The steps up to now are in the log; false: the last ended in no state, and the run with it.
  bool logged();
  bool record(Clock::time_point begin);
  // False, and the run has failed, where the state has a flaw; result_.last is the last good one.
  bool good(const Snapshot& state);
  std::string flaw(const Snapshot& state);
  void report_progress(double done);
  std::optional<EventState> impact(const Events::Found& event) const;
  void restart_behind(const EventState& state, const Events::Found& event);

  void begin_sinks(const std::vector<ColumnGroup>& columns, const std::string& record);
  // Complete rows to the sinks.
  void deliver();
  // Rows to their files; the run can be resumed from here where a sink keeps its state.
  void keep();
  void rows_to_files_after_failure();
  // The time up to now into seconds_.
  void lap();
  Result head() const;
  // The measurements over all rows, or of start and end alone.
  void measure_all();
  void measure_ends_only();
  // All that a resumed run needs but the events that were met.
  template <class Archive>
  void serialize(Archive& archive) {
    if (plan_.contacts != nullptr) plan_.contacts->serialize(archive);  // before its kernel is made
    archive(kernel(), steps_, rejected_, steps_left_, next_, recorded_, seconds_.all,
            seconds_.recording, seconds_.comparing, *plan_.events, *recorder_);
  }

  RunPlan plan_;
  RunRequest request_;
  Occupancy occupancy_;
  bool watching_ = false, every_node_ = false;
  mutable std::unique_ptr<RestartedKernel> kernel_;  // of plan_
  mutable bool restarted_ = false;                   // and the kernel does not know it yet
  std::optional<StartMatrices> matrices_;  // of a restart, where they are the same everywhere
  std::unique_ptr<DenseOutput> dense_;     // made when it is first needed
  std::shared_ptr<LoggedRows> logged_;     // rows that are measured when they are read; null: all
  std::shared_ptr<RunRecorder> recorder_;  // null where nothing is recorded
  StepFollower* follower_ = nullptr;       // the caller's
  StepWatch steps_;                        // of chosen ones
  long rejected_ = 0;                      // tries that it has counted
  std::unique_ptr<RowsWatch> rows_watch_;  // where rows move and no kernel is compiled for them
  std::vector<std::unique_ptr<Sink>> sinks_;
  Result result_;
  Snapshot node_, row_;
  std::vector<double> element_;  // of a state that is checked
  std::vector<Events::Found> found_;
  std::vector<double> times_;  // of the rows; empty: every so many steps
  size_t next_ = 0;
  long steps_left_ = 0;  // to the end, of one size
  long recorded_ = -1;
  bool begun_ = false, over_ = false, finished_ = false, sinks_begun_ = false, resumable_ = false,
       flawed_ = false;
  long rows_ = 0, kept_at_ = 0;  // since the last keep(); its step
  long kept_events_ = 0;         // events that are in the files
  long impacts_met_ = 0;
  // Result::seconds and its parts, up to entered_, those before a file was resumed too.
  struct Seconds {
    double all = 0, recording = 0, comparing = 0;
  };
  Seconds seconds_;
  Clock::time_point entered_;
  Clock::duration in_rows_{}, comparing_{};  // since then; what compares is within rows
};

}  // namespace hamel
