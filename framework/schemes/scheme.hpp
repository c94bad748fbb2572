// What a scheme is: a descriptor (name, formula, source, claims, as data that tests measure) and a template
// Step over the problem.
//
//   struct MyScheme : hamel::SchemeDefaults {
//     static std::string name(), formula(), source();
//     static hamel::ClaimedOrder claim(double s, bool symmetric_tau, bool left_invariant);
//     template <class Problem> class Step;      // problem.hpp says what a step may ask
//   };
// A Step takes the node it starts from to the next one. In between it is an equation F(x) = 0:
//   Step(problem, s), size(), begin(node, h), guess(x), scale_squared(), residual(x, f), finish(x, next).
// An explicit step has size() = 0 and no residual.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <string>

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
  static constexpr bool reduced = false;  // has a step for LeftInvariant problems
  /// The velocity of a step, not of its ends only, satisfies A xi = b.
  static constexpr bool steps_admissible = true;
  static constexpr bool explicit_step = false;
  static constexpr int stages =
      0;  // of an explicit step: how often it evaluates the equations of motion
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
  // A first x, when there is no history to extrapolate from; the squared size of the terms that F balances; F.
  done.guess(x);
  { done.scale_squared() } -> std::convertible_to<double>;
  done.residual(x, f);
};

/// Work space of differentiate.
template <class Unknown>
struct Differences {
  Unknown direction, shifted, shifted_f;
};

/// Corrections in coordinates of the step's own choice, in which its Jacobian changes little along a motion:
/// from_frame(z), z -> dx in place?
template <class Step>
concept HasFrame = requires(const Step& step, typename Step::Unknown& z) {
  step.from_frame(z);
};
template <class Step>
concept HasJacobian = requires(const Step& step, const typename Step::Unknown& x,
                               typename Step::Unknown& f, typename Step::Jacobian& j) {
  step.linearise(x, f, j);
};

/// F and dF/dx, or dF/dz with x + from_frame(z) (in_frame). The step's own linearise(x, f, j), else central
/// differences, error about 1e-10: a Jacobian only steers the solver. Returns how often F was evaluated.
template <class Step>
int linearise(const Step& step, const typename Step::Unknown& x, typename Step::Unknown& f,
              typename Step::Jacobian& j, Differences<typename Step::Unknown>& work,
              [[maybe_unused]] bool in_frame) {
  if constexpr (HasJacobian<Step>) {
    step.linearise(x, f, j);
    return 1;
  } else {
    const double size = x.template lpNorm<Eigen::Infinity>();
    const double shift =
        std::cbrt(std::numeric_limits<double>::epsilon()) * (size > 0 ? size : 1.0);
    const Eigen::Index n = x.size();
    work.direction.resize(n);
    work.shifted.resize(n);
    work.shifted_f.resize(n);
    f.resize(n);
    j.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      work.direction.setZero();
      work.direction[i] = 1;
      if constexpr (HasFrame<Step>) {
        if (in_frame) step.from_frame(work.direction);
      }
      const double length = shift / work.direction.template lpNorm<Eigen::Infinity>();
      work.shifted = x + length * work.direction;
      step.residual(work.shifted, work.shifted_f);
      work.shifted = x - length * work.direction;
      step.residual(work.shifted, f);
      j.col(i) = (work.shifted_f - f) / (2 * length);
    }
    step.residual(x, f);
    return 2 * static_cast<int>(n) + 1;
  }
}

}  // namespace hamel
