// Schemes: a descriptor (name, formula, source, claims, as data that tests measure) and a
// template Step over the problem.
//
//   struct MyScheme : hamel::SchemeDefaults {
//     static std::string name(), formula(), source();
//     static hamel::ClaimedOrder claim(double s, hamel::TauTraits tau, bool left_invariant);
//     template <class Problem> class Step;      // problem.hpp lists what a step may use
//   };
// A Step takes the node it starts from to the next one. An implicit one is an equation F(x) = 0 in
// between (ImplicitStep), an explicit one is not (ExplicitStep). It is made as Step(problem, s), as
// Step(problem, s, force_at) where it has that choice, or from a Tableau as Step(problem, tableau).
// An explicit scheme derives from ExplicitDefaults; EquationsOfMotion
// (metric/equations_of_motion.hpp) has the rate of xi, without multipliers.
#pragma once

#include <concepts>
#include <optional>
#include <string>

#include <hamel/framework/lie/concepts.hpp>
#include <hamel/framework/schemes/problem.hpp>

namespace hamel {

/// The order a scheme claims, and whether its step is time-reversible.
struct ClaimedOrder {
  int order;        // 0: not an approximation at all
  bool reversible;  // a step with h, then one with -h, returns to the start
};

/// Range on which A xi = b holds: the whole step, its ends only, or nowhere.
enum class ConstraintKept { steps, nodes, nowhere };
/// How steps may be chosen by the error: by an estimate of it (loop/error_control.hpp), or, of
/// symmetric steps, by a reversible control (loop/step_control.hpp).
enum class StepChoice { none, by_estimate, symmetric };
/// Points at which lift takes f - dV: half at each node, or all at the base point.
enum class ForceAt { nodes, base };

/// The properties of a scheme that states none.
struct SchemeDefaults {
  static constexpr ConstraintKept constraint_kept = ConstraintKept::steps;
  /// The s of its steps, and of their measurement; std::nullopt where s is chosen by the user.
  static constexpr std::optional<double> fixed_s = 0.0;
  static constexpr StepChoice step_choice = StepChoice::none;
  static constexpr bool left_invariant_only = false;
  static constexpr bool reduced = false;  // has a step for LeftInvariant problems
};

/// The properties of an explicit scheme that states none: nodes keep A xi = b, steps do not.
struct ExplicitDefaults : SchemeDefaults {
  static constexpr std::optional<double> fixed_s = 0.5;
  static constexpr ConstraintKept constraint_kept = ConstraintKept::nodes;
  static constexpr bool reduced = true;
};

/// A step with an equation F(x) = 0.
template <class Step>
concept ImplicitStep = Problem<typename Step::Problem> &&
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
/// A step without an equation. evaluations(): of the equations of motion in the last step.
template <class Step>
concept ExplicitStep = Problem<typename Step::Problem> &&
    requires(Step& step, const Step& done, const Node<typename Step::Problem>& node,
             Node<typename Step::Problem>& next, double h) {
  step.begin(node, h);
  { done.finish(next) } -> std::convertible_to<bool>;
  { done.evaluations() } -> std::convertible_to<int>;
};
/// The step of a scheme for one problem.
template <class Step>
concept SchemeStep = ImplicitStep<Step> || ExplicitStep<Step>;

/// Corrections in coordinates of the step's own choice, in which its Jacobian changes little along
/// a motion: expand(z), z -> dx in place?
template <class Step>
concept HasFrame = requires(const Step& step, typename Step::Unknown& z) {
  step.expand(z);
};
/// Does the step itself normalise the element at its end, where that is due: before it uses it?
template <class Step>
concept NormalisesElement = requires(Step& step) {
  step.normalise_when(true);
};
/// F and dF/dx in closed form, linearise(x, f, j)?
template <class Step>
concept HasJacobian = requires(const Step& step, const typename Step::Unknown& x,
                               typename Step::Unknown& f, typename Step::Jacobian& j) {
  step.linearise(x, f, j);
};

}  // namespace hamel
