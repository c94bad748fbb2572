// A run from its start to its end: steps, and what is recorded of them. Part of simulation.cpp, not installed.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include <hamel/framework/run/dense_output.hpp>
#include <hamel/framework/run/events.hpp>
#include <hamel/framework/run/meter.hpp>
#include <hamel/framework/run/plan.hpp>

namespace hamel {

class RunLoop {
 public:
  using Clock = std::chrono::steady_clock;
  /// Where a plan without mistakes leads. An event may change the state (Simulation::on_event).
  RunLoop(Simulation::Plan& plan, Result& result);

  std::function<bool(const Snapshot&)> observer;
  std::function<void(double)> progress;
  const std::map<std::string, Impact>* impacts = nullptr;

  void run();

 private:
  bool over() const;
  // What the last step brought; false: the run ends here.
  bool look_at_step();
  // Rows at the output times up to t.
  bool output(double t);
  bool record(const Snapshot& state);
  bool impact(const Events::Found& event);

  const Config& config_;
  Simulation::Plan& plan_;
  Result& result_;
  std::unique_ptr<Kernel> kernel_;
  std::shared_ptr<const Mechanics> acting_;
  Meter meter_;
  DenseOutput dense_;
  std::vector<double> times_;  // of the rows; empty: every so many steps
  size_t next_ = 0;
  bool every_node_;
  long steps_;  // still to be taken, of one size
  long recorded_ = -1;
  Snapshot node_, row_;
  std::vector<Events::Found> found_;
  Clock::duration comparing_{};  // is no part of the time of a run
};

}  // namespace hamel
