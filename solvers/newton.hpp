// newton: Newton's method with the Jacobian kept while it contracts well, also from step to step.
//
//   x <- x - J^-1 F(x),   accepted when |F(x)| <= tolerance * scale, F evaluated at the x returned.
// Along a trajectory J changes by O(h) a step and the extrapolated guess is good, so that one correction
// with the last J usually does. J is evaluated anew when a correction does not cut |F| by ten, and for the
// next step when more than one correction was needed; a fresh correction that does not reduce |F| is
// halved, up to ten times. At least one correction is made: a guess that already meets the tolerance
// would leave its extrapolation error, always of one sign, in every step. When |F| stops falling it is
// accepted at the round-off floor (64 eps), else it is stagnated. The iteration aims two digits below the
// tolerance, so that what a kept Jacobian leaves does not add up over the steps.
// Compiled into the kernels: fixed sizes, no heap, no virtual call.
// Source: Kelley, Solving Nonlinear Equations with Newton's Method, SIAM 2003, ch. 1-2.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include <Eigen/LU>

#include <hamel/framework/compiled_kernel.hpp>
#include <hamel/framework/status.hpp>

namespace hamel {

/// LU with partial pivoting up to 12 x 12, compiled once (in newton.cpp) and free of heap.
class SmallLu {
 public:
  static constexpr int max_size = 12;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_size, max_size>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_size, 1>;
  void compute(const Matrix& matrix);
  Vector solve(const Vector& f) const;

 private:
  Eigen::PartialPivLU<Matrix> lu_;
};

/// J^-1: in closed form up to 4 x 4, by LU beyond; without a bound, up to 16 x 16 as a matrix (it only
/// steers, and is used many times).
template <class Jacobian>
class Inverse {
 public:
  static constexpr int size = Jacobian::RowsAtCompileTime;
  static constexpr bool closed_form = size != Eigen::Dynamic && size <= 4;
  static constexpr int bound = Jacobian::MaxRowsAtCompileTime;  // Dynamic is -1
  static constexpr bool small = bound != Eigen::Dynamic && bound <= SmallLu::max_size;

  void compute(const Jacobian& jacobian) {
    if constexpr (bound == Eigen::Dynamic) {
      if (jacobian.rows() <= 16) {  // in loops of our own: Eigen's would take memory
        inverse_.resize(jacobian.rows(), jacobian.cols());
        work_ = jacobian;
        invert(work_.data(), inverse_.data(), static_cast<int>(jacobian.rows()));
        return;
      }
    }
    if constexpr (closed_form) factors_ = jacobian.inverse();
    else factors_.compute(jacobian);
  }
  template <class Vector>
  void solve(const Vector& f, Vector& out) const {
    if constexpr (closed_form) {
      out = factors_ * f;
    } else if constexpr (bound == Eigen::Dynamic) {
      if (f.size() <= 16) out = inverse_.lazyProduct(f);
      else out = factors_.solve(f);
    } else {
      out = factors_.solve(f);
    }
  }

 private:
  using Lu = std::conditional_t<small, SmallLu, Eigen::PartialPivLU<Jacobian>>;
  struct Nothing {};
  std::conditional_t<closed_form, Jacobian, Lu> factors_;
  [[no_unique_address]] std::conditional_t<bound == Eigen::Dynamic, Jacobian, Nothing> inverse_,
      work_;
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

  /// The work vectors of a solve: locals, but for sizes without bound kept in the memory (no heap).
  template <class Unknown>
  struct Work {
    Unknown f, correction, trial, trial_f;
    void resize(const Unknown& x) { f = correction = trial = trial_f = x; }
  };

  /// The factors of the last Jacobian, kept from one step of a run to the next.
  template <class Step>
  struct Memory {
    using Unknown = typename Step::Unknown;
    static constexpr bool bounded = Unknown::MaxRowsAtCompileTime != Eigen::Dynamic;
    struct Nothing {};
    Inverse<typename Step::Jacobian> factors;
    typename Step::Jacobian jacobian;
    [[no_unique_address]] std::conditional_t<bounded, Nothing, Work<Unknown>> work;
    bool valid = false;
  };

