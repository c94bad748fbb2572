// What every time loop shares: it counts the steps and rescues those that fail (Config::on_failure). The
// step itself is the derived loop's: CompiledKernel for left-invariant systems (compiled_kernel.hpp),
// GeneralKernel for others (general/kernel.hpp).
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/loop/kernel.hpp>

namespace hamel {

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
