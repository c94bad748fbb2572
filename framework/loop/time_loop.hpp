// What every time loop does, whatever it is compiled for: it counts, and decides what becomes of a step that fails.
#pragma once

#include <hamel/framework/loop/kernel.hpp>

namespace hamel {

class TimeLoop : public Kernel {
 public:
  const SolverStats& stats() const final { return stats_; }

 protected:
  explicit TimeLoop(const KernelSetup& setup) : setup_(setup), h_(setup.step) {}

  /// One step of size h_. A step that fails leaves the state alone.
  virtual SolveReport repeat_step() = 0;
  /// The state, put away and fetched back.
  virtual void save() = 0;
  virtual void restore() = 0;
  /// Nothing to extrapolate, and no Jacobian kept.
  virtual void forget() = 0;

  double time() const { return setup_.from + static_cast<double>(steps_) * h_; }
  void tally(const SolveReport& report) {
    last_ = report;
    ++steps_;
    stats_.iterations += report.iterations;
    stats_.evaluations += report.evaluations;
    if (report.iterations > stats_.iterations_max) stats_.iterations_max = report.iterations;
    if (report.residual > stats_.residual_max) stats_.residual_max = report.residual;
  }
  /// A step has failed, and the state is still that of the last good one: what on_failure asks for.
  SolveReport recover(SolveReport failed);
  Status failure(const SolveReport& report) const;

  KernelSetup setup_;
  double h_;
  SolveReport last_;
  long steps_ = 0;
  SolverStats stats_;

 private:
  SolveReport halve(int level, int& parts);
};

}  // namespace hamel
