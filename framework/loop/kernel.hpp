// Interface of the run-time layer to a compiled time loop: one virtual call per run or per recorded
// row, none inside a step. The loop itself is loop.hpp.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/loop/snapshot.hpp>
#include <hamel/framework/loop/solver.hpp>
#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/schemes/error_scale.hpp>
#include <hamel/framework/schemes/scheme.hpp>
#include <hamel/framework/schemes/tableau.hpp>

namespace hamel {

/// Policy for a step that fails: the run stops there; another solver tries; it is taken as two
/// halves, each of which may be halved again, up to ten times.
enum class OnFailure { stop, retry, halve };

/// A state that a motion goes on at is near: the node, or the beginning of the last step, which is
/// taken again.
enum class Nearby { node, step };

/// Everything that a kernel needs of a run; types are erased here and fixed in the kernel.
struct KernelSetup {
  std::shared_ptr<const Geometry> geometry;    // null: not registered, and the kernel has its own
  std::shared_ptr<const Mechanics> mechanics;  // with its parameters
  std::shared_ptr<Inputs> inputs;              // that drive it; null where there are none
  double s = 0.5;
  double step = 0.01;  // h, of either sign
  double tolerance = 1e-13;
  std::vector<double> composition = {1.0};
  std::shared_ptr<Solver> solver;  // null: the solver compiled into the kernel
  OnFailure on_failure = OnFailure::stop;
  std::shared_ptr<Solver> fallback;  // for retry; null as above
  std::string fallback_name;
  const Tableau* tableau = nullptr;  // of explicit schemes that are given by one
  ErrorScale errors;                 // that choose the steps; 0: all of size step
  bool first_chosen = false;         // the first too
  double largest = std::numeric_limits<double>::infinity();  // of chosen steps
  int order = 0;                                             // the scheme's, with its composition
  ForceAt force_at = ForceAt::nodes;                         // lift
  double from = 0;                                           // the time of the start
  std::vector<double> configuration;                         // the element's coordinates there
  std::vector<double> velocity;                              // xi there, n entries, admissible
};

class Kernel {
 public:
  Kernel() = default;
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;
  virtual ~Kernel() = default;
  /// count steps, from node to node. On failure the state is that of the last good step. A step of
  /// one size within which an input jumps or bends ends there, and the next one where it would have
  /// ended.
  virtual Status advance(long count) = 0;
  /// Steps taken, the parts of one counted as one; is the node such a jump or kink?
  virtual long whole_steps() const = 0;
  virtual bool off_grid() const = 0;
  /// The current state (the vectors of out are reused).
  virtual void state(Snapshot& out, const StateParts& parts) const = 0;
  /// Measured.
  void measure(Snapshot& out) const { state(out, {}); }
  /// Alone.
  void state(Snapshot& out) const { state(out, {.measures = false}); }
  /// Without the coordinates too.
  void bare_state(Snapshot& out) const { state(out, {.coordinates = false, .measures = false}); }
  virtual const SolverStats& stats() const = 0;
  /// From now on appends each state that comes after log->every steps to a log (0: none):
  /// advance() ends at one with a flaw. False, and nothing is done, where a kernel keeps none;
  /// within: states within steps too.
  virtual bool log_to(StateLog* /*log*/, bool /*within*/) { return false; }
  /// Appends the current state, or one within the last step by the scheme's own dense output, as
  /// of time t; false where it has none there.
  virtual bool log_state(double /*t*/) { return false; }
  /// A state of such a log, of a kernel for the same problem; this one's own state is lost.
  virtual void measure(std::span<const double> /*logged*/, Snapshot& /*out*/,
                       const StateParts& /*parts*/) {}

  /// The node itself, and that at the beginning of the last step: time, coordinates, and the
  /// velocity that is carried.
  virtual void node(Snapshot& out) const = 0;
  virtual void beginning(Snapshot& out) const = 0;
  /// The times of both.
  virtual double time() const = 0;
  virtual double beginning_time() const = 0;
  /// Steps that are chosen end at t at the latest, and advance() does nothing there. One of steps
  /// of one size that ends at t is not moved to a jump of an input next to it.
  virtual void set_end_time(double t) = 0;
  /// The size of the step that comes next (chosen ones before they are cut at the limit).
  virtual double next_step() const = 0;
  /// Time runs the other way: h changes its sign, and steps that are chosen are taken back as they
  /// came.
  virtual void turn_back() = 0;
  /// Continues at another state; step: size of the next. Throws std::invalid_argument when the
  /// values are no element.
  virtual void restart(double t, std::span<const double> coordinates,
                       std::span<const double> velocity, double step) = 0;
  /// Continues, with the size of steps that it has, at a state near such a one: solves begin where
  /// those before have ended. A root that is not within a percent of these, and one that is not
  /// found from them, is looked for as after restart(). Throws as that does.
  virtual void restart_near(Nearby /*to*/, double t, std::span<const double> coordinates,
                            std::span<const double> velocity) {
    restart(t, coordinates, velocity, next_step());
  }
  /// A new kernel for the same problem, set up with its constants: setup differs from this one's in
  /// the start and in step alone. Null where there are none worth keeping.
  virtual std::unique_ptr<Kernel> another(const KernelSetup& /*setup*/) const { return nullptr; }
  /// Drops what is remembered of forces: after a change of something that they depend on.
  virtual void clear_history() = 0;
  /// The state at a time within the last step, by the scheme's own dense output; false where it has
  /// none.
  virtual bool interpolate(double t, Snapshot& out) = 0;
  /// Time, element and velocity alone at such a time, not moved
  /// onto the constraints: off them by about the error of a step, for integrals along it.
  virtual bool motion_within(double t, Snapshot& out) = 0;
};

}  // namespace hamel
