// The unknown x of a step: guessed from its last values, solved for, and held to be the principal
// root.
//
// A root is taken for the principal one (principal_root.hpp)
//   - if a correction or two with the kept Jacobian gave it, or it is within a percent of the
//     extrapolation, or of what round-off makes of it, and the roots before it were principal;
//   - else if the path from h = 0 leads to it.
// Otherwise it is refused, as is a root outside the domain (measured by
// tests/solvers/large_steps.cpp).
#pragma once

#include <cmath>
#include <span>

#include <hamel/framework/loop/extrapolation.hpp>
#include <hamel/framework/loop/kernel.hpp>
#include <hamel/framework/loop/principal_root.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

/// Does the step tell what the round-off of a configuration does to its rows?
template <class Step>
concept HasPlaces = requires(const Step& step, typename Step::Unknown& x) {
  step.residual_of_places(x, x);
};

/// The equation of a step but for that.
template <HasPlaces Step>
struct ButForPlaces {
  using Unknown = typename Step::Unknown;
  const Step& step;

  double scale_squared() const { return step.scale_squared(); }
  void residual(const Unknown& x, Unknown& f) const { step.residual_of_places(x, f); }
  void expand(Unknown& z) const requires HasFrame<Step> { step.expand(z); }
};

template <class Scheme, class Step, class Newton>
class StepUnknown;

/// An explicit step has none.
template <class Scheme, ExplicitStep Step, class Newton>
class StepUnknown<Scheme, Step, Newton> {
 public:
  using Node = hamel::Node<typename Step::Problem>;
  struct Memory {
    void clear_history() {}
    void move(Nearby /*to*/) {}
  };
  StepUnknown(const KernelSetup& /*setup*/, const Step& /*step*/, bool /*ordered*/) {}
  static Memory memory() { return {}; }
  [[gnu::always_inline]] void solve(const Step& step, const Node& /*node*/, double /*h*/,
                                    Memory& /*memory*/, SolveReport& report) const {
    report = {.evaluations = step.evaluations()};
  }
  bool finish(const Step& step, Node& next) const { return step.finish(next); }
  static void keep(Memory& /*memory*/) {}
};

template <class Scheme, ImplicitStep Step, class Newton>
class StepUnknown<Scheme, Step, Newton> {
 public:
  using Unknown = typename Step::Unknown;
  using Node = hamel::Node<typename Step::Problem>;

  /// The last solves of one substep of a composition.
  struct Memory {
    Extrapolation<Unknown> extrapolation;
    typename Newton::template Memory<Unknown> newton;
    bool trusted = false;  // the last solution was the principal root
    bool moved = false;    // to a state next to that of the last solve
    explicit Memory(const Unknown& sample) : extrapolation(sample), newton(sample) {}
    void clear_history() {
      extrapolation.clear_history();
      trusted = moved = newton.valid = false;
    }
    void move(Nearby to) {
      moved = true;
      if (to == Nearby::step) extrapolation.take_back();
    }
  };

  /// ordered: the scheme has an order, hence a limit h -> 0 and a principal root.
  StepUnknown(const KernelSetup& setup, const Step& step, bool ordered)
      : x_(Unknown::Zero(step.size())), setup_(setup), ordered_(ordered), guess_(x_), root_(x_) {}
  Memory memory() const { return Memory(x_); }
  const Unknown& x() const { return x_; }
  bool finish(const Step& step, Node& next) const { return step.finish(x_, next); }
  /// The step was taken.
  void keep(Memory& memory) const { memory.extrapolation.push(x_); }

  /// x of a step that has begun at a node with h.
  [[gnu::always_inline]] void solve(Step& step, const Node& node, double h, Memory& memory,
                                    SolveReport& report) {
    if (memory.extrapolation.empty()) step.guess(x_);
    else memory.extrapolation(x_);
    if (setup_.solver == nullptr) Newton::solve(step, x_, setup_.tolerance, memory.newton, report);
    else report = solve_outside(step);
    if (!report.ok()) [[unlikely]] {
      if (!is_round_off(step, h, memory, report)) return solve_anew(step, node, h, memory, report);
    }
    if (!(memory.trusted && setup_.solver == nullptr && report.iterations <= kSure)) [[unlikely]] {
      if (is_principal(step, node, h, memory)) return;
      report.reason = Reason::not_principal;
      solve_anew(step, node, h, memory, report);
    }
  }

