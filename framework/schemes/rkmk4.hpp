// rkmk4: the Munthe-Kaas method of the classical tableau of order 4 (munthe_kaas.hpp).
//
// Weakness: nothing is kept but the group: energy and holonomic rows drift, on a motion without
// end like h^5 t (its error of order 4 averages out where the motion is reversible).
// Measured: tests/verification/baselines.cpp. Source: Munthe-Kaas, High order Runge-Kutta methods
// on manifolds (1999).
#pragma once

#include <hamel/framework/schemes/munthe_kaas.hpp>

namespace hamel {

struct Rkmk4 : MuntheKaas {
  static std::string name() { return "rkmk4"; }
  static std::string formula() {
    return "RK4 for (eta, xi)' = (dL tau_eta^-1 xi, a(t, g_0 tau(eta), xi))";
  }
  static std::string source() { return "Munthe-Kaas 1999; Iserles et al. 2000"; }
  static ClaimedOrder claim(double /*s*/, TauTraits /*tau*/, bool /*left_invariant*/) {
    return {4, false};
  }
  static const Tableau& tableau() { return classical_rk4(); }
};

}  // namespace hamel
