// The principal root of a step's equation.
//
// Far from the identity the equation of a step can have roots that have nothing to do with the
// motion, inside the domain of tau too. The principal root is where the solution y of F(y; lambda
// h) = 0 arrives that begins at lambda = 0. Following the path costs some thirty solves, at most
// kMostOnPath.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>

#include <hamel/framework/loop/step_equation.hpp>

namespace hamel {

/// A step that can be begun anew with another size.
template <class Unknown>
struct StepOnPath {
  const StepEquation<Unknown>& equation;
  std::function<void(double h)> begin;
  std::function<void(Unknown& x)> guess;
};

template <class Unknown, class Newton>
class PrincipalRoot {
 public:
  /// sample: of the size of all unknowns.
  explicit PrincipalRoot(const Unknown& sample) : end_(sample), trial_(sample), memory_(sample) {}

  /// Two solutions that move nothing by more than 1e-11 (rad, m) in the step are one: at rest all
  /// that there is of a solution is round-off, on the path a thousand times larger. As a velocity,
  /// squared.
  static double square_of_round_off(double h) { return 1e-22 / (h * h); }

  /// Is x, a solution for h, where the path from lambda = 0 arrives? Leaves the step begun with h.
  [[gnu::noinline, gnu::cold]] bool leads_to(const Unknown& x, const StepOnPath<Unknown>& step,
                                             double h) {
    const double size = x.squaredNorm(),
                 small = 1e-20 * step.equation.scale_squared() + square_of_round_off(h);
    follow(step, h, size + small);
    step.begin(h);
    if ((x - end_).squaredNorm() <= 1e-10 * size + small) return true;
    // An ill-conditioned equation (masses of 1 and 1e6, the row of a height at h = 1e-6) has at
    // one root many solutions to within round-off: between two of them F stays small, between
    // two roots it does not.
    trial_ = 0.5 * (x + end_);
    step.equation.residual(trial_, memory_.f);
    return memory_.f.squaredNorm() <= 1e-16 * step.equation.scale_squared();
  }

 private:
  // A step from rest is so small on the path that the round-off of its rows (of lengths) is above
  // the tolerance, which is relative to its size: the path needs no more than to be distinguished
  // from others.
  static bool near(const SolveReport& report) {
    return report.ok() || (report.reason == Reason::stagnated && report.residual <= 1e-5);
  }
  static constexpr int kMostOnPath = 200;
  // To end_: the solution for lambda h at lambda = 1, by steps that move it by 3 percent at most,
  // or the place by a thousandth; NaN where the path ends before or takes over kMostOnPath solves.
  // It starts where there is one root, which is not always next to the scheme's guess.
  void follow(const StepOnPath<Unknown>& step, double h, double size) {
    // A tenth of what two solutions of one root may differ by.
    constexpr double tolerance = 1e-9;
    constexpr double lost = std::numeric_limits<double>::quiet_NaN();
    double at = 1e-3;
    for (;; at *= 10) {
      step.begin(at * h);
      step.guess(end_);
      memory_.clear_history();
      const SolveReport report = Newton::solve(step.equation, end_, tolerance, memory_);
      if (near(report)) break;
      if (report.reason != Reason::stagnated || at > 0.05) end_.setConstant(lost);
      if (!end_.allFinite()) break;
    }
    double length = 0.1;
    for (int solves = 1; at < 1 && end_.allFinite(); ++solves) {
      const double next = std::min(at + length, 1.0);
      step.begin(next * h);
      trial_ = end_;
      const SolveReport report = Newton::solve(step.equation, trial_, tolerance, memory_);
      // Or by a thousandth of a radian or metre in a step of that size: roots lie farther apart.
      // Where a motion turns, x is next to nothing at lambda = 1, but not on the path.
      const double near_by = 1e-3 / (next * h);
      const double most = std::max(1e-3 * size, near_by * near_by);
      if (near(report) && (trial_ - end_).squaredNorm() <= most) {
        end_ = trial_;
        at = next;
        length *= 1.5;
      } else {
        length /= 2;
        if (length < 1e-4 || solves >= kMostOnPath) end_.setConstant(lost);
      }
    }
  }

  Unknown end_, trial_;
  typename Newton::template Memory<Unknown> memory_;
};

}  // namespace hamel
