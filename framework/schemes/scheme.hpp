// What a scheme is: a descriptor (name, formula, source, claims, as data that tests measure) and a
// template Step over the problem.
//
//   struct MyScheme : hamel::SchemeDefaults {
//     static std::string name(), formula(), source();
//     static hamel::ClaimedOrder claim(double s, hamel::TauTraits tau, bool left_invariant);
//     template <class Problem> class Step;      // problem.hpp says what a step may ask
//   };
// A Step takes the node it starts from to the next one. In between it is an equation F(x) = 0:
//   Step(problem, s), size(), begin(node, h), guess(x), scale_squared(), residual(x, f), finish(x,
//   next).
// An explicit step has size() = 0, no residual, and evaluations(): of the equations of motion in
// the last step. One that is given by a Tableau is made as Step(problem, tableau).
#pragma once

#include <concepts>
#include <string>

#include <hamel/framework/lie/concepts.hpp>
#include <hamel/framework/schemes/problem.hpp>

namespace hamel {

/// The order a scheme claims, and whether its step is time-reversible.
struct ClaimedOrder {
  int order;        // 0: not an approximation at all
  bool reversible;  // a step with h, then one with -h, returns to the start
};

/// What a scheme is unless it says otherwise.
struct SchemeDefaults {
  static constexpr bool adapted = true;  // keeps the constraint
  static constexpr bool uses_s = false;
  static constexpr double fixed_s =
      0;  // where it does not: the s of its steps, and of their measurement
  static constexpr bool left_invariant_only = false;
  static constexpr bool places_forces = false;  // at the nodes or at the base point
  static constexpr bool reduced = false;        // has a step for LeftInvariant problems
  /// The velocity of a step, not of its ends only, satisfies A xi = b.
  static constexpr bool steps_admissible = true;
  static constexpr bool explicit_step = false;
  // Steps chosen by the error: explicit ones estimate it, symmetric ones follow a reversible
  // control (loop/error_control.hpp, loop/step_control.hpp).
  static constexpr bool estimates_error = false, varies_steps = false;
};

/// The step of a scheme for one problem.
template <class Step>
concept SchemeStep = Problem<typename Step::Problem> &&
    requires(Step& step, const Step& done, const Node<typename Step::Problem>& node,
             Node<typename Step::Problem>& next, double h, typename Step::Unknown& x,
             typename Step::Unknown& f) {
  // How many unknowns.
  { done.size() } -> std::convertible_to<int>;
  // Starts a step of size h (of either sign) from a node, which outlives it.
  step.begin(node, h);
  // The next node; false when the step leaves the domain of the retraction.
  { done.finish(x, next) } -> std::convertible_to<bool>;
  // A first x, when there is no history to extrapolate from; the squared size of the terms that F
  // balances; F.
  done.guess(x);
  { done.scale_squared() } -> std::convertible_to<double>;
  done.residual(x, f);
};

/// Corrections in coordinates of the step's own choice, in which its Jacobian changes little along
/// a motion: from_frame(z), z -> dx in place?
template <class Step>
concept HasFrame = requires(const Step& step, typename Step::Unknown& z) {
  step.from_frame(z);
};
/// F and dF/dx in closed form, linearise(x, f, j)?
template <class Step>
concept HasJacobian = requires(const Step& step, const typename Step::Unknown& x,
                               typename Step::Unknown& f, typename Step::Jacobian& j) {
  step.linearise(x, f, j);
};

}  // namespace hamel
