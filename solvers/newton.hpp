// newton: Newton's method with the Jacobian kept while it contracts well, also from step to step.
//
//   x <- x - J^-1 F(x),   accepted when |F(x)| <= tolerance * scale, F evaluated at the x returned.
// Along a trajectory J changes by O(h) a step and the extrapolated guess is good, so that one
// correction with the last J usually suffices. J is evaluated anew when a correction does not cut
// |F| by ten, and for the next step when more than one correction was needed (by two, more than 2 +
// 2 n/5, where J is made of differences). A fresh correction that does not reduce |F| is halved, up
// to ten times. At least one correction is made: a guess already within the tolerance would
// leave its extrapolation error, always of one sign, in every step. A residual that stops falling
// is accepted at the round-off floor (64 eps), else the solve has stagnated. The iteration aims two
// digits below the tolerance, so that the error left by a kept Jacobian does not add up over the
// steps. Where a fresh J no longer halves a residual within the tolerance, that is its floor: no J
// is made to go below it.
// Many unknowns whose J is made of differences begin with J = 1, what the frame of a step makes of
// it for h -> 0 (M39): it costs nothing, does not grow old as the frame turns, and is given up
// where its second correction does not halve |F| either (J = 1 + N, N^2 small: the rows act on the
// momenta, not they on the rows) or a solve needs many. The J that is then made is kept at least
// until its corrections have cost as much; where it needs more than three a step, 1 is tried again.
// Compiled into the kernels: fixed sizes, no heap, no virtual call. Source: Kelley, Solving
// Nonlinear Equations with Newton's Method, SIAM 2003, ch. 1-2.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <hamel/framework/loop/step_equation.hpp>
#include <hamel/solvers/inverse.hpp>

namespace hamel {

struct Newton {
  static constexpr int max_iterations = 50;
  static std::string name() { return "newton"; }
  static std::string summary() {
    return "Newton with the Jacobian kept while it contracts, compiled into the kernels";
  }
  static std::string method() {
    return "x <- x - J^-1 F(x), halved where a fresh J does not reduce |F|";
  }
  static std::string stops() {
    return "the residual at two digits below the tolerance, or where it stops falling; 50 "
           "iterations";
  }
  static std::string source() { return "Kelley 2003"; }

  /// The factors of the last Jacobian, kept from one step of a run to the next, and the work space
  /// of a solve.
  template <class Unknown>
  struct Memory {
    using Jacobian = typename StepEquation<Unknown>::Jacobian;
    Jacobian jacobian;
    Inverse<Jacobian> factors;
    Unknown f, correction, trial, trial_f;
    Differences<Unknown> differences;
    bool valid = false;
    double floor;  // of |F|^2, relative: below it no J is made
    int wait = 0;  // so many corrections until J = 1 is tried

    Memory() requires(Unknown::RowsAtCompileTime >= 0) : Memory(Unknown(Unknown::Zero())) {}
    /// sample: an x. After this no solve takes memory.
    explicit Memory(const Unknown& sample)
        : f(sample),
          correction(sample),
          trial(sample),
          trial_f(sample),
          floor(floor_of(sample.size())) {
      jacobian.setIdentity(sample.size(), sample.size());
      if (sample.size() > 0 && !factors.is_large(sample.size())) factors.compute(jacobian);
      differences = {sample, sample, sample};
    }
    /// Forgets all solves.
    void clear_history() {
      valid = false;
      factors.set_one();
      floor = floor_of(f.size());
      wait = 0;
    }
  };

  /// The target for n unknowns: two digits below the tolerance, at most to the round-off of a
  /// residual, which grows with their number. A kept Jacobian leaves an error of one sign, which
  /// must not add up over the steps.
  static constexpr double aim(double tolerance, Eigen::Index n = 1) {
    constexpr double eps = std::numeric_limits<double>::epsilon();
    return std::max({0.01 * tolerance, 8 * eps, 0.5 * static_cast<double>(n) * eps});
  }

