// The builder: from a system and a few names to a run.
//
//   auto result = hamel::simulate("suslov").set("inertia", {1, 10, 100}).start({.momentum = {1, 1, 0}})
//                     .scheme("lift").s(0.5).retraction("cayley").step(0.01).until(1800).run();
//
// run() and build() check everything first and throw one ConfigError with all mistakes; after that a numerical failure
// is result.status, and the good steps are kept. What a full disk ends throws Unfinished, and its file keeps the rows.
#pragma once

#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <hamel/framework/run/names/config.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/record/result.hpp>
#include <hamel/framework/run/run/dense_output.hpp>

namespace hamel {

struct SolverOptions {
  double tolerance = Config().tolerance;  // on |F| / scale
};

/// Of the error of a step (framework/schemes/munthe_kaas.hpp), each in (0, 1). Without an absolute one both are the same.
struct StepTolerance {
  std::optional<double> relative = {}, absolute = {};
};

/// The state at an event, for an impact to change; the velocity is then projected onto the constraints.
struct EventState {
  double time;
  std::vector<double> coordinates, velocity;
};
using Impact = std::function<void(EventState&)>;

/// A run that is stepped by hand.
class Integration {
 public:
  /// Projects a start and puts it into the setup; the start as it is then.
  using Begin = std::function<Start(const Start&, KernelSetup&)>;
  Integration(KernelFactory factory, KernelSetup setup, Config config, SystemModel system,
              std::vector<std::string> notes, Begin begin);
  /// One step (or count of them); the status of the first that failed.
  Status step(long count = 1);
  /// One step; a chosen one ends at t at the latest.
  Status step_towards(double t);
  /// Time runs the other way from here; steps chosen by the reversible control are taken back as they came.
  void turn_back() { kernel_->turn_back(); }
  /// Steps to time t: chosen ones end there, others at the node nearest to it.
  Status advance_to(double t);
  /// An input from now on, in the unit that the system states; the builder must have given the run a first value of some
  /// input. ConfigError where there is no such input, or the value is out of its range.
  void input(const std::string& name, double value);
  /// Again from another start (projected as by the builder), at the start time: what a new build() gives, in less time.
  /// Inputs keep their values. ConfigError as from build().
  void restart(const Start& start);
  /// The state at a time within the last step, by dense output. Throws std::runtime_error where there is none.
  const Snapshot& at(double t);
  /// The current state with its measurements.
  const Snapshot& state();
  const SolverStats& stats() const { return kernel_->stats(); }
  const Config& config() const { return config_; }
  const SystemModel& system() const { return system_; }
  const std::vector<std::string>& notes() const { return notes_; }
  /// Null for a run without inputs.
  const std::shared_ptr<Inputs>& inputs() const { return setup_.inputs; }

 private:
  // Not ok where a table of an input ends before t.
  Status covered(double t);
  Status behind(double t);

  KernelFactory factory_;
  KernelSetup setup_;
  Begin begin_;
  std::unique_ptr<Kernel> kernel_;
  std::unique_ptr<DenseOutput> dense_;
  Config config_;
  SystemModel system_;
  std::vector<std::string> notes_;
  Snapshot state_;
};

class Simulation {
 public:
  using Maker = std::function<SystemModel(const Parameters&)>;
  /// A registered system; the name is looked up when the run is built.
  Simulation(const Registry& registry, std::string system);
  /// A system object; make sets its parameters.
  Simulation(const Registry& registry, std::string name, Maker make);

