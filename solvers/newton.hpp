// newton: Newton's method with the Jacobian kept while it contracts well.
//
//   x <- x - J^-1 F(x),   accepted when |F(x)| <= tolerance * scale, F evaluated at the x returned.
// A Jacobian serves again while each step cuts the residual by ten (a chord step after a Newton step
// has error O(e^3)), else it is evaluated anew; a fresh step that does not reduce |F| is halved, up to
// ten times. When |F| stops falling it is accepted at the round-off floor (64 eps), else stagnated.
// Compiled into the kernels: fixed sizes, no heap, no virtual call.
// Source: Kelley, Solving Nonlinear Equations with Newton's Method, SIAM 2003, ch. 1-2.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include <Eigen/LU>

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

struct Newton {
  static constexpr int max_iterations = 50;
  static std::string name() { return "newton"; }

  /// step: scale(), evaluate(x, f, jacobian or nullptr). x: guess in, best point out.
  template <class Step>
  static SolveReport solve(const Step& step, typename Step::Unknown& x, double tolerance) {
    using Unknown = typename Step::Unknown;
    using Jacobian = typename Step::Jacobian;
    constexpr double floor = 64 * std::numeric_limits<double>::epsilon();
    const double scale = step.scale() > 0 ? step.scale() : 1.0;

    Unknown f = x, trial = x, trial_f = x;
    Jacobian jacobian;
    SolveReport report;
    while (true) {
      step.evaluate(x, f, &jacobian);
      ++report.evaluations;
      report.residual = f.norm() / scale;
      if (!std::isfinite(report.residual)) return with(report, Reason::not_finite);
      if (report.residual <= tolerance) return report;
      const Inverse<Jacobian> solver(jacobian);
      double contraction = 0;
      for (bool fresh = true; fresh || contraction <= 0.1; fresh = false) {
        if (report.iterations == max_iterations) return with(report, Reason::max_iterations);
        ++report.iterations;
        const Unknown full_step = solver.apply(f);
        if (!full_step.allFinite()) return with(report, Reason::singular);
        double residual = 0, length = 1;
        do {
          trial = x - length * full_step;
          step.evaluate(trial, trial_f, nullptr);
          ++report.evaluations;
          residual = trial_f.norm() / scale;
          length /= 2;
        } while (fresh && !(residual < report.residual) && length > 1.0 / 1024 &&
                 report.residual > floor);
        if (!(residual < report.residual)) {
          if (!fresh) break;
          return with(report, report.residual <= floor ? Reason::round_off : Reason::stagnated);
        }
        contraction = residual / report.residual;
        x = trial;
        f = trial_f;
        report.residual = residual;
        if (report.residual <= tolerance) return report;
      }
    }
  }

 private:
  static SolveReport with(SolveReport report, Reason reason) {
    report.reason = reason;
    return report;
  }

  // Closed-form inverse up to 4 x 4, LU beyond.
  template <class Jacobian>
  struct Inverse {
    static constexpr int size = Jacobian::RowsAtCompileTime;
    static constexpr int max_size = Jacobian::MaxRowsAtCompileTime;
    static constexpr bool closed_form = size != Eigen::Dynamic && size <= 4;
    using Lu = std::conditional_t<max_size <= SmallLu::max_size, SmallLu, Eigen::PartialPivLU<Jacobian>>;

    explicit Inverse(const Jacobian& j) {
      if constexpr (closed_form) factors = j.inverse();
      else factors.compute(j);
    }
    template <class Vector>
    Vector apply(const Vector& f) const {
      if constexpr (closed_form) return factors * f;
      else return factors.solve(f);
    }
    std::conditional_t<closed_form, Jacobian, Lu> factors;
  };
};

}  // namespace hamel
