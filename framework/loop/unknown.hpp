// The unknown x of a step: guessed from its last values, solved for, and held to be the principal
// root.
//
// A root is taken for the principal one (principal_root.hpp)
//   - if a correction or two with the kept Jacobian gave it, or it is within a percent of the
//   extrapolation, and the
//     roots before it were principal;
//   - else if the path from h = 0 leads to it.
// Otherwise it is refused, as is a root outside the domain (measured by
// tests/solvers/large_steps.cpp).
#pragma once

#include <span>

#include <hamel/framework/loop/extrapolation.hpp>
#include <hamel/framework/loop/kernel.hpp>
#include <hamel/framework/loop/principal_root.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

template <class Scheme, class Step, class Newton>
class StepUnknown {
 public:
  using Unknown = typename Step::Unknown;
  using Node = hamel::Node<typename Step::Problem>;

  /// What one substep of a composition remembers of its own last solves.
  struct Memory {
    Extrapolation<Unknown> extrapolation;
    typename Newton::template Memory<Unknown> newton;
    bool trusted = false;  // the last solution was the principal root
    explicit Memory(const Unknown& sample) : extrapolation(sample), newton(sample) {}
    void forget() {
      extrapolation.forget();
      trusted = newton.valid = false;
    }
  };

  /// ordered: the scheme has an order, hence a limit h -> 0 and a principal root.
  StepUnknown(const KernelSetup& setup, long size, bool ordered)
      : x(Unknown::Zero(size)), setup_(setup), ordered_(ordered), guess_(x), root_(x) {}

  Unknown x;

  /// x of a step that has begun at a node with h.
  [[gnu::always_inline]] SolveReport solve(Step& step, const Node& node, double h, Memory& memory) {
    if (memory.extrapolation.count() == 0) step.guess(x);
    else memory.extrapolation(x);
    SolveReport report = setup_.solver == nullptr
                             ? Newton::solve(step, x, setup_.tolerance, memory.newton)
                             : solve_outside(step);
    if (!report.ok()) [[unlikely]]
      return report;
    if (!(memory.trusted && setup_.solver == nullptr && report.iterations <= kSure)) [[unlikely]] {
      if (!is_principal(step, node, h, memory)) report.reason = Reason::not_principal;
    }
    return report;
  }

 private:
  // So many corrections with a kept Jacobian do not change the root; those by differences are kept
  // longer.
  static constexpr int kSure = HasJacobian<Step> ? 1 : 2;

  [[gnu::noinline, gnu::cold]] bool is_principal(Step& step, const Node& node, double h,
                                                 Memory& memory) {
    if (!ordered_) return true;
    if (memory.trusted && memory.extrapolation.count() > 0) {
      memory.extrapolation(guess_);
      if ((x - guess_).squaredNorm() <= 1e-4 * x.squaredNorm()) return true;
    }
    const ErasedStep<Step> equation(step);
    const StepOnPath<Unknown> path = {equation, [&](double size) { step.begin(node, size); },
                                      [&](Unknown& guess) { step.guess(guess); }};
    memory.trusted = root_.leads_to(x, path, h, setup_.tolerance);
    return memory.trusted;
  }
  [[gnu::noinline, gnu::cold]] SolveReport solve_outside(Step& step) {
    const ErasedStep<Step> equation(step);
    return setup_.solver->solve(OutsideEquation<Unknown>(equation, x),
                                {x.data(), static_cast<size_t>(x.size())}, setup_.tolerance);
  }

  const KernelSetup& setup_;
  bool ordered_;
  Unknown guess_;
  PrincipalRoot<Unknown, Newton> root_;
};

}  // namespace hamel
