// hybrid: Powell's hybrid method, Eigen's port of MINPACK's hybrj.
//
// A dogleg between the Gauss-Newton and the gradient step inside a trust region; the Jacobian once,
// then Broyden's rank-one updates of its QR factors. Its return value is ignored: at xtol = 1e-15
// it reports "not making progress" in 44 of 100 solves that are at the solution. Source: Powell, A
// hybrid method for nonlinear equations, 1970; More, Garbow, Hillstrom, MINPACK-1.
#pragma once

#include <memory>
#include <string>

#include <hamel/framework/loop/solver.hpp>

namespace hamel {

struct Hybrid {
  static std::string name() { return "hybrid"; }
  static std::string summary() { return "Powell's hybrid method (MINPACK), Eigen's port"; }
  static std::string method() {
    return "dogleg step in a trust region; one Jacobian, then Broyden's updates of its QR factors";
  }
  static std::string stops() {
    return "the residual at two digits below the tolerance; else ten steps without progress";
  }
  static std::string source() { return "Powell 1970; More, Garbow, Hillstrom 1980"; }
  static std::shared_ptr<Solver> make();
};

}  // namespace hamel
