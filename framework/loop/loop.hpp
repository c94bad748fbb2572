// The one time loop: a scheme's step over a problem, its substeps where it is composed, the solver, and the
// measurements. Compiled for (scheme, problem, solver): with fixed sizes there is no heap and no virtual call in a step.
// What does not depend on the types is in time_loop.hpp; what is seldom done with a step's equation goes through
// step_equation.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <hamel/framework/loop/denormals.hpp>
#include <hamel/framework/loop/measure.hpp>
#include <hamel/framework/loop/step_control.hpp>
#include <hamel/framework/loop/time_loop.hpp>
#include <hamel/framework/loop/unknown.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

template <class Scheme, class Whole, class Newton>
class Loop final : public TimeLoop {
 public:
  using Step = typename Scheme::template Step<Whole>;
  using P = typename Step::Problem;  // Whole, or Whole without its rows
  using Node = hamel::Node<P>;
  static_assert(SchemeStep<Step>, "the scheme's Step does not satisfy hamel::SchemeStep");

  [[gnu::cold]] explicit Loop(const KernelSetup& setup)
      : TimeLoop(setup),
        whole_(setup.geometry, setup.mechanics),
        step_(step_of(whole_, setup)),
        problem_(problem_of(whole_)),
        nodes_{Node(problem_), Node(problem_), Node(problem_)},
        start_of_step_{*now_, *previous_, last_h_},
        start_of_rescue_(start_of_step_),
        unknown_(setup_, step_.size(), has_order()),
        stages_(setup.composition.size(), {1, Memory(unknown_.x)}) {
    if constexpr (requires { step_.take_forces_at_base(); }) {
      if (setup.forces_at_base) step_.take_forces_at_base();
    }
    problem_.from_coordinates(setup.configuration, now_->g);
    typename P::Vector velocity = as_vector(setup.velocity);
    problem_.carry(velocity, now_->x);
    now_->t = setup.from;
    *previous_ = *now_;
    if (chooses_steps()) {
      if constexpr (kEstimates) errors_.emplace(step_.estimated_order());
      else if constexpr (Scheme::varies_steps) reversible_.emplace(problem_);
      if (setup.first_chosen) choose_first();
    }
    for (size_t i = 0; i < stages_.size(); ++i) stages_[i].coefficient = setup.composition[i];
  }

  Status advance(long count) override {
    const FlushDenormals flushed;
    for (long k = 0; k < count; ++k) {
      const bool chosen = chooses_steps();
      if (chosen && now_->t == limit_) return {};
      SolveReport report = chosen ? chosen_step() : one_step();
      if (!report.ok()) [[unlikely]] {
        if (!chosen || !kEstimates) {
          report = recover(report);
          beginning_ = &start_of_rescue_.now;
        }
        if (!report.ok()) return failure(report);
      }
      tally(report);
      time_ = now_->t;
    }
    return {};
  }

  [[gnu::cold]] void state(Snapshot& out) const override {
    typename P::Vector xi(problem_.dim());
    state(*now_, out, xi);
  }
  [[gnu::cold]] void measure(Snapshot& out) const override { measure(*now_, out); }
  [[gnu::cold]] void node(Snapshot& out) const override { carried(*now_, out); }
  [[gnu::cold]] void beginning(Snapshot& out) const override { carried(*beginning_, out); }
  [[gnu::cold]] bool interpolate([[maybe_unused]] double t,
                                 [[maybe_unused]] Snapshot& out) override {
    if constexpr (kEstimates) {
      if (step_.estimated_order() == 0 || last_h_ == 0) return false;
      if (!step_.interpolate((t - previous_->t) / last_h_, *next_)) return false;
      measure(*next_, out);
      out.time = t;
      return true;
    }
    return false;
  }
  [[gnu::cold]] void turn_back() override {
    count_from(now_->t);
    h_ = -h_;
    limit_ = std::copysign(std::numeric_limits<double>::infinity(), h_);
    forget();
  }
  [[gnu::cold]] void restart(double t, std::span<const double> coordinates,
                             std::span<const double> velocity, double step) override {
    problem_.from_coordinates(coordinates, now_->g);
    typename P::Vector xi = as_vector(velocity);
    problem_.carry(xi, now_->x);
    now_->t = t;
    *previous_ = *now_;
    h_ = step;
    last_h_ = 0;
    limit_ = std::copysign(std::numeric_limits<double>::infinity(), h_);
    count_from(t);
    forget();
    if constexpr (Scheme::varies_steps) {
      if (reversible_) reversible_->forget();
    }
  }
  [[gnu::cold]] void forget() override {
    for (Stage& stage : stages_) stage.memory.forget();
    if constexpr (requires { step_.forget(); }) step_.forget();
  }

 private:
  using StepUnknown = hamel::StepUnknown<Scheme, Step, Newton>;
  using Memory = typename StepUnknown::Memory;
  static constexpr bool kEstimates = requires(const Step& step) { step.estimated_order(); };

  static Eigen::Map<const Eigen::VectorXd> as_vector(std::span<const double> values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
  }
  static Step step_of(const Whole& whole, const KernelSetup& setup) {
    if constexpr (std::is_constructible_v<Step, const Whole&, const Tableau&>)
      return Step(whole, *setup.tableau);
    else return Step(whole, setup.s);
  }