  /// step: schemes/scheme.hpp. x: guess in, best point out. The report is written where it is
  /// wanted: a copy costs a tenth of a small step.
  template <class Step>
  [[gnu::always_inline]] static inline void solve(const Step& step, typename Step::Unknown& x,
                                                  double tolerance,
                                                  Memory<typename Step::Unknown>& memory,
                                                  SolveReport& report) {
    const double given = step.scale_squared(), scale = given > 0 ? given : 1.0;
    int corrections = 0, evaluations = 0;
    if (memory.valid) [[likely]] {  // one correction with the last Jacobian: nearly every step
      step.residual(x, memory.f);
      [[maybe_unused]] const double before = HasJacobian<Step> ? 0 : memory.f.squaredNorm();
      memory.factors.solve(memory.f, memory.correction);
      if constexpr (HasFrame<Step>) step.expand(memory.correction);
      memory.trial = x - memory.correction;
      step.residual(memory.trial, memory.trial_f);
      const double size = memory.trial_f.squaredNorm(), target = aim(tolerance, x.size());
      const double aimed = target * target * scale;
      if (size <= aimed) [[likely]] {
        if constexpr (!HasJacobian<Step>) {
          if (worth_learning(before, size, aimed, scale)) [[unlikely]]
            learn(memory);
        }
        x = memory.trial;
        report = {Reason::converged, std::sqrt(size / scale), 1, 2};
        return;
      }
      evaluations = 2;
      memory.valid =
          !HasJacobian<Step> && (worth_keeping(false, before, size, memory.floor * scale) ||
                                 (memory.factors.is_one() && size <= 4 * before));
      if (memory.valid) {
        if (worth_learning(before, size, aimed, scale)) learn(memory);
        memory.f = memory.trial_f;
        x = memory.trial;
        corrections = 1;
      }
    }
    report = iterate(ErasedStep<Step>(step), x, tolerance, scale, memory,
                     {.iterations = corrections, .evaluations = evaluations});
  }
  /// Solves with every call virtual.
  template <class Unknown>
  static SolveReport solve(const StepEquation<Unknown>& step, Unknown& x, double tolerance,
                           Memory<Unknown>& memory) {
    const double given = step.scale_squared();
    if (memory.valid) step.residual(x, memory.f);
    return iterate(step, x, tolerance, given > 0 ? given : 1.0, memory, {});
  }

 private:
  static constexpr double kRoundOff =  // of |F|^2, relative
      64 * 64 * std::numeric_limits<double>::epsilon() * std::numeric_limits<double>::epsilon();

  // Is a J that has taken |F|^2 from before to after good enough for the next correction? It should
  // cut |F| by ten; where it is made of differences and costs 2 n + 1 residuals by two, or reach
  // the floor.
  static bool worth_keeping(bool exact, double before, double after, double floor) {
    if (exact) return after <= 0.01 * before;
    return after <= 0.25 * before || after <= floor;
  }
  // Has the correction of a residual that is no round-off left more than a sixteenth of the aim?
  // What is left has one sign, and would add up over the steps while J becomes older.
  static bool worth_learning(double before, double after, double aimed, double scale) {
    return before > kRoundOff * scale && 256 * after > aimed;
  }
  // J is changed by what the correction of f by it has left, trial_f; a large one is not: where the
  // rows act on the momenta that learns round-off.
  template <class Unknown>
  [[gnu::noinline, gnu::cold]] static void learn(Memory<Unknown>& memory) {
    if (memory.factors.is_large(memory.f.size())) return;
    memory.factors.solve(memory.f, memory.correction);
    memory.factors.update(memory.correction, memory.trial_f);
  }
  // Floor of |F|^2, relative: above the aim of many unknowns.
  static constexpr double floor_of(Eigen::Index n) {
    const double aimed = 4 * aim(0, n);
    return std::max(kRoundOff, aimed * aimed);
  }
  // After a solve: is its J kept, and when is 1 tried again? A J of differences takes 2 n + 1
  // residuals and lasts for some twenty steps.
  template <class Unknown>
  static void judge(Memory<Unknown>& memory, bool exact, int iterations) {
    const auto n = static_cast<int>(memory.f.size());
    const bool large = memory.factors.is_large(n);
    if (large && memory.factors.is_one()) {
      memory.valid = memory.valid && iterations <= 2 + n / 10;
      if (!memory.valid) memory.wait = 2 * n + 1;
      return;
    }
    memory.valid = memory.valid && iterations <= (exact ? 1 : 2 + 2 * n / 5);
    if (!large) return;
    memory.wait -= iterations;
    memory.valid = memory.valid && (memory.wait > 0 || iterations <= 3);
  }

  // Limits of |F|^2.
  struct Bounds {
    double accepted, round_off, aimed;
  };