  /// step: scale_squared(), residual(x, f), linearise(x, f, jacobian). x: guess in, best point out.
  template <class Step>
  [[gnu::always_inline]] static inline SolveReport solve(const Step& step,
                                                         typename Step::Unknown& x,
                                                         double tolerance, Memory<Step>& memory) {
    if constexpr (Memory<Step>::bounded) {
      Work<typename Step::Unknown> work;
      return solve(step, x, tolerance, memory, work);
    } else {
      return solve(step, x, tolerance, memory, memory.work);
    }
  }

 private:
  template <class Step>
  [[gnu::always_inline]] static inline SolveReport solve(const Step& step,
                                                         typename Step::Unknown& x,
                                                         double tolerance, Memory<Step>& memory,
                                                         Work<typename Step::Unknown>& work) {
    const double given = step.scale_squared(), scale = given > 0 ? given : 1.0;
    if (memory.valid) [[likely]] {  // one correction with the last Jacobian: nearly every step
      work.f = x;
      step.residual(x, work.f);
      memory.factors.solve(work.f, work.correction);
      work.trial = x - work.correction;
      step.residual(work.trial, work.f);
      const double size = work.f.squaredNorm(), target = aim(tolerance);
      if (size <= target * target * scale) [[likely]] {
        x = work.trial;
        return {Reason::converged, std::sqrt(size / scale), 1, 2};
      }
    }
    return iterate(step, x, tolerance, scale, memory);
  }

  // What is aimed at: two digits below the tolerance, at most to the round-off of a residual. A kept
  // Jacobian leaves an error of one sign, which must not add up over the steps.
  static constexpr double aim(double tolerance) {
    return std::max(0.01 * tolerance, 8 * std::numeric_limits<double>::epsilon());
  }

  template <class Step>
  [[gnu::noinline]] static SolveReport iterate(const Step& step, typename Step::Unknown& x,
                                               double tolerance, double scale,
                                               Memory<Step>& memory) {
    using Unknown = typename Step::Unknown;
    constexpr double floor = 64 * std::numeric_limits<double>::epsilon();
    const double accepted = tolerance * tolerance * scale, round_off = floor * floor * scale;
    const double target = std::min(aim(tolerance), tolerance), aimed = target * target * scale;

    Work<Unknown> own;
    auto& work = [&]() -> Work<Unknown>& {
      if constexpr (Memory<Step>::bounded) return own;
      else return memory.work;
    }();
    work.resize(x);
    auto& [f, correction, trial, trial_f] = work;
    SolveReport report;
    double size = 0;  // |F|^2
    bool fresh = false;
    const auto finish = [&](Reason reason) {
      // Without a bound a Jacobian costs n residuals and more: it is kept longer.
      memory.valid = memory.valid && report.iterations <= (Memory<Step>::bounded ? 1 : 3);
      report.reason = reason;
      report.residual = std::sqrt(size / scale);
      return report;
    };
    memory.valid = false;
    while (report.iterations < max_iterations) {
      if (!memory.valid) {
        factor_at(step, x, f, memory);
        ++report.evaluations;
        fresh = true;
        size = f.squaredNorm();
      }
      if (!std::isfinite(size)) return finish(Reason::not_finite);
      ++report.iterations;
      memory.factors.solve(f, correction);
      double length = 1, trial_size = 0;
      do {
        trial = x - length * correction;
        step.residual(trial, trial_f);
        ++report.evaluations;
        trial_size = trial_f.squaredNorm();
        length /= 2;
      } while (fresh && !(trial_size < size) && size > round_off && length > 1e-3);
      if (!(trial_size < size)) {
        if (size <= accepted) return finish(Reason::converged);
        if (size <= round_off) return finish(Reason::round_off);
        if (fresh) return finish(correction.allFinite() ? Reason::stagnated : Reason::singular);
        memory.valid = false;
        continue;
      }
      memory.valid = trial_size <= 0.01 * size;  // contracted by ten
      fresh = false;
      x = trial;
      f = trial_f;
      size = trial_size;
      if (size <= aimed) return finish(Reason::converged);
    }
    return finish(size <= accepted ? Reason::converged : Reason::max_iterations);
  }

  template <class Step>
  [[gnu::noinline]] static void factor_at(const Step& step, const typename Step::Unknown& x,
                                          typename Step::Unknown& f, Memory<Step>& memory) {
    step.linearise(x, f, memory.jacobian);
    memory.factors.compute(memory.jacobian);
    memory.valid = true;
  }
};

}  // namespace hamel
