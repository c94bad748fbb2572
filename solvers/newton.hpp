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
#include <type_traits>

#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/loop/step_equation.hpp>

namespace hamel {

/// J^-1: in closed form up to 4 x 4, as a matrix up to 16 x 16 (it only steers, and is used many
/// times), by LU beyond; there it is 1 until it is computed.
template <class Jacobian>
class Inverse {
  static constexpr int size = Jacobian::RowsAtCompileTime;
  static constexpr bool closed_form = size != Eigen::Dynamic && size <= 4;
  static constexpr bool may_be_large = size == Eigen::Dynamic || size > 16;

 public:
  static constexpr bool is_large(Eigen::Index n) { return may_be_large && n > 16; }
  bool is_one() const { return one_; }
  /// J^-1, in closed form or as a matrix.
  const Jacobian& matrix() const { return inverse_; }
  void set_one() { one_ = true; }
  void compute(const Jacobian& jacobian) {
    one_ = false;
    if constexpr (size == 0) {
      return;
    } else if constexpr (closed_form) {
      inverse_ = jacobian.inverse();
    } else if (const int n = static_cast<int>(jacobian.rows()); n <= 16) {
      inverse_.setIdentity(n, n);
      work_ = jacobian;
      solve_linear(work_.data(), inverse_.data(), n, n);
    } else if constexpr (may_be_large) {
      lu_.compute(jacobian);
    }
  }
  /// Broyden's update behind a correction c = J^-1 f that has left f_1 (Kelley 2003, ch. 4): the
  /// change of J along c that makes F(x - c) what it was found to be. With c_1 = J^-1 f_1
  ///   J^-1 <- J^-1 + c_1 (J^-T c)^T / c.(c - c_1).
  /// No update where that is ill-conditioned. Not of a large J.
  template <class Vector>
  void update(const Vector& c, const Vector& f_1) {
    constexpr int most = size == Eigen::Dynamic ? 16 : size;
    Eigen::Matrix<double, size, 1, 0, most, 1> c_1(c.size());
    multiply(inverse_, f_1, c_1);
    const double square = c.squaredNorm(), along = square - c.dot(c_1);
    if (!(along > 0.3 * square)) return;
    add_along(c.data(), c_1.data(), 1 / along, inverse_.data(), static_cast<int>(c.size()));
  }
  template <class Vector>
  void solve(const Vector& f, Vector& out) const {
    if constexpr (may_be_large) {
      if (is_large(f.size())) {
        if (one_) out = f;
        else out = lu_.solve(f);
        return;
      }
    }
    multiply(inverse_, f, out);
  }

 private:
  struct Nothing {};
  Jacobian inverse_;
  [[no_unique_address]] std::conditional_t<closed_form, Nothing, Jacobian> work_;
  [[no_unique_address]] std::conditional_t<may_be_large, Eigen::PartialPivLU<Jacobian>, Nothing>
      lu_;
  bool one_ = true;
};

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
    /// As if there had been no solve.
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
  /// The same with every call virtual.
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
  // Of |F|^2, relative: above the aim of many unknowns.
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

  // memory.valid: memory.f is F(x), to be corrected with the Jacobian kept.
  template <class Unknown>
  [[gnu::noinline]] static SolveReport iterate(const StepEquation<Unknown>& step, Unknown& x,
                                               double tolerance, double scale,
                                               Memory<Unknown>& memory, SolveReport report) {
    // A Jacobian in closed form costs little more than a residual, one of differences 2 n + 1: it
    // is kept longer.
    const bool exact = step.exact();
    const double accepted = tolerance * tolerance * scale, round_off = kRoundOff * scale;
    const double target = std::min(aim(tolerance, x.size()), tolerance),
                 aimed = target * target * scale;

    auto& [jacobian, factors, f, correction, trial, trial_f, differences, valid, floor, wait] =
        memory;
    if (!valid && !exact && factors.is_large(x.size()) && wait <= 0) {
      factors.set_one();
      step.residual(x, f);
      ++report.evaluations;
      valid = true;
    }
    double size = valid ? f.squaredNorm() : 0;  // |F|^2; with a Jacobian that is kept, f is F(x)
    bool fresh = false;
    const auto finish = [&](Reason reason) {
      judge(memory, exact, report.iterations);
      report.reason = reason;
      report.residual = std::sqrt(size / scale);
      return report;
    };
    while (report.iterations < max_iterations) {
      if (!memory.valid) {
        report.evaluations += step.linearise(x, f, jacobian, differences, /*in_frame=*/true);
        factors.compute(jacobian);
        wait = 2 * static_cast<int>(x.size()) + 1;
        valid = true;
        fresh = true;
        size = f.squaredNorm();
      }
      if (!std::isfinite(size)) return finish(Reason::not_finite);
      ++report.iterations;
      factors.solve(f, correction);
      step.expand(correction);
      double length = 1, trial_size = 0;
      do {
        trial = x - length * correction;
        step.residual(trial, trial_f);
        ++report.evaluations;
        trial_size = trial_f.squaredNorm();
        length /= 2;
      } while (fresh && !(trial_size < size) && size > std::max(round_off, accepted) &&
               length > 1e-3);
      if (fresh && !exact && size <= accepted && !(trial_size <= 0.25 * size)) {
        floor = 4 * size / scale;
      }
      if (!(trial_size < size)) {
        if (size <= accepted) return finish(Reason::converged);
        if (size <= round_off) return finish(Reason::round_off);
        if (fresh) return finish(correction.allFinite() ? Reason::stagnated : Reason::singular);
        memory.valid = false;
        continue;
      }
      memory.valid = (worth_keeping(exact, size, trial_size, floor * scale) ||
                      (factors.is_one() && (report.iterations == 1 || trial_size <= accepted))) &&
                     !(factors.is_one() && report.iterations >= max_iterations / 2);
      fresh = false;
      if (memory.valid && !exact && 2 * length == 1 &&
          worth_learning(size, trial_size, aimed, scale))
        learn(memory);
      x = trial;
      f = trial_f;
      size = trial_size;
      if (size <= aimed) return finish(Reason::converged);
    }
    return finish(size <= accepted ? Reason::converged : Reason::max_iterations);
  }
};

}  // namespace hamel
