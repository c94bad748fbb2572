// reversible: both equations of the cotangent lift at s = 1/2 with nu = h (f + A(g)^T lambda), the
// multiplier at the midpoint, and the constraint enforced at the ends, A(g1) xi_1 = b.
//
// It is balance with (1) in full: the velocity v of the step is not admissible at the midpoint.
// Symmetric, order 2. Weakness: the configurations satisfy the rows of the step, and holonomic
// rows, to O(h^2) only; on reversible motions these errors and that of the energy stay bounded.
// Measured: tests/verification/baselines.cpp. Source: after McLachlan and Perlmutter, Integrators
// for nonholonomic mechanical systems, J. Nonlinear Sci. 16 (2006). Their (4.18) takes force and
// multiplier at q0 + h v0/2, where the old velocity leads in half a step; here both are taken at
// the base point of the step, q0 + h v/2 with the velocity v of the step. Both are reversible and
// of order 2.
#pragma once

#include <hamel/framework/schemes/balance.hpp>

namespace hamel {

struct Reversible : SchemeDefaults {
  static std::string name() { return "reversible"; }
  static std::string formula() {
    return "(1) and (2) of the cotangent lift at s = 1/2 with nu = h (f + A(g)' lambda), "
           "A(g_1) xi_1 = b";
  }
  static std::string source() {
    return "after McLachlan and Perlmutter 2006, (4.18), with the forces at the step's own "
           "midpoint";
  }
  static constexpr std::optional<double> fixed_s = 0.5;
  static constexpr ConstraintKept constraint_kept = ConstraintKept::nodes;
  static ClaimedOrder claim(double /*s*/, TauTraits /*tau*/, bool /*left_invariant*/) {
    return {2, true};
  }
  template <class P>
  using Step = BalanceStep<P, true>;
};

}  // namespace hamel