 private:
  // So many corrections with a kept Jacobian do not change the root; those by differences are kept
  // longer.
  static constexpr int kSure = HasJacobian<Step> ? 1 : 2;
  static constexpr double kNearlySolved = 1e-8;  // |F|/scale

  // Has a solve stopped above the tolerance for the round-off of a configuration alone? That does
  // not shrink with the momenta, relative to which F is judged. A step that moves nothing by more
  // than 1e-12 (rad, m) is taken, as that of a linkage at rest; where a motion turns, the solve
  // goes on without what the rows of positions have of it.
  [[gnu::noinline, gnu::cold]] bool is_round_off(const Step& step, double h, Memory& memory,
                                                 SolveReport& report) {
    if (report.reason != Reason::stagnated && report.reason != Reason::max_iterations) return false;
    bool solved = x_.norm() * std::abs(h) <= 1e-12;
    if constexpr (HasPlaces<Step>) {
      if (!solved && setup_.solver == nullptr) solved = solve_but_for_places(step, memory, report);
    }
    if (solved) report.reason = Reason::round_off;
    return solved;
  }
  bool solve_but_for_places(const Step& step, Memory& memory,
                            SolveReport& report) requires HasPlaces<Step> {
    const double scale = std::sqrt(step.scale_squared());
    step.residual_of_places(x_, guess_);
    ++report.evaluations;
    if (!(guess_.norm() <= kNearlySolved * scale)) return false;
    const ButForPlaces<Step> but_for_places{step};
    const ErasedStep<ButForPlaces<Step>> equation(but_for_places);
    const SolveReport again = Newton::solve(static_cast<const StepEquation<Unknown>&>(equation), x_,
                                            setup_.tolerance, memory.newton);
    report.iterations += again.iterations;
    report.evaluations += again.evaluations;
    if (!again.ok()) return false;
    step.residual(x_, guess_);  // of F itself
    ++report.evaluations;
    report.residual = guess_.norm() / scale;
    return true;
  }
  // Without the memory of another state.
  [[gnu::noinline, gnu::cold]] void solve_anew(Step& step, const Node& node, double h,
                                               Memory& memory, SolveReport& report) {
    if (!memory.moved) return;
    const SolveReport before = report;
    memory.clear_history();
    step.guess(x_);
    if (setup_.solver == nullptr) {
      const ErasedStep<Step> equation(step);
      report = Newton::solve(static_cast<const StepEquation<Unknown>&>(equation), x_,
                             setup_.tolerance, memory.newton);
    } else {
      report = solve_outside(step);
    }
    report.iterations += before.iterations;
    report.evaluations += before.evaluations;
    if (!report.ok() && !is_round_off(step, h, memory, report)) return;
    if (!is_principal(step, node, h, memory)) report.reason = Reason::not_principal;
  }
  [[gnu::noinline, gnu::cold]] bool is_principal(Step& step, const Node& node, double h,
                                                 Memory& memory) {
    if (!ordered_) return true;
    if (memory.trusted && !memory.extrapolation.empty()) {
      memory.extrapolation(guess_);
      if ((x_ - guess_).squaredNorm() <=
          1e-4 * x_.squaredNorm() + PrincipalRoot<Unknown, Newton>::square_of_round_off(h))
        return true;
    }
    const ErasedStep<Step> equation(step);
    const StepOnPath<Unknown> path = {equation, [&](double size) { step.begin(node, size); },
                                      [&](Unknown& guess) { step.guess(guess); }};
    memory.trusted = root_.leads_to(x_, path, h);
    return memory.trusted;
  }
  [[gnu::noinline, gnu::cold]] SolveReport solve_outside(Step& step) {
    const ErasedStep<Step> equation(step);
    return setup_.solver->solve(SolverEquation<Unknown>(equation, x_),
                                {x_.data(), static_cast<size_t>(x_.size())}, setup_.tolerance);
  }

  Unknown x_;
  const KernelSetup& setup_;
  bool ordered_;
  Unknown guess_;
  PrincipalRoot<Unknown, Newton> root_;
};

}  // namespace hamel
