// The one time loop: a scheme's step over a problem, its substeps where it is composed, the solver, and the
// measurements. Compiled for (scheme, problem, solver): with fixed sizes there is no heap and no virtual call in a step.
// What does not depend on the types is in time_loop.hpp; what is seldom done with a step's equation goes through
// step_equation.hpp.
//
// A root is taken for the principal one (principal_root.hpp)
//   - if a correction or two with the kept Jacobian gave it, or it is within a percent of the extrapolation, and the
//     roots before it were principal;
//   - else if the path from h = 0 leads to it.
// Otherwise it is refused, as is a root outside the domain (measured by tests/solvers/large_steps.cpp).
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include <hamel/framework/loop/denormals.hpp>
#include <hamel/framework/loop/extrapolation.hpp>
#include <hamel/framework/loop/measure.hpp>
#include <hamel/framework/loop/principal_root.hpp>
#include <hamel/framework/loop/time_loop.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

template <class Scheme, class Whole, class Newton>
class Loop final : public TimeLoop {
 public:
  using Step = typename Scheme::template Step<Whole>;
  using P = typename Step::Problem;  // Whole, or Whole without its rows
  using Unknown = typename Step::Unknown;
  using Node = hamel::Node<P>;
  static_assert(SchemeStep<Step>, "the scheme's Step does not satisfy hamel::SchemeStep");

  [[gnu::cold]] explicit Loop(const KernelSetup& setup)
      : TimeLoop(setup),
        whole_(setup.geometry, setup.mechanics),
        step_(whole_, setup.s),
        problem_(problem_of(whole_)),
        symmetric_(whole_.symmetric()),
        nodes_{Node(problem_), Node(problem_), Node(problem_)},
        start_of_step_{*now_, *previous_, last_h_},
        start_of_rescue_(start_of_step_),
        x_(Unknown::Zero(step_.size())),
        guess_(x_),
        root_(x_),
        stages_(setup.composition.size(), {1, Extrapolation<Unknown>(x_), Memory(x_)}) {
    if constexpr (requires { step_.take_forces_at_base(); }) {
      if (setup.forces_at_base) step_.take_forces_at_base();
    }
    problem_.from_coordinates(setup.configuration, now_->g);
    typename P::Vector velocity = setup.velocity;
    problem_.carry(velocity, now_->x);
    now_->t = setup.from;
    *previous_ = *now_;
    for (size_t i = 0; i < stages_.size(); ++i) stages_[i].coefficient = setup.composition[i];
  }

  Status advance(long count) override {
    const FlushDenormals flushed;
    for (long k = 0; k < count; ++k) {
      SolveReport report = one_step();
      if (!report.ok()) [[unlikely]] {
        report = recover(report);
        if (!report.ok()) return failure(report);
      }
      tally(report);
    }
    return {};
  }

  [[gnu::cold]] void state(Snapshot& out) const override {
    typename P::Vector xi(problem_.dim());
    state(out, xi);
  }
  [[gnu::cold]] void measure(Snapshot& out) const override {
    typename P::Vector xi(problem_.dim());
    state(out, xi);
    const double h = steps_ > 0 ? last_h_ : 0;
    hamel::measure(whole_, {previous_->g, previous_->t, now_->g, now_->t, h}, setup_.s, xi, out);
    out.iterations = last_.iterations;
    out.residual = last_.residual;
  }

 private:
  using Memory = typename Newton::template Memory<Unknown>;

  [[gnu::cold]] void state(Snapshot& out, typename P::Vector& xi) const {
    out.step = steps_;
    out.time = time();
    if constexpr (requires { step_.velocity(*now_, xi); }) step_.velocity(*now_, xi);
    else problem_.velocity(now_->x, xi);
    hamel::state(whole_, now_->g, xi, out);
  }

  // One substep of the composition, with what it remembers of its own last solves.
  struct Stage {
    double coefficient;
    Extrapolation<Unknown> extrapolation;
    Memory memory;
    bool trusted = false;  // the last solution was the principal root
  };

  static P problem_of(const Whole& whole) {
    if constexpr (std::is_same_v<P, Whole>) return whole;
    else return whole.unconstrained();
  }

  [[gnu::always_inline]] SolveReport one_step() {
    if (stages_.size() == 1) [[likely]]
      return flat_substep(stages_.front());  // one that fails leaves the state alone
    return composed_step();
  }
  SolveReport composed_step() {
    put_away(start_of_step_);
    SolveReport total;
    for (Stage& stage : stages_) {
      const SolveReport report = flat_substep(stage);
      total.iterations += report.iterations;
      total.evaluations += report.evaluations;
      total.residual = std::max(total.residual, report.residual);
      total.reason = report.reason;
      if (!total.ok()) {
        fetch(start_of_step_);
        break;
      }
    }
    return total;
  }

