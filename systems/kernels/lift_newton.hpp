// Newton's method (solvers/newton.hpp) for steps whose Jacobian costs about two residuals, and
// whose first guess is often within round-off: there no correction tells how good the Jacobian is.
//
// It is kept for as long as two corrections reach the aim; what the first of them has left changes
// it (inverse.hpp). Where they do not, the solve is Newton's own from there on.
#pragma once

#include <cmath>

#include <hamel/solvers/newton.hpp>

namespace hamel {

struct LiftNewton : Newton {
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
        report = {Reason::converged, std::sqrt(size / scale), corrections, evaluations};
        return;
      }
      if (!(size <= 0.25 * before)) break;
      memory.factors.update(memory.correction, memory.trial_f);
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
  }
};

}  // namespace hamel
