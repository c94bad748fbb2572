// Run: the driver of a trajectory, by hand or to its end.
//
//   hamel::Run run = hamel::simulate("segway").step(0.005).input("left_torque", 0).build();
//   while (run.state().time < 10) {
//     run.input("left_torque", feedback(run.state().velocity));
//     if (!run.step()) break;
//   }
//   hamel::Result result = run.finish();
//
// Events, impacts, rows, files and measurements follow the steps, whoever takes them. A run by hand
// keeps rows on request of the builder: record_to(), keep_rows(), observe() or output();
// without any, and without events, a step costs the step alone.
//
// A run belongs to one thread at a time, and its own functions (observer, impact, progress) may
// read it, but neither step, restart, turn, finish, move nor destroy it; whoever uses one that was
// moved from, or breaks these rules where it can be seen, gets std::logic_error by name
// (occupancy.hpp).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/run/names/config.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel {

class Driver;
class Simulation;
struct RunTangent;  // framework/tangent/sensitivities.hpp

class HAMEL_API Run {
 public:
  /// of: the builder that made it.
  Run(std::unique_ptr<Driver> driver, std::shared_ptr<const Simulation> of);
  Run(Run&&) noexcept;
  Run& operator=(Run&&) noexcept;
  ~Run();

  /// Takes a step (or count of them); the status of the first that failed. Behind an event that
  /// ends the run, or an observer that returned false, it does nothing: ok, with the reason. Behind
  /// finish() it fails with this as the reason; so do the others that step.
  Status step(long count = 1);
  /// Takes a step; a chosen one ends at t at the latest.
  Status step_towards(double t);
  /// Steps to time t, which is finite: chosen ones end there, others at the node nearest to it.
  Status advance_to(double t);
  /// Steps to the end time, or to what ends the run before.
  Status complete();
  /// Time runs the other way from here; steps chosen by the reversible control are taken back as
  /// they came.
  void turn_back();
  /// An input from now on, in the unit that the system states; the builder must have given the run
  /// a first value of some input. ConfigError where there is no such input, or the value is out of
  /// its range.
  void input(const std::string& name, double value);
  /// Again from another start (projected as by the builder), at the start time: what a new build()
  /// gives, in less time. Inputs keep their values; rows and measurements begin anew. ConfigError
  /// as from build(), and where rows are in files.
  void restart(const Start& start);
  /// The state at a time within the last step, by dense output. Throws std::runtime_error where
  /// there is none.
  const Snapshot& at(double t);
  /// The current state with its measurements, or with the parts that are wanted; at an event that
  /// ended the run, the state there.
  const Snapshot& state(const StateParts& parts = {});
  /// Its time, without the measurements.
  double time();
  /// The tangent from the start to the current state, by the run repeated with its present inputs:
  /// its status is not ok where that does not lead here, since inputs were changed on the way.
  RunTangent tangent();
  /// The events met so far.
  const std::vector<EventMet>& events() const;
  /// Has an event, an observer, or finish() ended it?
  bool over() const;
  const SolverStats& stats() const;
  const Config& config() const;
  const SystemModel& system() const;
  const std::vector<std::string>& notes() const;
  /// Null for a run without inputs.
  const std::shared_ptr<Inputs>& inputs() const;

  /// Ends the run: the last row, the files, the measurements over the rows (without rows those of
  /// start and end). After it the run takes no more steps, and state() and events() stay. Throws
  /// Unfinished where a file cannot be completed, std::logic_error the second time.
  Result finish();

  /// The insides, for the library's own rooms (driver.hpp is not installed).
  const Driver& driver() const;
  Driver& driver();

 private:
  std::unique_ptr<Driver> driver_;
  std::shared_ptr<const Simulation> of_;
};

}  // namespace hamel