  /// A parameter by its field name. Units as the field states them.
  Simulation& set(const std::string& name, std::vector<double> value) {
    config_.parameters[name] = std::move(value);
    return *this;
  }
  Simulation& set(const std::string& name, std::initializer_list<double> value) {
    return set(name, std::vector<double>(value));
  }
  Simulation& set(const std::string& name, double value) { return set(name, {value}); }
  /// An input of the system: a constant, or InputTable{times, values, hold}, or InputFile{"table.csv"}. A run that is
  /// driven by Integration::input says so by a first value.
  Simulation& input(const std::string& name, double value) {
    return input(name, InputSignal(value));
  }
  Simulation& input(const std::string& name, InputSignal signal) {
    config_.inputs[name] = std::move(signal);
    return *this;
  }
  /// Where to start. Velocity and momentum are projected onto d and d*, and a note says what was lost.
  Simulation& start(Start start) { return with(&Config::start, std::move(start)); }
  /// The start in its place: straight ahead at v m/s, upright, of systems that know such a motion.
  Simulation& speed(double v) { return with(&Config::speed, v); }
  /// Any option (Config::fields); below those that have a name of their own.
  template <class Value>
  Simulation& with(Value Config::*option, std::type_identity_t<Value> value) {
    config_.*option = std::move(value);
    return *this;
  }
  Simulation& scheme(std::string name) { return with(&Config::scheme, std::move(name)); }
  /// The discretisation parameter, in [0, 1].
  Simulation& s(double value) { return with(&Config::s, value); }
  Simulation& retraction(std::string name) { return with(&Config::retraction, std::move(name)); }
  Simulation& solver(std::string name, SolverOptions options = {}) {
    return with(&Config::solver, std::move(name)).with(&Config::tolerance, options.tolerance);
  }
  /// What becomes of a step that fails: "stop" (default), "retry:<solver>" (solved again by another),
  /// "halve" (taken as two halves, each of which may be halved again).
  Simulation& on_failure(std::string policy) {
    return with(&Config::on_failure, std::move(policy));
  }
  /// A composition table by name: none, yoshida4, suzuki4, ...
  Simulation& compose(std::string name) { return with(&Config::compose, std::move(name)); }
  /// The step h in seconds, of either sign.
  Simulation& step(double h) { return with(&Config::step, h); }
  /// Steps chosen by the error; h is then the first one. Explicit pairs (dopri5, tsit5, dop853), and lift and balance at
  /// s = 1/2 by a reversible control.
  Simulation& tolerance(StepTolerance tolerance) {
    return with(&Config::rtol, tolerance.relative).with(&Config::atol, tolerance.absolute);
  }
  /// The start time in seconds.
  Simulation& from(double t) { return with(&Config::from, t); }
  /// The end time in seconds, beyond the start in the direction of h.
  Simulation& until(double t) { return with(&Config::until, t); }
  /// Record every this many steps (the first and the last state always).
  Simulation& every(long steps) { return with(&Config::every, steps); }
  /// Rows at these times, or this distance in time, by dense output, instead of nodes.
  Simulation& output(std::vector<double> times) {
    return with(&Config::output_times, std::move(times));
  }
  Simulation& output(double step) { return with(&Config::output_step, step); }
  /// Events to locate and record: the system's own by name, or "column=value".
  Simulation& events(std::vector<std::string> names) {
    return with(&Config::events, std::move(names));
  }
  /// Ends the run at the first of these.
  Simulation& stop_at(std::vector<std::string> names) {
    return with(&Config::stop_at, std::move(names));
  }
  /// Locates an event, and lets the caller change the state there; also in the two finer runs of a check.
  Simulation& on_event(const std::string& name, Impact impact) {
    config_.events.push_back(name);
    impacts_[name] = std::move(impact);
    return *this;
  }
  /// Everything at once; system and parameters too.
  Simulation& config(Config config) {
    config_ = std::move(config);
    return *this;
  }
  /// Called with each recorded state; returning false stops the run there.
  Simulation& observe(std::function<bool(const Snapshot&)> observer) {
    observer_ = std::move(observer);
    return *this;
  }
  /// Rows are written as they come, to a file by its extension, output_formats(), or "-" (CSV to standard output); repeatable.
  /// The file is `path`.part until the run is done, whatever ends it. Then the Result has no trajectory.
  Simulation& record_to(std::string path) {
    records_.push_back(std::move(path));
    return *this;
  }
  /// A trajectory of about so many rows beside the files: every second row is dropped, again and again.
  Simulation& keep_rows(size_t most) {
    rows_kept_ = most;
    return *this;
  }
  /// Goes on with the unfinished run in a file, .h5, that this run was recorded to; the result is that of the undisturbed run.
  Simulation& resume(std::string path) {
    resumed_ = std::move(path);
    return *this;
  }
  /// Called now and then with the fraction done, in [0, 1].
  Simulation& progress(std::function<void(double)> report) {
    progress_ = std::move(report);
    return *this;
  }
  /// A kernel compiled for the user's own types, in place of the registered one; and one for the same with inputs.
  Simulation& kernel(KernelFactory factory, SchemeInfo scheme, RetractionInfo retraction,
                     KernelFactory driven = {});

  const Config& config() const { return config_; }
  /// Everything that is wrong; empty when run() can start.
  std::vector<std::string> mistakes() const;
  /// Throws ConfigError with all mistakes.
  Integration build() const;
  /// Throws ConfigError with all mistakes, before the first step.
  Result run() const;

 private:
  friend class RunLoop;
  struct Plan;
  Plan plan() const;
  void estimate_error(Result& result) const;
  void add_outputs(Plan& plan) const;

  const Registry* registry_;
  Maker make_;
  Config config_;
  KernelFactory kernel_, driven_kernel_;
  SchemeInfo kernel_scheme_;
  RetractionInfo kernel_retraction_;
  std::function<bool(const Snapshot&)> observer_;
  std::function<void(double)> progress_;
  std::map<std::string, Impact> impacts_;
  std::vector<std::string> records_;
  std::optional<size_t> rows_kept_;
  std::string resumed_;
};

}  // namespace hamel