  // Small products of fixed sizes, inlined: half the time of a step.
  SolveReport flat_substep(Stage& stage) {
    if constexpr (requires { requires Step::inlined; }) return inlined_substep(stage);
    else return substep(stage);
  }
  HAMEL_FLATTEN SolveReport inlined_substep(Stage& stage) { return substep(stage); }
  SolveReport substep(Stage& stage) {
    const double h = stage.coefficient * h_;
    step_.begin(*now_, h);
    SolveReport report;
    if constexpr (Scheme::explicit_step) {
      report.evaluations = Scheme::stages;
    } else {
      if (stage.extrapolation.count() == 0) step_.guess(x_);
      else stage.extrapolation(x_);
      report = solve(stage);
      if (!report.ok()) [[unlikely]]
        return report;
      if (!(stage.trusted && setup_.solver == nullptr && report.iterations <= kSure)) [[unlikely]] {
        if (!is_principal(stage, h)) report.reason = Reason::not_principal;
      }
    }
    if (report.ok() && !step_.finish(x_, *next_)) report.reason = why_not_finished();
    if (!report.ok()) [[unlikely]]
      return report;
    last_h_ = h;
    if constexpr (!Scheme::explicit_step) stage.extrapolation.push(x_);
    // A product of elements is off the group by some eps: eight of them stay well below 1e-14.
    if (++products_ == 8) {
      problem_.normalise(next_->g);
      products_ = 0;
    }
    Node* const free = previous_;
    previous_ = now_;
    now_ = next_;
    next_ = free;
    return report;
  }

  [[gnu::cold]] Reason why_not_finished() const {
    if constexpr (requires { step_.lost_constraints(); }) {
      if (step_.lost_constraints()) return Reason::lost_constraints;
    }
    return Reason::outside_domain;
  }

  // So many corrections with a kept Jacobian do not change the root; those by differences are kept longer.
  static constexpr int kSure = HasJacobian<Step> ? 1 : 2;

  // Whether x_ is the principal root (top of this file).
  [[gnu::noinline, gnu::cold]] bool is_principal(Stage& stage, double h) {
    if (Scheme::claim(setup_.s, symmetric_, setup_.mechanics->left_invariant()).order == 0) {
      return true;  // no limit, no principal root
    }
    if (stage.trusted && stage.extrapolation.count() > 0) {
      stage.extrapolation(guess_);
      if ((x_ - guess_).squaredNorm() <= 1e-4 * x_.squaredNorm()) return true;
    }
    const ErasedStep<Step> equation(step_);
    const StepOnPath<Unknown> path = {equation, [this](double size) { step_.begin(*now_, size); },
                                      [this](Unknown& x) { step_.guess(x); }};
    stage.trusted = root_.leads_to(x_, path, h, setup_.tolerance);
    return stage.trusted;
  }

  [[gnu::always_inline]] SolveReport solve(Stage& stage) {
    if (setup_.solver == nullptr) [[likely]]
      return Newton::solve(step_, x_, setup_.tolerance, stage.memory);
    return solve_outside();
  }
  [[gnu::noinline, gnu::cold]] SolveReport solve_outside() {
    const ErasedStep<Step> equation(step_);
    return setup_.solver->solve(OutsideEquation<Unknown>(equation, x_),
                                {x_.data(), static_cast<size_t>(x_.size())}, setup_.tolerance);
  }

  // A state between steps; a composed or rescued step that fails goes back to it.
  struct State {
    Node now, previous;
    double last_h;
  };
  void put_away(State& state) const {  // takes no memory
    state.now = *now_;
    state.previous = *previous_;
    state.last_h = last_h_;
  }
  void fetch(const State& state) {
    *now_ = state.now;
    *previous_ = state.previous;
    last_h_ = state.last_h;
  }
  [[gnu::cold]] SolveReport repeat_step() override { return one_step(); }
  [[gnu::cold]] void save() override { put_away(start_of_rescue_); }
  [[gnu::cold]] void restore() override { fetch(start_of_rescue_); }
  [[gnu::cold]] void forget() override {
    for (Stage& stage : stages_) {
      stage.extrapolation.forget();
      stage.trusted = stage.memory.valid = false;
    }
  }

  Whole whole_;
  Step step_;
  P problem_;
  double last_h_ = 1;
  bool symmetric_;
  int products_ = 0;
  Node nodes_[3];
  Node *now_ = &nodes_[0], *previous_ = &nodes_[1], *next_ = &nodes_[2];
  State start_of_step_, start_of_rescue_;
  Unknown x_, guess_;
  PrincipalRoot<Unknown, Newton> root_;
  std::vector<Stage> stages_;
};

}  // namespace hamel
