// unadapted: the paper's T*G integrator, run on the constrained system as if nothing bound it.
//
// It is lift with d the whole algebra (E an I-orthonormal basis of R^n, the full momentum as state):
// (1)-(2) of method.md, section 2, with nu = 0. It conserves the spatial momentum Ad*_{g^-1} mu to
// round-off and leaves the constraint at once: the paper's negative control. For the free body
// (no constraint rows) it and lift are the same variational integrator.
#pragma once

#include <hamel/framework/schemes/lift.hpp>

namespace hamel {

struct Unadapted : Lift {
  static std::string name() { return "unadapted"; }
  static std::string formula() {
    return "lift with d = the whole algebra; the constraint is ignored";
  }
  static std::string source() { return "Vivek, Martin de Diego, Banavar: the T*G integrator"; }
  static constexpr bool adapted = false;
};

}  // namespace hamel
