// The builder: from a system and names to a run.
//
//   auto result = hamel::simulate("suslov")
//                     .set("inertia", {1, 10, 100}).start({.momentum = {1, 1, 0}})
//                     .scheme("lift").s(0.5).retraction("cayley").step(0.01).until(1800).run();
//
// run() and build() check everything first and throw one ConfigError with all mistakes; after that
// a numerical failure is result.status, and the good steps are kept. A full disk throws Unfinished;
// the rows written so far stay in the file. Standard-library types only: a program that includes
// this cannot disagree with the library about its flags.
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

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/run/names/config.hpp>
#include <hamel/framework/run/record/result.hpp>
#include <hamel/framework/run/run/run.hpp>

namespace hamel {

class Registry;
struct Gradient;   // framework/tangent/sensitivities.hpp, as Sensitivities
struct OwnSystem;  // own_system.hpp
struct Sensitivities;

struct SolverOptions {
  double tolerance = Config().tolerance;  // on |F| / scale
};

/// Tolerances of a step's error (framework/schemes/munthe_kaas.hpp), each in (0, 1). Without an
/// absolute one both are the same.
struct StepTolerance {
  std::optional<double> relative = {}, absolute = {};
};

/// The state at an event, for an impact to change; the velocity is then projected onto the
/// constraints.
struct EventState {
  double time;
  std::vector<double> coordinates, velocity;
};
using Impact = std::function<void(EventState&)>;

/// The request of a builder.
struct RunRequest {
  Config config;
  std::map<std::string, Impact> impacts;
  std::function<bool(const Snapshot&)> observer;
  std::function<void(double)> progress;
  std::vector<std::string> records;
  std::optional<size_t> rows_kept;
  std::string resumed;
  bool to_be_read = false;  // the result: Result::read
};

class HAMEL_API Simulation {
 public:
  /// A registered system; the name is looked up when the run is built.
  Simulation(const Registry& registry, std::string system);
  /// A system of the program's own.
  Simulation(const Registry& registry, std::string name, OwnSystem own);
  Simulation(const Simulation&);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(const Simulation&);
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// A parameter by its field name. Units as the field states them.
  Simulation& set(const std::string& name, std::vector<double> value);
  Simulation& set(const std::string& name, std::initializer_list<double> value) {
    return set(name, std::vector<double>(value));
  }
  Simulation& set(const std::string& name, double value) { return set(name, {value}); }
  /// An input of the system: a constant, or InputTable{times, values, hold}, or
  /// InputFile{"table.csv"}. A run that is driven by Run::input needs a first value of some input.
  Simulation& input(const std::string& name, double value);
  Simulation& input(const std::string& name, InputSignal signal);
  /// The start. Velocity and momentum are projected onto d and d*, and a note states what was
  /// lost.
  Simulation& start(Start start) { return with(&Config::start, std::move(start)); }
  /// A coordinate or velocity of the start by name; the others are as usual. Also beside speed().
  Simulation& start(const std::string& name, double value);
  /// The start in its place: straight ahead at v m/s, upright, of systems that define a straight
  /// motion.
  Simulation& speed(double v) { return with(&Config::speed, v); }
  /// The start may slip: it is not projected onto the rows of contacts that may slide.
  Simulation& slip(bool slips = true) { return with(&Config::slip, slips); }
  /// Any option (Config::fields); below those that have a separate member.
  template <class Value>
  Simulation& with(Value Config::*option, std::type_identity_t<Value> value) {
    request_.config.*option = std::move(value);
    return *this;
  }
  Simulation& scheme(std::string name) { return with(&Config::scheme, std::move(name)); }
  /// The discretisation parameter, in [0, 1].
  Simulation& s(double value) { return with(&Config::s, value); }
  Simulation& retraction(std::string name) { return with(&Config::retraction, std::move(name)); }
  Simulation& solver(std::string name, SolverOptions options = {}) {
    return with(&Config::solver, std::move(name)).with(&Config::tolerance, options.tolerance);
  }
  /// Policy for a step that fails: "stop" (default), "retry:<solver>" (solved again by
  /// another), "halve" (taken as two halves, each of which may be halved again).
  Simulation& on_failure(std::string policy) {
    return with(&Config::on_failure, std::move(policy));
  }
  /// A composition table by name: none, yoshida4, suzuki4, ...
  Simulation& compose(std::string name) { return with(&Config::compose, std::move(name)); }
  /// The step h in seconds, of either sign.
  Simulation& step(double h) { return with(&Config::step, h); }
  /// Steps chosen by the error; h is then the first one. Explicit pairs (dopri5, tsit5, dop853),
  /// and lift and balance at s = 1/2 by a reversible control.
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
  /// Locates an event, and lets the caller change the state there; also in the two finer runs of a
  /// check.
  Simulation& on_event(const std::string& name, Impact impact);
  /// Everything at once; system and parameters too.
  Simulation& config(Config config);
  /// Called with each recorded state; returning false stops the run there.
  Simulation& observe(std::function<bool(const Snapshot&)> observer) {
    request_.observer = std::move(observer);
    return *this;
  }
  /// Rows are written as they come, to a file by its extension, output_formats(), or "-" (CSV to
  /// standard output); repeatable. The file is `path`.part until the run is done, whatever ends it.
  /// Then the Result has no trajectory.
  Simulation& record_to(std::string path);
  /// A trajectory of about so many rows beside the files: every second row is dropped, again and
  /// again.
  Simulation& keep_rows(size_t most) {
    request_.rows_kept = most;
    return *this;
  }
  /// Resumes the unfinished run in a file, .h5, that this run was recorded to; the result is
  /// that of the undisturbed run.
  Simulation& resume(std::string path) {
    request_.resumed = std::move(path);
    return *this;
  }
  /// Called now and then with the fraction done, in [0, 1].
  Simulation& progress(std::function<void(double)> report) {
    request_.progress = std::move(report);
    return *this;
  }

  const Config& config() const { return request_.config; }
  /// Everything that is wrong; empty when run() can start.
  std::vector<std::string> mistakes() const;
  /// The system, its parameters set, without a run of it. Throws ConfigError as run() does.
  std::shared_ptr<const SystemModel> system() const;
  /// A run to be stepped by hand. Throws ConfigError with all mistakes.
  Run build() const;
  /// Steps to the end: a loop over Run. Throws ConfigError with all mistakes, before the first
  /// step.
  Result run() const;
  /// The same, but trajectory, measurements and their notes are computed by Result::read(): until
  /// then a row is (t, g, xi) where no function, file, event, input or work needs more of it.
  Result run_unread() const;
  /// Derivatives along the run by parameters ("mass", "inertia2"), constant inputs and the start
  /// ("start.omega"). ConfigError names the nearest.
  Sensitivities sensitivities(const std::vector<std::string>& names) const;
  /// Derivative of a quantity at the end, a column of the run or a formula of columns and
  /// parameters ("x^2 + y^2"), by these.
  Gradient gradient(const std::string& objective, const std::vector<std::string>& names) const;
  /// Its motion without rows, files, and functions that watch it.
  Simulation unobserved() const;

 private:
  const Registry* registry_;
  std::shared_ptr<const OwnSystem> own_;  // null for a registered system
  RunRequest request_;
};

}  // namespace hamel
