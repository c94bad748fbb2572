// Outcome of a solve, and of a run.
#pragma once

#include <string>

namespace hamel {

/// Why an implicit equation was, or was not, solved.
enum class Reason {
  converged,         // residual <= tolerance * scale
  round_off,         // no further decrease, and the residual is at the round-off floor: accepted
  stagnated,         // no further decrease above the floor
  max_iterations,    // the budget ran out
  singular,          // the Jacobian could not be solved with
  not_finite,        // NaN or infinity in the equation
  outside_domain,    // the solution lies where the retraction is no diffeomorphism
  not_principal,     // the solution is a root that the path from h = 0 does not lead to
  lost_constraints,  // an explicit step ends off the constraints
  rejected,          // the estimated error is above the tolerance
  too_small,         // no step above 1e-14 of the interval is within the tolerance
  too_many,          // nor one of so many tries
  stopped,           // the user's observer requested a stop
};

/// The reason as text.
constexpr const char* to_string(Reason reason) {
  switch (reason) {
    case Reason::converged: return "converged";
    case Reason::round_off: return "converged to the round-off floor";
    case Reason::stagnated: return "the residual stopped decreasing above the tolerance";
    case Reason::max_iterations: return "the iteration limit was reached";
    case Reason::singular: return "the Jacobian is singular";
    case Reason::not_finite: return "the equation gave a value that is not finite";
    case Reason::outside_domain: return "the step left the domain of the retraction";
    case Reason::not_principal:
      return "the solution is not the principal root of the step: take a smaller one";
    case Reason::lost_constraints:
      return "the constraints do not hold at the end of the step: the equations of motion are "
             "nearly "
             "singular there, or the step is too long";
    case Reason::rejected: return "the error of the step is above the tolerance";
    case Reason::too_small:
      return "no step above 1e-14 of the time passed is within the tolerance: the motion is "
             "singular "
             "there, or the tolerance "
             "below round-off";
    case Reason::too_many: return "a step was rejected 100 times in a row";
    case Reason::stopped: return "stopped by the observer";
  }
  return "";
}

/// The certificate of one solve. residual is |F| / scale, recomputed at the point returned.
struct SolveReport {
  Reason reason = Reason::converged;
  double residual = 0;
  int iterations = 0;
  int evaluations = 0;
  bool ok() const { return reason == Reason::converged || reason == Reason::round_off; }
};

/// The outcome of a run. On failure the step that failed, where it started, and why.
struct Status {
  bool ok = true;
  long step = 0;
  double time = 0;
  double residual = 0;
  std::string reason;
  explicit operator bool() const { return ok; }
};

}  // namespace hamel
