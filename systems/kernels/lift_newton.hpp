// Newton's method (solvers/newton.hpp) for steps whose Jacobian costs about two residuals, and
// whose first guess is often within round-off: there no correction tells how good the Jacobian is.
//
// It is kept for as long as one correction reaches the aim, made anew behind a second one where it
// is older than kYoung steps, and at once where two do not reach the aim: from there on the solve
// is Newton's own.
#pragma once

#include <cmath>

#include <hamel/solvers/newton.hpp>

namespace hamel {

struct LiftNewton : Newton {
  template <class Unknown>
  struct Memory : Newton::Memory<Unknown> {
    using Newton::Memory<Unknown>::Memory;
    int age = 0;  // of the Jacobian, in steps
  };
  using Newton::solve;

  template <class Step>
  [[gnu::always_inline]] static inline void solve(const Step& step, typename Step::Unknown& x,
                                                  double tolerance,
                                                  Memory<typename Step::Unknown>& memory,
                                                  SolveReport& report) {
    const double scale = step.scale_squared(), target = aim(tolerance, x.size());
    const double aimed = target * target * scale;
    int evaluations = 1;
    if (memory.valid) [[likely]] {
      step.residual(x, memory.f);
    } else {
      step.linearise(x, memory.f, memory.jacobian);
      memory.factors.compute(memory.jacobian);
      memory.valid = true;
      memory.age = 0;
      evaluations = 2;
    }
    double before = memory.f.squaredNorm();
    for (const int corrections : {1, 2}) {
      memory.factors.solve(memory.f, memory.correction);
      memory.trial = x - memory.correction;
      step.residual(memory.trial, memory.trial_f);
      ++evaluations;
      const double size = memory.trial_f.squaredNorm();
      if (size <= aimed) [[likely]] {
        x = memory.trial;
        memory.valid = corrections == 1 || memory.age <= kYoung;
        ++memory.age;
        report = {Reason::converged, std::sqrt(size / scale), corrections, evaluations};
        return;
      }
      if (!(size <= 0.25 * before)) break;
      x = memory.trial;
      memory.f = memory.trial_f;
      before = size;
    }
    memory.valid = false;
    report = solve(static_cast<const StepEquation<typename Step::Unknown>&>(ErasedStep<Step>(step)),
                   x, tolerance, memory);
    ++report.iterations;
    report.evaluations += evaluations;
    memory.valid = report.ok();
    memory.age = 0;
  }

 private:
  static constexpr int kYoung = 30;
};

}  // namespace hamel
