// A run from its start to its end: steps, and what is recorded of them. Part of simulation.cpp, not installed.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <hamel/framework/run/record/run_file.hpp>
#include <hamel/framework/run/record/sink.hpp>
#include <hamel/framework/run/run/dense_output.hpp>
#include <hamel/framework/run/run/events.hpp>
#include <hamel/framework/run/run/meter.hpp>
#include <hamel/framework/run/run/plan.hpp>
#include <hamel/framework/run/run/restarted_kernel.hpp>

namespace hamel {

class RunLoop {
 public:
  using Clock = std::chrono::steady_clock;
  /// Where a plan without mistakes leads. An event may change the state (Simulation::on_event).
  RunLoop(Simulation::Plan& plan, Result& result, std::vector<std::unique_ptr<Sink>>& sinks);

  std::function<bool(const Snapshot&)> observer;
  std::function<void(double)> progress;
  const std::map<std::string, Impact>* impacts = nullptr;

  void run();
  /// Events that changed the state.
  long impacts_met() const { return impacts_met_; }
  /// The run in a file is gone on with.
  void resume(const RunFile& file);

 private:
  void go();
  void begin_sinks(const std::vector<ColumnGroup>& columns, const std::string& record);
  void begin_from_here();
  double elapsed() const;
  // Complete rows to the sinks.
  void deliver();
  // What there is goes to its files; the run can go on from here where a sink keeps its state.
  void keep();
  // All that the run goes on from but the events that were met.
  template <class Archive>
  void carry(Archive& archive) {
    archive(kernel_, steps_, next_, recorded_, result_.seconds, *plan_.events, meter_);
  }
  bool over() const;
  // What the last step brought; false: the run ends here.
  bool look_at_step();
  void look_within_step();
  // Rows at the output times up to t.
  bool output(double t);
  bool record(const Snapshot& state);
  std::optional<EventState> impact(const Events::Found& event);
  void go_on_from(const EventState& state, const Events::Found& event);

  const Config& config_;
  Simulation::Plan& plan_;
  Result& result_;
  std::vector<std::unique_ptr<Sink>>& sinks_;
  RestartedKernel kernel_;
  std::shared_ptr<const Mechanics> acting_;
  Meter meter_;
  std::unique_ptr<DenseOutput> dense_;
  std::vector<double> times_;  // of the rows; empty: every so many steps
  size_t next_ = 0;
  bool every_node_;
  long steps_;  // still to be taken, of one size
  long recorded_ = -1;
  Snapshot node_, row_;
  std::vector<Events::Found> found_;
  bool resumable_ = false, begun_ = false;
  long rows_ = 0, kept_at_ = 0;  // since the last keep(); its step
  long told_ = 0;                // events that are in the files
  long impacts_met_ = 0;
  double before_ = 0;  // seconds of the parts of the run before this one
  Clock::time_point begin_;
  Clock::duration comparing_{};  // is no part of the time of a run
};

}  // namespace hamel
