// newton: Newton's method with the Jacobian kept while it contracts well, also from step to step.
//
//   x <- x - J^-1 F(x),   accepted when |F(x)| <= tolerance * scale, F evaluated at the x returned.
// Along a trajectory J changes by O(h) a step and the extrapolated guess is good, so that one correction
// with the last J usually suffices. J is evaluated anew when a correction does not cut |F| by ten, and for the
// next step when more than one correction was needed (by two, more than 2 + 2 n/5, where J is made of
// differences). A fresh correction that does not reduce |F| is halved, up to ten times.
// At least one correction is made: a guess that already meets the tolerance would leave its extrapolation
// error, always of one sign, in every step. A residual that stops falling is accepted at the round-off floor
// (64 eps), else the solve has stagnated. The iteration aims two digits below the tolerance, so that the error
// left by a kept Jacobian does not add up over the steps.
// Compiled into the kernels: fixed sizes, no heap, no virtual call.
// Source: Kelley, Solving Nonlinear Equations with Newton's Method, SIAM 2003, ch. 1-2.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include <Eigen/LU>

#include <hamel/framework/loop/compiled_kernel.hpp>
#include <hamel/framework/loop/status.hpp>

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
    SolveReport tried;
    if (memory.valid) [[likely]] {  // one correction with the last Jacobian: nearly every step
      work.f = x;
      step.residual(x, work.f);
      [[maybe_unused]] const double before = Memory<Step>::bounded ? 0 : work.f.squaredNorm();
      correct(step, memory, work.f, work.correction);
      work.trial = x - work.correction;
      step.residual(work.trial, work.f);
      const double size = work.f.squaredNorm(), target = aim(tolerance);
      if (size <= target * target * scale) [[likely]] {
        x = work.trial;
        return {Reason::converged, std::sqrt(size / scale), 1, 2};
      }
      tried.evaluations = 2;
      memory.valid = !Memory<Step>::bounded && worth_keeping<Step>(before, size, scale);
      if (memory.valid) {
        x = work.trial;
        tried.iterations = 1;
      }
    }
    return iterate(step, x, tolerance, scale, memory, tried);
  }

  // Two digits below the tolerance, at most to the round-off of a residual: a kept Jacobian leaves an error of
  // one sign, which must not add up over the steps.
  static constexpr double aim(double tolerance) {
    return std::max(0.01 * tolerance, 8 * std::numeric_limits<double>::epsilon());
  }

  // Does the step choose the coordinates of corrections (M39)?
  template <class Step>
  static constexpr bool has_frame = requires(const Step& step, typename Step::Unknown& z) {
    step.from_frame(z);
  };
  // J^-1 F.
  template <class Step>
  [[gnu::always_inline]] static inline void correct(const Step& step, const Memory<Step>& memory,
                                                    const typename Step::Unknown& f,
                                                    typename Step::Unknown& out) {
    memory.factors.solve(f, out);
    if constexpr (has_frame<Step>) step.from_frame(out);
  }

  static constexpr double kRoundOff =  // of |F|^2, relative
      64 * 64 * std::numeric_limits<double>::epsilon() * std::numeric_limits<double>::epsilon();

  // Is a J that has taken |F|^2 from before to after good enough for the next correction? It should cut |F|
  // by ten; where it is made of differences and costs 2 n + 1 residuals by two, or reach the round-off.
  template <class Step>
  static bool worth_keeping(double before, double after, double scale) {
    if (Memory<Step>::bounded) return after <= 0.01 * before;
    return after <= 0.25 * before || after <= kRoundOff * scale;
  }

  template <class Step>
  [[gnu::noinline]] static SolveReport iterate(const Step& step, typename Step::Unknown& x,
                                               double tolerance, double scale, Memory<Step>& memory,
                                               SolveReport report) {
    using Unknown = typename Step::Unknown;
    const double accepted = tolerance * tolerance * scale, round_off = kRoundOff * scale;
    const double target = std::min(aim(tolerance), tolerance), aimed = target * target * scale;

    Work<Unknown> own;
    auto& work = [&]() -> Work<Unknown>& {
      if constexpr (Memory<Step>::bounded) return own;
      else return memory.work;
    }();
    double size = 0;  // |F|^2
    if (Memory<Step>::bounded || !memory.valid) work.resize(x);
    else size = work.f.squaredNorm();  // J is kept, and f is F(x)
    auto& [f, correction, trial, trial_f] = work;
    bool fresh = false;
    const auto finish = [&](Reason reason) {
      // Made of differences a Jacobian costs 2 n + 1 residuals, a correction one: it is kept longer.
      const auto most = Memory<Step>::bounded ? 1 : 2 + static_cast<int>(2 * x.size()) / 5;
      memory.valid = memory.valid && report.iterations <= most;
      report.reason = reason;
      report.residual = std::sqrt(size / scale);
      return report;
    };
    while (report.iterations < max_iterations) {
      if (!memory.valid) {
        factor_at(step, x, f, memory);
        ++report.evaluations;
        fresh = true;
        size = f.squaredNorm();
      }
      if (!std::isfinite(size)) return finish(Reason::not_finite);
      ++report.iterations;
      correct(step, memory, f, correction);
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
      memory.valid = worth_keeping<Step>(size, trial_size, scale);
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
    if constexpr (has_frame<Step>) step.linearise_in_frame(x, f, memory.jacobian);
    else step.linearise(x, f, memory.jacobian);
    memory.factors.compute(memory.jacobian);
    memory.valid = true;
  }
};

}  // namespace hamel