  [[gnu::cold]] void state(const Node& node, Snapshot& out, typename P::Vector& xi) const {
    out.step = steps_;
    out.time = &node == now_ ? time() : node.t;
    if constexpr (requires { step_.velocity(node, xi); }) step_.velocity(node, xi);
    else problem_.velocity(node.x, xi);
    hamel::state(whole_, node.g, xi, out);
  }
  [[gnu::cold]] void carried(const Node& node, Snapshot& out) const {
    typename P::Vector xi(problem_.dim());
    problem_.velocity(node.x, xi);
    hamel::state(whole_, node.g, xi, out);
    out.time = node.t;
  }
  // A step that keeps its rows at its end by itself is measured there, others along the step.
  [[gnu::cold]] void measure(const Node& node, Snapshot& out) const {
    typename P::Vector xi(problem_.dim());
    state(node, out, xi);
    double h = last_h_;
    if constexpr (kEstimates) h = step_.estimated_order() > 0 ? 0 : h;
    hamel::measure(whole_, {previous_->g, previous_->t, node.g, node.t, h}, setup_.s, xi, out);
    out.lag = (1 - setup_.s) * h;
    out.iterations = last_.iterations;
    out.residual = last_.residual;
  }

  // One substep of the composition.
  struct Stage {
    double coefficient;
    Memory memory;
  };

  static P problem_of(const Whole& whole) {
    if constexpr (std::is_same_v<P, Whole>) return whole;
    else return whole.unconstrained();
  }

  [[gnu::always_inline]] SolveReport one_step() {
    if (setup_.inputs != nullptr) [[unlikely]]
      enter_inputs();
    if (stages_.size() > 1) [[unlikely]]
      return composed_step();
    const SolveReport report =
        flat_substep(stages_.front());  // one that fails leaves the state alone
    beginning_ = previous_;
    return report;
  }
  // Forces that are remembered from the end of the last step are those of its inputs.
  [[gnu::noinline, gnu::cold]] void enter_inputs() {
    setup_.inputs->enter(now_->t, h_);
    if (setup_.inputs->changes() == inputs_changed_) return;
    inputs_changed_ = setup_.inputs->changes();
    if constexpr (requires { step_.forget(); }) step_.forget();
  }
  // A step of a size chosen by the error: explicit pairs take one again that is too large.
  [[gnu::noinline]] SolveReport chosen_step() {
    if constexpr (kEstimates) return error_controlled_step();
    const double end = end_of_step(now_->t), left = end - now_->t;
    if constexpr (Scheme::varies_steps) {
      const double epsilon = std::pow(setup_.relative + setup_.absolute, 1.0 / setup_.order);
      h_ = reversible_->next(*now_, epsilon, h_);
    }
    const bool cut = std::abs(h_) >= std::abs(left);
    if (cut) {
      h_ = left;
      forget();
    }
    const SolveReport report = one_step();
    if (cut && report.ok()) now_->t = end;
    return report;
  }
  SolveReport error_controlled_step() {
    const double end = end_of_step(now_->t);
    SolveReport total;
    const auto taken = errors_->take(h_, end - now_->t, smallest_step(now_->t), [&] {
      error_ = std::numeric_limits<double>::infinity();  // of a step that fails
      total.evaluations += one_step().evaluations;
      return error_;
    });
    if (taken.whole) now_->t = end;
    stats_.rejected += taken.rejected;
    total.reason = taken.reason;
    return total;
  }
  [[gnu::cold]] void choose_first() {
    if constexpr (kEstimates)
      h_ = std::copysign(step_.first_step(*now_, setup_.relative, setup_.absolute), h_);
  }
  SolveReport composed_step() {
    put_away(start_of_step_);
    beginning_ = &start_of_step_.now;
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
      report.evaluations = step_.evaluations();
    } else {
      report = unknown_.solve(step_, *now_, h, stage.memory);
    }
    if (report.ok()) {
      if (!step_.finish(unknown_.x, *next_)) report.reason = why_not_finished();
      else if (!std::isfinite(next_->x.sum())) report.reason = Reason::not_finite;  // a force there
    }
    if constexpr (kEstimates) {
      if (errors_ && report.ok()) {
        error_ = step_.error(*next_, setup_.relative, setup_.absolute);
        if (!(error_ <= 1)) report.reason = Reason::rejected;
      }
    }
    if (!report.ok()) [[unlikely]]
      return report;
    last_h_ = h;
    if constexpr (!Scheme::explicit_step) stage.memory.extrapolation.push(unknown_.x);
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
      if (step_.not_finite()) return Reason::not_finite;
      if (step_.lost_constraints()) return Reason::lost_constraints;
    }
    return Reason::outside_domain;
  }

  bool has_order() const {
    if constexpr (Scheme::explicit_step) return true;
    else
      return Scheme::claim(setup_.s, whole_.symmetric(), setup_.mechanics->left_invariant()).order >
             0;
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

  Whole whole_;
  Step step_;
  P problem_;
  double last_h_ = 0;  // of the last substep; 0 before the first
  int products_ = 0;
  Node nodes_[3];
  Node *now_ = &nodes_[0], *previous_ = &nodes_[1], *next_ = &nodes_[2];
  const Node* beginning_ = &nodes_[0];  // of the last step
  State start_of_step_, start_of_rescue_;
  StepUnknown unknown_;
  std::vector<Stage> stages_;
  // Where steps are chosen.
  std::optional<ErrorControl> errors_;
  std::optional<ReversibleControl<P>> reversible_;
  double error_ = 0;
};

}  // namespace hamel
