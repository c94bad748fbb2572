// Baselines to compare the paper's schemes with (method.md, section 7). One file each: energy_preserving.cpp,
// gni.cpp, rkmk4.cpp, rk4_projected.cpp, and reversible in balance.cpp, where the equations and the known weaknesses
// stand; tests/verification/baselines.cpp measures them.
#pragma once

#include <memory>
#include <string>

#include <hamel/framework/schemes/traits.hpp>

namespace hamel {

/// What a baseline is unless it says otherwise.
struct BaselineDefaults {
  static constexpr bool uses_s = false;
  static constexpr double fixed_s = 0;
  static constexpr bool invariant_only = false;
  static constexpr bool steps_admissible = false;
  static constexpr bool explicit_step = false;
};

/// Classical Runge-Kutta on the equations of motion (explicit_step.hpp).
struct ExplicitDefaults : BaselineDefaults {
  static constexpr double fixed_s = 0.5;
  static constexpr bool explicit_step = true;
  static ClaimedOrder order(double /*s*/, bool /*symmetric_tau*/) { return {4, false}; }
};

/// Keeps the kinetic energy of a left-invariant system to round-off; order 2.
struct EnergyPreserving : BaselineDefaults {
  static std::string name() { return "energy_preserving"; }
  static std::string formula() {
    return "I (xi_1 - xi_0) = h ad*_W I W + A' lambda,  W = (xi_0 + xi_1)/2,  g_1 = g_0 tau(h W)";
  }
  static std::string source() { return "Celledoni, Farre Puiggali, Hoiseth, Martin de Diego 2019"; }
  static constexpr bool invariant_only = true;
  static constexpr bool steps_admissible = true;
  static ClaimedOrder order(double /*s*/, bool symmetric_tau) {
    return {symmetric_tau ? 2 : 1, symmetric_tau};
  }
  static std::unique_ptr<GeneralStep> general(const GeneralSetup& setup);
};

/// Reflects the momentum at the node, then takes a free variational step; order 2.
struct Gni : BaselineDefaults {
  static std::string name() { return "gni"; }
  static std::string formula() { return "p+ = (2 P - 1)* p-, then the free variational step"; }
  static std::string source() { return "Ferraro, Iglesias, Martin de Diego 2008"; }
  static constexpr bool uses_s = true;
  static ClaimedOrder order(double s, bool symmetric_tau) {
    return {s == 0.5 || symmetric_tau ? 2 : 1, false};
  }
  static std::unique_ptr<GeneralStep> general(const GeneralSetup& setup);
};

/// Multiplier at the midpoint, constraint at the ends; symmetric, order 2.
struct Reversible : BaselineDefaults {
  static std::string name() { return "reversible"; }
  static std::string formula() {
    return "(1) and (2) of the cotangent lift at s = 1/2 with nu = h (f + A(g)' lambda), "
           "A(g_1) xi_1 = b";
  }
  static std::string source() { return "McLachlan and Perlmutter 2006"; }
  static constexpr double fixed_s = 0.5;
  static ClaimedOrder order(double /*s*/, bool /*symmetric_tau*/) { return {2, true}; }
  static std::unique_ptr<GeneralStep> general(const GeneralSetup& setup);
};

/// Runge-Kutta-Munthe-Kaas of order 4 on the equations of motion; explicit.
struct Rkmk4 : ExplicitDefaults {
  static std::string name() { return "rkmk4"; }
  static std::string formula() {
    return "RK4 for (eta, xi)' = (dL tau_eta^-1 xi, a(t, g_0 tau(eta), xi))";
  }
  static std::string source() { return "Munthe-Kaas 1998; Iserles et al. 2000"; }
  static std::unique_ptr<GeneralStep> general(const GeneralSetup& setup);
};

/// Classical RK4 in the coordinates of the trajectory file, projected to group and constraint; explicit.
struct Rk4Projected : ExplicitDefaults {
  static std::string name() { return "rk4_projected"; }
  static std::string formula() {
    return "RK4 for (q, xi)' in the coordinates q of the element, then projected to group and rows";
  }
  static std::string source() {
    return "what a user would write by hand; Hairer, Lubich, Wanner IV.4";
  }
  static std::unique_ptr<GeneralStep> general(const GeneralSetup& setup);
};

}  // namespace hamel