  // F and J are evaluated at x.
  template <class Unknown>
  [[gnu::always_inline]] static inline void linearise(const StepEquation<Unknown>& step,
                                                      const Unknown& x, Memory<Unknown>& memory,
                                                      int& evaluations) {
    evaluations +=
        step.linearise(x, memory.f, memory.jacobian, memory.differences, /*in_frame=*/true);
    memory.factors.compute(memory.jacobian);
    memory.wait = 2 * static_cast<int>(x.size()) + 1;
    memory.valid = true;
  }
  // Evaluates F at x - length J^-1 f, into memory.trial and trial_f, and returns |F|^2 there. A
  // fresh correction of |F|^2 = size is halved until it reduces that, or is below `enough`.
  template <class Unknown>
  [[gnu::always_inline]] static inline double correct(const StepEquation<Unknown>& step,
                                                      const Unknown& x, Memory<Unknown>& memory,
                                                      bool fresh, double size, double enough,
                                                      double& length, int& evaluations) {
    memory.factors.solve(memory.f, memory.correction);
    step.expand(memory.correction);
    double next = 1;
    while (true) {
      length = next;
      memory.trial = x - length * memory.correction;
      step.residual(memory.trial, memory.trial_f);
      ++evaluations;
      const double trial_size = memory.trial_f.squaredNorm();
      next = length / 2;
      if (!fresh || trial_size < size || !(size > enough) || !(next > 1e-3)) return trial_size;
    }
  }
  // Is J kept that has taken |F|^2 from before to after? J = 1 is given more time at first, and
  // less where a solve needs many corrections.
  template <class Unknown>
  [[gnu::always_inline]] static inline bool is_kept(const Memory<Unknown>& memory, bool exact,
                                                    int iterations, double before, double after,
                                                    const Bounds& bounds, double scale) {
    const bool worth = worth_keeping(exact, before, after, memory.floor * scale);
    if (!memory.factors.is_one()) return worth;
    return iterations < max_iterations / 2 &&
           (worth || iterations == 1 || after <= bounds.accepted);
  }
  // End of a solve whose residual a fresh J does not reduce, or is as small as it can be.
  template <class Unknown>
  static Reason why_it_stops(double size, const Bounds& bounds, const Unknown& correction) {
    if (size <= bounds.accepted) return Reason::converged;
    if (size <= bounds.round_off) return Reason::round_off;
    return correction.allFinite() ? Reason::stagnated : Reason::singular;
  }

  // memory.valid: memory.f is F(x), to be corrected with the Jacobian kept.
  template <class Unknown>
  [[gnu::noinline]] static SolveReport iterate(const StepEquation<Unknown>& step, Unknown& x,
                                               double tolerance, double scale,
                                               Memory<Unknown>& memory, SolveReport report) {
    // A Jacobian in closed form costs little more than a residual, one of differences 2 n + 1: it
    // is kept longer.
    const bool exact = step.exact();
    const double target = std::min(aim(tolerance, x.size()), tolerance);
    const Bounds bounds{tolerance * tolerance * scale, kRoundOff * scale, target * target * scale};

    if (!memory.valid && !exact && memory.factors.is_large(x.size()) && memory.wait <= 0) {
      memory.factors.set_one();
      step.residual(x, memory.f);
      ++report.evaluations;
      memory.valid = true;
    }
    double size = memory.valid ? memory.f.squaredNorm() : 0;  // |F|^2
    bool fresh = false;
    const auto finish = [&](Reason reason) {
      judge(memory, exact, report.iterations);
      report.reason = reason;
      report.residual = std::sqrt(size / scale);
      return report;
    };
    while (report.iterations < max_iterations) {
      if (!memory.valid) {
        linearise(step, x, memory, report.evaluations);
        fresh = true;
        size = memory.f.squaredNorm();
      }
      if (!std::isfinite(size)) return finish(Reason::not_finite);
      ++report.iterations;
      double length;
      const double trial_size =
          correct(step, x, memory, fresh, size, std::max(bounds.round_off, bounds.accepted), length,
                  report.evaluations);
      if (fresh && !exact && size <= bounds.accepted && !(trial_size <= 0.25 * size))
        memory.floor = 4 * size / scale;
      if (!(trial_size < size)) {
        if (fresh || size <= std::max(bounds.accepted, bounds.round_off))
          return finish(why_it_stops(size, bounds, memory.correction));
        memory.valid = false;
        continue;
      }
      memory.valid = is_kept(memory, exact, report.iterations, size, trial_size, bounds, scale);
      fresh = false;
      if (memory.valid && !exact && length == 1 &&
          worth_learning(size, trial_size, bounds.aimed, scale))
        learn(memory);
      x = memory.trial;
      memory.f = memory.trial_f;
      size = trial_size;
      if (size <= bounds.aimed) return finish(Reason::converged);
    }
    return finish(size <= bounds.accepted ? Reason::converged : Reason::max_iterations);
  }
};

}  // namespace hamel
