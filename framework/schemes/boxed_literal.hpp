// boxed_literal: the paper's boxes exactly as typeset, with iota* in front of both lines.
//
// Kept only so that the paper's figure can be reproduced. As printed the right side is t I Omega
// with xi = t Omega, so that the step size cancels, and the update carries the sign of the inverse:
//   E^T ( (dR_v)^T mu_k - I v ) = 0,   A v = 0   (no h),
//   xi_{k+1} the admissible velocity of Ad_{tau(v)^-1}^T mu_k,   g_{k+1} = g_k tau(v).
// mu_k is the vector printed as (Pi_1, Pi_2, 0): the covector of d* without a part along the
// Euclidean complement of d, mu_k = (1 - A^T (A A^T)^-1 A) I xi_k. For a diagonal inertia that is I
// Omega. Not an approximation of anything: its first step is an O(1) jump whatever h is.
#pragma once

#include <Eigen/LU>

#include <hamel/framework/schemes/boxed.hpp>

namespace hamel {

struct BoxedLiteral : Boxed {
  static std::string name() { return "boxed_literal"; }
  static std::string formula() {
    return "E'(dR_xi)' mu_k = E' I xi,  mu_{k+1} = E' Ad_{tau(xi)^-1}' mu_k  (h cancels)";
  }
  static std::string source() { return "Vivek, Martin de Diego, Banavar: the boxes as typeset"; }
  static ClaimedOrder claim(double /*s*/, TauTraits /*tau*/, bool /*left_invariant*/) {
    return {0, false};
  }
  template <class P>
  using Step = BoxedStep<P, true>;
};

}  // namespace hamel
