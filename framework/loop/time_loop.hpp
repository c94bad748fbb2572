// What every time loop does, whatever it is compiled for: it counts, and decides what becomes of a step that fails.
#pragma once

#include <cmath>
#include <limits>

#include <hamel/framework/loop/kernel.hpp>

namespace hamel {

class TimeLoop : public Kernel {
 public:
  const SolverStats& stats() const final { return stats_; }
  void limit(double t) final { limit_ = t; }
  double next_step() const final { return h_; }

 protected:
  explicit TimeLoop(const KernelSetup& setup)
      : setup_(setup), h_(setup.step), from_(setup.from), time_(setup.from) {}

  /// One step of size h_. A step that fails leaves the state alone.
  virtual SolveReport repeat_step() = 0;
  /// The state, put away and fetched back.
  virtual void save() = 0;
  virtual void restore() = 0;

  bool chooses_steps() const { return setup_.relative > 0 || setup_.absolute > 0; }
  double time() const {
    return chooses_steps() ? time_ : from_ + static_cast<double>(steps_ - first_) * h_;
  }
  /// Where the next step ends at the latest: at the limit, or where an input jumps or bends.
  double end_of_step(double t) const {
    if (setup_.inputs == nullptr) [[likely]]
      return limit_;
    const double next = setup_.inputs->next_break(t, h_);
    return (h_ > 0) == (next < limit_) ? next : limit_;
  }
  /// Above it a chosen step is worth trying.
  double smallest_step(double t) const {
    const double span = std::isfinite(limit_) ? limit_ - from_ : std::fmax(t - from_, setup_.step);
    return 1e-14 * std::abs(span);
  }
  /// Steps count from here.
  void count_from(double t) {
    from_ = time_ = t;
    first_ = steps_;
  }
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
  double limit_ = std::copysign(std::numeric_limits<double>::infinity(), h_);
  double from_, time_;  // where steps were first counted; of the last node
  long first_ = 0;
  long inputs_changed_ = 0;  // seen
  SolveReport last_;
  long steps_ = 0;
  SolverStats stats_;

 private:
  SolveReport halve(int level, int& parts);
};

}  // namespace hamel
