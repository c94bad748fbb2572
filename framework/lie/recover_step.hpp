// The discrete velocity xi/h of a step, recovered from its two configurations: (M14), (M41) of
// framework/schemes/README.md. The solver's unknown does not enter.
//
//   tau_s(xi)          = tau(-s xi)^-1 tau((1-s) xi) = Delta,   Delta = g_k^-1 g_{k+1}
//   tau_s^-1 d(tau_s)  = Ad_{f1^-1} (s dR_{-s xi} + (1-s) dR_{(1-s) xi}) dxi
// By tau^-1 when tau_s = tau; in closed form where the retraction has it (its recover_step: the
// Cayley maps; products, factor by factor); else by Newton's method on the group with the rest
// tau^-1(tau_s(xi)^-1 Delta). The floor of a constraint residual so recovered is about eps / h.
#pragma once

#include <limits>

#include <hamel/framework/lie/linear_solve.hpp>
#include <hamel/framework/lie/trivialised.hpp>

namespace hamel {

/// xi with tau_s(xi) = delta; NaN where tau has no inverse there.
template <class Tau>
Vec<Tau::Group::dim> recover_step(const typename Tau::Group::template Element<double>& delta,
                                  double s) {
  using G = typename Tau::Group;
  constexpr int n = G::dim;
  try {
    if constexpr (requires { Tau::recover_step(delta, s); }) return Tau::recover_step(delta, s);
    Vec<n> xi = Tau::tau_inverse(delta);
    if (s == 0 || Tau::one_parameter) return xi;
    double last = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 20; ++k) {
      const At<Tau> z0(-s * xi), z1((1 - s) * xi);
      const auto here = G::compose(G::inverse(z0.f), z1.f);
      const Vec<n> rest = Tau::tau_inverse(G::compose(G::inverse(here), delta));
      const double size = rest.norm();
      if (!(size < last)) break;
      const Mat<n, n> c = s * z0.right + (1 - s) * z1.right;
      const Vec<n> carried = G::Ad(z1.f) * rest;
      const Vec<n> correction = inverse_of(c) * carried;
      xi += correction;
      last = size;
    }
    return xi;
  } catch (const DomainError&) {
    return Vec<n>::Constant(std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace hamel
