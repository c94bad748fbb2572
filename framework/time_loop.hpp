// What every time loop shares: its set-up, its measurements, and what becomes of a step that fails.
//
// Kernel is what the run-time layer holds: one virtual call per run or per recorded row, none inside a
// step. TimeLoop counts the steps and rescues those that fail; the step itself is the derived loop's:
// CompiledKernel (kernel.hpp) for left-invariant systems, GeneralKernel (general/kernel.hpp) for others.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/solver.hpp>

namespace hamel {

/// What becomes of a step that fails: the run stops there; another solver tries; it is taken as two
/// halves, each of which may be halved again, up to ten times.
enum class OnFailure { stop, retry, halve };

/// Everything a kernel needs to know of a run; matrices are erased here and fixed in the kernel.
struct KernelSetup {
  Eigen::MatrixXd inertia;      // n x n, symmetric positive definite
  Eigen::MatrixXd constraints;  // k x n, rank k
  Eigen::MatrixXd frame;        // n x m, E
  double s = 0.5;
  double step = 0.01;  // h, of either sign
  double tolerance = 1e-13;
  std::vector<double> composition = {1.0};
  std::shared_ptr<Solver> solver;  // null: the solver compiled into the kernel
  OnFailure on_failure = OnFailure::stop;
  std::shared_ptr<Solver> fallback;  // for retry; null as above
  std::string fallback_name;
  std::vector<double> configuration;  // the element's coordinates at t = 0
  Eigen::VectorXd momentum;           // mu_bar at t = 0, m entries
  Eigen::VectorXd velocity;           // xi at t = 0, n entries (general kernels)
};

/// A step that failed and was rescued.
struct Fallback {
  long step = 0;
  double time = 0;  // at its beginning
  std::string action;
};

/// Running totals over the steps taken.
struct SolverStats {
  long iterations = 0;
  long evaluations = 0;
  int iterations_max = 0;  // over one step
  double residual_max = 0;
  long fallbacks = 0;
  std::vector<Fallback> first_fallbacks;  // at most 20
};

/// A state with its measurements.
struct Snapshot {
  long step = 0;
  double time = 0;
  std::vector<double> coordinates;  // of g
  std::vector<double> velocity;     // nodal body velocity, n
  std::vector<double> momentum;     // nodal body momentum, n
  double energy = 0;
  double constraint = 0;    // |A xi/h| of the last step, xi recovered from the configurations
  double holonomic = 0;     // max |phi(g)|
  double group_defect = 0;  // how far g is from the group
  int iterations = 0;       // of the last step, all substeps
  double residual = 0;      // relative, the largest of the last step's substeps
};

class Kernel {
 public:
  virtual ~Kernel() = default;
  /// count steps. On failure the state is that of the last good step.
  virtual Status advance(long count) = 0;
  /// Measures the current state into out (its vectors are reused).
  virtual void measure(Snapshot& out) const = 0;
  virtual const SolverStats& stats() const = 0;
};

/// Derived gives one_step() (on failure the state is as before), save(), restore(state) and forget():
/// nothing to extrapolate, no Jacobian kept.
template <class Derived>
class TimeLoop : public Kernel {
 public:
  Status advance(long count) override {
    for (long k = 0; k < count; ++k) {
      SolveReport report = self().one_step();
      if (!report.ok()) [[unlikely]] {
        report = recover(report);
        if (!report.ok()) return failure(report);
      }
      last_ = report;
      ++steps_;
      stats_.iterations += report.iterations;
      stats_.evaluations += report.evaluations;
      stats_.iterations_max = std::max(stats_.iterations_max, report.iterations);
      stats_.residual_max = std::max(stats_.residual_max, report.residual);
    }
    return {};
  }

  const SolverStats& stats() const override { return stats_; }

 protected:
  explicit TimeLoop(const KernelSetup& setup)
      : h_(setup.step),
        tolerance_(setup.tolerance),
        composition_(setup.composition),
        solver_(setup.solver),
        on_failure_(setup.on_failure),
        fallback_(setup.fallback),
        fallback_name_(setup.fallback_name) {}

  double h_, tolerance_;
  std::vector<double> composition_;
  std::shared_ptr<Solver> solver_;  // null: Newton
  SolveReport last_;
  long steps_ = 0;

 private:
  Derived& self() { return static_cast<Derived&>(*this); }

  // A step has failed, and the state is still that of the last good one: what on_failure asks for.
  [[gnu::noinline, gnu::cold]] SolveReport recover(SolveReport failed) {
    if (on_failure_ == OnFailure::stop) return failed;
    const auto start = self().save();
    const double h = h_;
    if (composition_.size() > 1) self().forget();  // its first substeps are solved a second time
    SolveReport rescued;
    std::string action;
    if (on_failure_ == OnFailure::retry) {
      std::swap(solver_, fallback_);
      rescued = self().one_step();
      std::swap(solver_, fallback_);
      action = "solved by " + fallback_name_;
    } else {
      int parts = 0;
      rescued = halve(1, parts);
      h_ = h;
      self().forget();
      action = "taken in " + std::to_string(parts) + " parts";
    }
    if (!rescued.ok()) self().restore(start);
    else if (++stats_.fallbacks <= 20) {
      stats_.first_fallbacks.push_back({steps_ + 1, static_cast<double>(steps_) * h_, action});
    }
    SolveReport& report = rescued.ok() ? rescued : failed;
    const SolveReport& other = rescued.ok() ? failed : rescued;
    report.iterations += other.iterations;
    report.evaluations += other.evaluations;
    return report;
  }

  // h_ as two steps of half its size, each halved again where it fails.
  SolveReport halve(int level, int& parts) {
    SolveReport total;
    const double half = h_ / 2;
    for (int i = 0; i < 2 && total.ok(); ++i) {
      self().forget();  // of steps of another size
      h_ = half;
      SolveReport part = self().one_step();
      if (part.ok()) ++parts;
      else if (level < 10) {
        const SolveReport finer = halve(level + 1, parts);
        part = {finer.reason, finer.residual, part.iterations + finer.iterations,
                part.evaluations + finer.evaluations};
      }
      total = {part.reason, std::max(total.residual, part.residual),
               total.iterations + part.iterations, total.evaluations + part.evaluations};
    }
    return total;
  }

  Status failure(const SolveReport& report) const {
    std::string reason = to_string(report.reason);
    if (on_failure_ == OnFailure::halve) reason += ", in halved steps too";
    if (on_failure_ == OnFailure::retry) reason += ", and " + fallback_name_ + " failed too";
    return {false, steps_ + 1, static_cast<double>(steps_) * h_, report.residual, reason};
  }

  OnFailure on_failure_;
  std::shared_ptr<Solver> fallback_;
  std::string fallback_name_;
  SolverStats stats_;
};

}  // namespace hamel
