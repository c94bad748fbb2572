// dopri5: the explicit pair 5(4) of Dormand and Prince as a Munthe-Kaas method (munthe_kaas.hpp).
// Six evaluations a step; dense output of order 5 by two more.
//
// Its own dense output, of order 4, gives the states at 1/3 and 2/3 of the step, with an error of
// O(h^5); the slopes there, those at the ends and y_1 fix the polynomial of degree 5 whose error is
// O(h^6) as that of the nodes ("bootstrapping"). Source: Dormand, Prince, A family of embedded
// Runge-Kutta formulae (1980); Shampine, Some practical Runge-Kutta formulas, Math. Comp. 46
// (1986); Enright, Jackson, Norsett, Thomsen, Interpolants for Runge-Kutta formulas, ACM Trans.
// Math. Software 12 (1986); Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I,
// II.5, II.6.
#pragma once

#include <hamel/framework/schemes/munthe_kaas.hpp>

namespace hamel {
namespace dopri5 {
inline constexpr double c[] = {0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1, 1.0 / 3, 2.0 / 3};
inline constexpr double a[] = {1.0 / 5,
                               3.0 / 40,
                               9.0 / 40,
                               44.0 / 45,
                               -56.0 / 15,
                               32.0 / 9,
                               19372.0 / 6561,
                               -25360.0 / 2187,
                               64448.0 / 6561,
                               -212.0 / 729,
                               9017.0 / 3168,
                               -355.0 / 33,
                               46732.0 / 5247,
                               49.0 / 176,
                               -5103.0 / 18656,
                               35.0 / 384,
                               0,
                               500.0 / 1113,
                               125.0 / 192,
                               -2187.0 / 6784,
                               11.0 / 84,
                               0.1161233609685786,
                               0,
                               0.24858839755009055,
                               -0.11197818328832118,
                               0.09034357663620027,
                               -0.053322531213617054,
                               0.04357871268040215,
                               0.08593431775870206,
                               0,
                               0.46488735598741376,
                               0.20148632288451832,
                               -0.06487458374115822,
                               0.00972861517086266,
                               -0.030495361393671924,
                               0};
inline constexpr double e[] = {-71.0 / 57600,    0,           71.0 / 16695, -71.0 / 1920,
                               17253.0 / 339200, -22.0 / 525, 1.0 / 40};
inline constexpr double dense[] = {1,
                                   -3.765625,
                                   6.723958333333333,
                                   -5.6953125,
                                   1.828125,
                                   0,
                                   0,
                                   0,
                                   0,
                                   0,
                                   0,
                                   13.477088948787062,
                                   -49.41599281221923,
                                   60.64690026954178,
                                   -24.258760107816713,
                                   0,
                                   19.53125,
                                   -71.61458333333333,
                                   87.890625,
                                   -35.15625,
                                   0,
                                   -9.67128537735849,
                                   35.461379716981135,
                                   -43.520784198113205,
                                   17.408313679245282,
                                   0,
                                   3.9285714285714284,
                                   -14.404761904761905,
                                   17.678571428571427,
                                   -7.071428571428571,
                                   0,
                                   -3.25,
                                   12.25,
                                   -15.75,
                                   6.75,
                                   0,
                                   -6.75,
                                   33.75,
                                   -47.25,
                                   20.25,
                                   0,
                                   -13.5,
                                   47.25,
                                   -54,
                                   20.25};
}  // namespace dopri5

struct Dopri5 : ExplicitPair {
  static std::string name() { return "dopri5"; }
  static std::string formula() { return "Dormand-Prince 5(4) for (eta, xi)'"; }
  static std::string source() { return "Dormand, Prince 1980"; }
  static ClaimedOrder claim(double /*s*/, TauTraits /*tau*/, bool /*left_invariant*/) {
    return {5, false};
  }
  static const Tableau& tableau() {
    static constexpr Tableau table = {.order = 5,
                                      .stages = 6,
                                      .c = dopri5::c,
                                      .a = dopri5::a,
                                      .e = dopri5::e,
                                      .estimated_order = 5,
                                      .dense = dopri5::dense,
                                      .degree = 5};
    return table;
  }
};

}  // namespace hamel
