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
#include <utility>
#include <vector>

#include <hamel/framework/run/config.hpp>
#include <hamel/framework/run/registry.hpp>
#include <hamel/framework/run/result.hpp>

namespace hamel {

struct SolverOptions {
  double tolerance = 1e-13;  // on |F| / scale
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
  Simulation& set(const std::string& name, std::vector<double> value);
  Simulation& set(const std::string& name, std::initializer_list<double> value);
  Simulation& set(const std::string& name, double value);
  /// Where to start. Velocity and momentum are projected onto d and d*, and a note says what was lost.
  Simulation& start(Start start);
  Simulation& scheme(std::string name);
  /// The discretisation parameter, in [0, 1].
  Simulation& s(double value);
  Simulation& retraction(std::string name);
  Simulation& solver(std::string name, SolverOptions options = {});
  /// What becomes of a step that fails: "stop" (default), "retry:<solver>" (solved again by another),
  /// "halve" (taken as two halves, each of which may be halved again).
  Simulation& on_failure(std::string policy);
  /// A composition table by name: none, yoshida4, suzuki4, ...
  Simulation& compose(std::string name);
  /// The step h in seconds, of either sign.
  Simulation& step(double h);
  /// The end time in seconds, of the sign of h.
  Simulation& until(double t);
  /// Record every this many steps (the first and the last state always).
  Simulation& every(long steps);
  /// Everything at once; system and parameters too.
  Simulation& config(Config config);
  /// Called with each recorded state; returning false stops the run there.
  Simulation& observe(std::function<bool(const Snapshot&)> observer);
  /// Called now and then with the fraction done, in [0, 1].
  Simulation& progress(std::function<void(double)> report);
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
