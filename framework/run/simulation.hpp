// The builder: from a system and a few names to a run.
//
//   auto result = hamel::simulate("suslov").set("inertia", {1, 10, 100}).start({.momentum = {1, 1, 0}})
//                     .scheme("lift").s(0.5).retraction("cayley").step(0.01).until(1800).run();
//
// run() and build() check everything first and throw one ConfigError with all mistakes; after that
// nothing throws: a numerical failure is result.status, and the good steps are kept.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <hamel/framework/run/config.hpp>
#include <hamel/framework/run/registry.hpp>
#include <hamel/framework/run/result.hpp>

namespace hamel {

struct SolverOptions {
  double tolerance = Config().tolerance;  // on |F| / scale
};

/// A run that is stepped by hand.
class Integration {
 public:
  Integration(std::unique_ptr<Kernel> kernel, Config config, SystemModel system,
              std::vector<std::string> notes);
  /// One step (or count of them); the status of the first that failed.
  Status step(long count = 1) { return kernel_->advance(count); }
  /// The current state with its measurements.
  const Snapshot& state();
  const SolverStats& stats() const { return kernel_->stats(); }
  const Config& config() const { return config_; }
  const SystemModel& system() const { return system_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::unique_ptr<Kernel> kernel_;
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
  /// Where to start. Velocity and momentum are projected onto d and d*, and a note says what was lost.
  Simulation& start(Start start) { return with(&Config::start, std::move(start)); }
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
  /// The start time in seconds.
  Simulation& from(double t) { return with(&Config::from, t); }
  /// The end time in seconds, beyond the start in the direction of h.
  Simulation& until(double t) { return with(&Config::until, t); }
  /// Record every this many steps (the first and the last state always).
  Simulation& every(long steps) { return with(&Config::every, steps); }
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
  /// Called now and then with the fraction done, in [0, 1].
  Simulation& progress(std::function<void(double)> report) {
    progress_ = std::move(report);
    return *this;
  }
  /// A kernel compiled for the user's own types, in place of the registered one.
  Simulation& kernel(KernelFactory factory, SchemeInfo scheme, RetractionInfo retraction);

  const Config& config() const { return config_; }
  /// Everything that is wrong; empty when run() can start.
  std::vector<std::string> mistakes() const;
  /// Throws ConfigError with all mistakes.
  Integration build() const;
  /// Throws ConfigError with all mistakes, before the first step.
  Result run() const;

 private:
  struct Plan;
  Plan plan() const;
  void estimate_error(Result& result) const;

  const Registry* registry_;
  Maker make_;
  Config config_;
  KernelFactory kernel_;
  SchemeInfo kernel_scheme_;
  RetractionInfo kernel_retraction_;
  std::function<bool(const Snapshot&)> observer_;
  std::function<void(double)> progress_;
};

}  // namespace hamel
