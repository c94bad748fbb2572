// nlopt: NLopt's algorithms, on the equation itself or on 1/2|F|^2.
//
// LD_SLSQP (the name "nlopt") minimises nothing subject to F(x) = 0: a Newton iteration with a line
// search. All others minimise 1/2|F|^2, and those with gradients (J'F) stall at the square root of
// eps. A solve is therefore several legs. With r = |F|/scale at the best point x_b, a leg works on
//   z -> F(x_b + sigma z)/(r scale),   sigma = |F(x_b)|/slope,   slope = |dF|/|dx| at the guess,
// where the objective starts at 1/2 again. Two legs reach the floor; legs end when one does not
// halve r. A callback stops NLopt at the target (nlopt_force_stop). NLopt's return value, above all
// ROUNDOFF_LIMITED, is ignored. Sources: Johnson, The NLopt nonlinear-optimization package, 2.7.1,
// and those named in the table below.
#pragma once

#include <array>
#include <memory>
#include <string>

#include <hamel/framework/loop/solver.hpp>

namespace hamel {

struct Nlopt {
  const char* label;      // registered name
  const char* algorithm;  // NLopt's own, as nlopt_algorithm_from_string reads it
  const char* words;
  const char* reference;
  bool derivatives = true;

  std::string name() const { return label; }
  static std::string package() { return "libnlopt-dev"; }
  std::string summary() const { return std::string(words) + ", NLopt " + algorithm; }
  std::string method() const {
    return std::string(algorithm) == "LD_SLSQP"
               ? "min 0 subject to F(x) = 0, quadratic subproblems with a line search"
               : "min |F(x_b + sigma z)|^2/2, begun again at the best point x_b, sigma ~ |F(x_b)|";
  }
  static std::string stops() {
    return "the residual at two digits below the tolerance; a leg that does not halve the residual";
  }
  std::string source() const { return std::string(reference) + "; NLopt 2.7.1"; }
  /// False where it is a module that is not there (framework/io/module.hpp).
  static bool found();
  std::shared_ptr<Solver> make() const;
};

inline constexpr std::array kNlopt = {
    Nlopt{"nlopt", "LD_SLSQP", "sequential quadratic programming with F = 0 as constraints",
          "Kraft 1988"},
    Nlopt{"nlopt:slsqp", "LD_SLSQP", "sequential quadratic programming with F = 0 as constraints",
          "Kraft 1988"},
    Nlopt{"nlopt:lbfgs", "LD_LBFGS", "limited-memory BFGS on |F|^2/2", "Nocedal 1980; Luksan"},
    Nlopt{"nlopt:var2", "LD_VAR2", "limited-memory variable metric of rank 2 on |F|^2/2",
          "Vlcek, Luksan 2006"},
    Nlopt{"nlopt:tnewton", "LD_TNEWTON_PRECOND_RESTART", "truncated Newton on |F|^2/2",
          "Dembo, Steihaug 1983; Luksan"},
    Nlopt{"nlopt:mma", "LD_MMA", "method of moving asymptotes on |F|^2/2", "Svanberg 2002"},
    Nlopt{"nlopt:ccsaq", "LD_CCSAQ", "conservative convex separable quadratics on |F|^2/2",
          "Svanberg 2002"},
    Nlopt{"nlopt:neldermead", "LN_NELDERMEAD", "Nelder-Mead simplex on |F|^2/2, no derivatives",
          "Nelder, Mead 1965", false},
    Nlopt{"nlopt:sbplx", "LN_SBPLX", "Subplex on |F|^2/2, no derivatives", "Rowan 1990", false},
};

}  // namespace hamel
