// The one time loop: a scheme's substep over a problem, the solver, and the measurements. Compiled
// for (scheme, problem, solver): with fixed sizes there is no heap and no virtual call in a
// substep. What is done with substeps does not depend on the types and is compiled once
// (time_loop.hpp); what is seldom done with a step's equation goes through step_equation.hpp.
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <vector>

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
        kept_{{*now_, *previous_, last_h_}, {*now_, *previous_, last_h_}},
        unknown_(setup_, step_.size(), has_order()),
        memories_(setup.composition.size(), Memory(unknown_.x)) {
    if constexpr (requires { step_.take_forces_at_base(); }) {
      if (setup.forces_at_base) step_.take_forces_at_base();
    }
    put(setup.from, setup.configuration, setup.velocity);
    if (!chooses_steps()) return;
    if constexpr (kEstimates) {
      errors_.emplace(step_.estimated_order());
      if (setup.first_chosen)
        h_ = std::copysign(step_.first_step(*now_, setup_.relative, setup_.absolute), h_);
    } else if constexpr (Scheme::varies_steps) {
      rate_ = std::make_unique<RateOf<P>>(problem_);
    }
  }

  [[gnu::cold]] void state(Snapshot& out) const override {
    typename P::Vector xi(problem_.dim());
    state(*now_, out, xi);
  }
  [[gnu::cold]] void measure(Snapshot& out) const override { measure(*now_, out); }
  [[gnu::cold]] void node(Snapshot& out) const override { carried(*now_, out); }
  [[gnu::cold]] void beginning(Snapshot& out) const override {
    switch (beginning_) {
      case Beginning::previous: return carried(*previous_, out);
      case Beginning::step: return carried(kept(Kept::step).now, out);
      case Beginning::rescue: return carried(kept(Kept::rescue).now, out);
    }
  }
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
  [[gnu::cold]] void forget() override {
    for (Memory& memory : memories_) memory.forget();
    forget_forces();
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

  static P problem_of(const Whole& whole) {
    if constexpr (std::is_same_v<P, Whole>) return whole;
    else return whole.unconstrained();
  }

  // Small products of fixed sizes, inlined: half the time of a step.
  SolveReport substep(int place, double h) override {
    if constexpr (requires { requires Step::inlined; }) return inlined_substep(place, h);
    else return plain_substep(place, h);
  }
  HAMEL_FLATTEN SolveReport inlined_substep(int place, double h) { return plain_substep(place, h); }
  SolveReport plain_substep(int place, double h) {
    Memory& memory = memories_[static_cast<size_t>(place)];
    step_.begin(*now_, h);
    SolveReport report;
    if constexpr (Scheme::explicit_step) {
      report.evaluations = step_.evaluations();
    } else {
      report = unknown_.solve(step_, *now_, h, memory);
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
    if constexpr (!Scheme::explicit_step) memory.extrapolation.push(unknown_.x);
    // A product of elements is off the group by some eps: eight of them stay well below 1e-14.
    if (++products_ == 8) {
      problem_.normalise(next_->g);
      products_ = 0;
    }
    Node* const free = previous_;
    previous_ = now_;
    now_ = next_;
    next_ = free;
    t_ = now_->t;
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

  [[gnu::cold]] void forget_forces() override {
    if constexpr (requires { step_.forget(); }) step_.forget();
  }
  [[gnu::cold]] double controlled_size([[maybe_unused]] double epsilon) override {
    if constexpr (Scheme::varies_steps && !kEstimates) {
      rate_->look_at(*now_);
      return control_.next(*rate_, epsilon, h_);
    } else {
      return h_;
    }
  }
  [[gnu::cold]] void end_at(double t) override { now_->t = t; }
  [[gnu::cold]] void put(double t, std::span<const double> coordinates,
                         std::span<const double> velocity) override {
    problem_.from_coordinates(coordinates, now_->g);
    typename P::Vector xi = as_vector(velocity);
    problem_.carry(xi, now_->x);
    now_->t = t_ = t;
    *previous_ = *now_;
    last_h_ = 0;
    control_.forget();
  }

  struct State {
    Node now, previous;
    double last_h;
  };
  State& kept(Kept where) { return kept_[where == Kept::step ? 0 : 1]; }
  const State& kept(Kept where) const { return kept_[where == Kept::step ? 0 : 1]; }
  [[gnu::cold]] void put_away(Kept where) override {  // takes no memory
    State& state = kept(where);
    state.now = *now_;
    state.previous = *previous_;
    state.last_h = last_h_;
  }
  [[gnu::cold]] void fetch(Kept where) override {
    const State& state = kept(where);
    *now_ = state.now;
    *previous_ = state.previous;
    last_h_ = state.last_h;
    t_ = now_->t;
  }

  Whole whole_;
  Step step_;
  P problem_;
  double last_h_ = 0;  // of the last substep; 0 before the first
  int products_ = 0;
  Node nodes_[3];
  Node *now_ = &nodes_[0], *previous_ = &nodes_[1], *next_ = &nodes_[2];
  State kept_[2];
  StepUnknown unknown_;
  std::vector<Memory> memories_;     // of each substep of the composition
  std::unique_ptr<RateOf<P>> rate_;  // where symmetric steps are chosen
  ReversibleControl control_;
};

}  // namespace hamel
