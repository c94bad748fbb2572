// unadapted: the paper's T*G integrator, run on the constrained system as if nothing bound it.
//
// It is lift of the problem without its rows: with nu = 0 it conserves the spatial momentum
// Ad*_{g^-1} mu to round-off, and it leaves the constraint at once: the paper's negative control.
// For the free body (no constraint rows) it and lift are the same variational integrator.
#pragma once

#include <hamel/framework/schemes/lift.hpp>

namespace hamel {

struct Unadapted : Lift {
  static std::string name() { return "unadapted"; }
  static std::string formula() {
    return "lift with d = the whole algebra; the constraint is ignored";
  }
  static std::string source() { return "Vivek, Martin de Diego, Banavar: the T*G integrator"; }
  static constexpr ConstraintKept constraint_kept = ConstraintKept::nowhere;

  template <class P>
  class Step : public Lift::Step<typename P::Unconstrained> {
   public:
    Step(const P& problem, double s)
        : Lift::Step<typename P::Unconstrained>(problem.unconstrained(), s) {}
  };
};

}  // namespace hamel
