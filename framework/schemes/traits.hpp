// What a scheme says of itself, as data that the tests measure.
#pragma once

#include <concepts>
#include <memory>
#include <string>

namespace hamel {

class GeneralStep;
struct GeneralSetup;

/// The order a scheme claims on left-invariant systems, and whether its step is time-reversible.
struct ClaimedOrder {
  int order;        // 0: not an approximation at all
  bool reversible;  // a step with h, then one with -h, returns to the start
};

/// The step of a scheme, for one problem and one retraction: an equation F(x) = 0 and an update.
template <class Step>
concept SchemeStep = requires(Step& step, const Step& done, const typename Step::Momentum& mu,
                              double h, const typename Step::Unknown& x, typename Step::Unknown& f,
                              typename Step::Jacobian& j, typename Step::Momentum& next,
                              typename Step::Element& increment) {
  // Starts a step of size h (of either sign) from the momentum mu.
  step.begin(mu, h);
  // A first x, when there is no history to extrapolate from.
  { done.guess() } -> std::convertible_to<typename Step::Unknown>;
  // The squared size of the terms that F balances.
  { done.scale_squared() } -> std::convertible_to<double>;
  // The element of the algebra whose retraction is the step.
  done.xi(x);
  // F(x); F(x) with dF/dx.
  done.residual(x, f);
  done.linearise(x, f, j);
  // g_{k+1} = g_k increment, and the next momentum.
  done.finish(x, increment, next);
};

}  // namespace hamel
