// The one time loop: a scheme's substep over a problem, the solver, and the measurements. Compiled
// for (scheme, problem, solver): with fixed sizes there is no heap and no virtual call in a
// substep. Whatever is done with substeps does not depend on the types and is compiled once
// (time_loop.hpp); rare uses of a step's equation go through step_equation.hpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include <hamel/framework/loop/implicit_solve.hpp>
#include <hamel/framework/loop/logged_element.hpp>
#include <hamel/framework/loop/measure.hpp>
#include <hamel/framework/loop/node_ring.hpp>
#include <hamel/framework/loop/step_control.hpp>
#include <hamel/framework/loop/time_loop.hpp>
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
      : Loop(setup, Whole(setup.geometry, setup.mechanics),
             [&setup](const Whole& whole) { return step_of(whole, setup); }) {}
  template <class MakeStep>
  [[gnu::cold]] Loop(const KernelSetup& setup, const Whole& whole, const MakeStep& make_step)
      : TimeLoop(setup),
        whole_(whole),
        step_(make_step(whole_)),
        problem_(problem_of(whole_)),
        nodes_(problem_),
        kept_{{nodes_.now(), nodes_.previous(), last_h_},
              {nodes_.now(), nodes_.previous(), last_h_}},
        unknown_(setup_, step_, has_order()),
        memories_(setup.composition.size(), unknown_.memory()) {
    put(setup.from, setup.configuration, setup.velocity);
    if (!chooses_steps()) return;
    if constexpr (kEstimates) {
      errors_.emplace(step_.estimated_order());
      if (setup.first_chosen) h_ = std::copysign(step_.first_step(nodes_.now(), setup_.errors), h_);
    } else if constexpr (kSymmetric) {
      rate_ = std::make_unique<RateOf<P>>(problem_);
    }
  }

  using Kernel::state;
  [[gnu::cold]] void state(Snapshot& out, const StateParts& parts) const override {
    state(nodes_.now(), out, parts);
  }
  void measure(std::span<const double> logged, Snapshot& out, const StateParts& parts) override {
    Node &now = nodes_.now(), &before = nodes_.previous();
    const double* from = logged.data();
    steps_ = static_cast<long>(from[StateLog::kStep]);
    now.t = from[2];
    before.t = from[3];
    last_h_ = from[4];
    last_.iterations = static_cast<int>(from[5]);
    last_.residual = from[6];
    xi_ = Eigen::Map<const typename P::Vector>(from += StateLog::kNumbers, problem_.dim());
    load_element(problem_, from += problem_.dim(), now.g);
    load_element(problem_, from + logged_size(problem_, now.g), before.g);
    state(now, xi_, logged[StateLog::kTime], out, parts);
  }
  bool log_to(StateLog* log, bool within) override {
    if constexpr (kEstimates) within = within && step_.estimated_order() <= 0;
    if (within) return false;
    log_ = log;
    return true;
  }
  bool log_state(double t) override {
    const double h = time() - beginning_time();
    if (std::abs(t - time()) <= 1e-12 * std::abs(h == 0 ? h_ : h)) {
      append(nodes_.now(), t);
      return true;
    }
    if constexpr (kEstimates) {
      if ((t - time()) * h_ > 0 || !has_dense_output() ||
          !step_.interpolate(part_of_step(t), nodes_.next()))
        return false;
      append(nodes_.next(), t);
      return true;
    }
    return false;
  }
  [[gnu::cold]] void node(Snapshot& out) const override { carried(nodes_.now(), out); }
  [[gnu::cold]] void beginning(Snapshot& out) const override { carried(first_node(), out); }
  double beginning_time() const override { return first_node().t; }
  [[gnu::cold]] bool interpolate(double t, Snapshot& out) override {
    if constexpr (kEstimates) {
      if (!has_dense_output() || !step_.interpolate(part_of_step(t), nodes_.next())) return false;
      state(nodes_.next(), out, {});
      out.time = t;
      return true;
    }
    return false;
  }
  [[gnu::cold]] bool motion_within(double t, Snapshot& out) override {
    if constexpr (kEstimates) {
      if (!has_dense_output() || !step_.interpolate_freely(part_of_step(t), nodes_.next()))
        return false;
      problem_.velocity(nodes_.next().x, xi_);
      hamel::state(whole_, nodes_.next().g, xi_, out,
                   {.coordinates = false, .momentum = false, .energy = false});
      out.time = t;
      return true;
    }
    return false;
  }
  [[gnu::cold]] std::unique_ptr<Kernel> another(const KernelSetup& setup) const override {
    if constexpr (std::is_same_v<P, Whole> && P::left_invariant) {
      auto out = std::make_unique<Loop>(setup, whole_, [this](const Whole&) { return step_; });
      out->forget_forces();
      return out;
    } else {
      return nullptr;
    }
  }
  [[gnu::cold]] void clear_history() override {
    for (Memory& memory : memories_) memory.clear_history();
    forget_forces();
  }

 private:
  using StepUnknown = hamel::StepUnknown<Scheme, Step, Newton>;
  using Memory = typename StepUnknown::Memory;
  static constexpr bool kEstimates = requires(const Step& step) { step.estimated_order(); };
  static constexpr bool kSymmetric = Scheme::step_choice == StepChoice::symmetric;

  static Eigen::Map<const Eigen::VectorXd> as_vector(std::span<const double> values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
  }
  static Step step_of(const Whole& whole, const KernelSetup& setup) {
    if constexpr (std::is_constructible_v<Step, const Whole&, const Tableau&>)
      return Step(whole, *setup.tableau);
    else if constexpr (std::is_constructible_v<Step, const Whole&, double, ForceAt>)
      return Step(whole, setup.s, setup.force_at);
    else return Step(whole, setup.s);
  }

  bool has_dense_output() const { return step_.estimated_order() > 0 && last_h_ != 0; }
  double part_of_step(double t) const { return (t - nodes_.previous().t) / last_h_; }

  [[gnu::cold]] void carried(const Node& node, Snapshot& out) const {
    problem_.velocity(node.x, xi_);
    hamel::state(whole_, node.g, xi_, out, {});
    out.time = node.t;
  }
  // A step that keeps its rows at its end by itself is measured there, others along the step.
  double measured_size() const {
    if constexpr (kEstimates) return step_.estimated_order() > 0 ? 0 : last_h_;
    return last_h_;
  }
  LastStep<typename P::Element> last_step(const Node& node) const {
    return {nodes_.previous().g, nodes_.previous().t, node.g, node.t, measured_size()};
  }
  void nodal_velocity(const Node& node, typename P::Vector& xi) const {
    if constexpr (requires { step_.velocity(node, xi); }) step_.velocity(node, xi);
    else problem_.velocity(node.x, xi);
  }
  [[gnu::cold]] void state(const Node& node, Snapshot& out, const StateParts& parts) const {
    nodal_velocity(node, xi_);
    state(node, xi_, &node == &nodes_.now() ? time() : node.t, out, parts);
  }
  void state(const Node& node, const typename P::Vector& xi, double t, Snapshot& out,
             const StateParts& parts) const {
    out.step = steps_;
    out.time = t;
    hamel::state(whole_, node.g, xi, out, parts);
    if (!parts.measures) return;
    hamel::measure(whole_, last_step(node), setup_.s, xi, out);
    out.time_offset = (1 - setup_.s) * measured_size();
    out.iterations = last_.iterations;
    out.residual = last_.residual;
  }

  void log_node() override { append(nodes_.now(), time()); }
  void append(const Node& now, double t) {
    StateLog& log = *log_;
    nodal_velocity(now, xi_);
    log.flawed = log.flawed || !is_state(now);
    if (log.flawed) return;
    const std::size_t size = logged_size(problem_, now.g);
    const auto n = static_cast<std::size_t>(problem_.dim());
    double* to = log.append(StateLog::kNumbers + n + 2 * size);
    const double numbers[StateLog::kNumbers] = {static_cast<double>(steps_),
                                                t,
                                                now.t,
                                                nodes_.previous().t,
                                                last_h_,
                                                static_cast<double>(last_.iterations),
                                                last_.residual};
    to = std::copy_n(numbers, StateLog::kNumbers, to);
    to = std::copy_n(xi_.data(), n, to);
    log_element(problem_, now.g, to);
    log_element(problem_, nodes_.previous().g, to + size);
  }
  // Finite, an element of the group, and, where the step itself did not see to it, one that is
  // recovered from its configurations.
  bool is_state(const Node& node) {
    if (!std::isfinite(xi_.squaredNorm()) || !std::isfinite(whole_.potential(node.g))) return false;
    if constexpr (ExplicitStep<Step>) {
      const LastStep<typename P::Element> last = last_step(node);
      if (last.h != 0 && !std::isfinite(recover_rates(whole_, last, setup_.s, xi_, rates_)))
        return false;
    }
    return is_element(problem_, node.g, coordinates_);
  }

  static P problem_of(const Whole& whole) {
    if constexpr (std::is_same_v<P, Whole>) return whole;
    else return whole.unconstrained();
  }

  // Small products of fixed sizes, inlined: half the time of a step.
  void substep(int place, double h, SolveReport& report) override {
    if constexpr (requires { requires Step::inlined; }) inlined_substep(place, h, report);
    else plain_substep(place, h, report);
  }
  HAMEL_FLATTEN void inlined_substep(int place, double h, SolveReport& report) {
    plain_substep(place, h, report);
  }
  void plain_substep(int place, double h, SolveReport& report) {
    Memory& memory = memories_[static_cast<size_t>(place)];
    step_.begin(nodes_.now(), h);
    unknown_.solve(step_, nodes_.now(), h, memory, report);
    if (report.ok()) {
      if constexpr (NormalisesElement<Step>) step_.normalise_when(nodes_.due());
      if (!unknown_.finish(step_, nodes_.next())) report.reason = why_not_finished();
      else if (!std::isfinite(nodes_.next().x.sum()))
        report.reason = Reason::not_finite;  // a force there
    }
    if constexpr (kEstimates) {
      if (errors_ && report.ok()) {
        error_ = step_.error(nodes_.next(), setup_.errors);
        if (!(error_ <= 1)) report.reason = Reason::rejected;
      }
    }
    if (!report.ok()) [[unlikely]]
      return;
    last_h_ = h;
    unknown_.keep(memory);
    nodes_.turn(problem_, NormalisesElement<Step>);
    t_ = nodes_.now().t;
  }

  [[gnu::cold]] Reason why_not_finished() const {
    if constexpr (requires { step_.lost_constraints(); }) {
      if (step_.not_finite()) return Reason::not_finite;
      if (step_.lost_constraints()) return Reason::lost_constraints;
    }
    return Reason::outside_domain;
  }

  bool has_order() const {
    if constexpr (ExplicitStep<Step>) return true;
    else
      return Scheme::claim(setup_.s, whole_.symmetric(), setup_.mechanics->left_invariant()).order >
             0;
  }

  [[gnu::cold]] void move_history(Nearby to) override {
    for (Memory& memory : memories_) memory.move(to);
    forget_forces();
  }
  [[gnu::cold]] void forget_forces() override {
    if constexpr (requires { step_.clear_history(); }) step_.clear_history();
  }
  [[gnu::cold]] double controlled_size([[maybe_unused]] double epsilon) override {
    if constexpr (kSymmetric && !kEstimates) {
      rate_->look_at(nodes_.now());
      if (!control_.started()) rate_->set_length(h_);
      return control_.next(*rate_, epsilon, h_);
    } else {
      return h_;
    }
  }
  [[gnu::cold]] void end_at(double t) override { nodes_.now().t = t; }
  [[gnu::cold]] void put(double t, std::span<const double> coordinates,
                         std::span<const double> velocity) override {
    problem_.from_coordinates(coordinates, nodes_.now().g);
    xi_ = as_vector(velocity);
    problem_.to_state(xi_, nodes_.now().x);
    nodes_.now().t = t_ = t;
    nodes_.previous() = nodes_.now();
    last_h_ = 0;
    control_.clear_history();
  }

  struct State {
    Node now, previous;
    double last_h;
  };
  // Node at which the last step began.
  const Node& first_node() const {
    switch (beginning_) {
      case Beginning::step: return kept(Kept::step).now;
      case Beginning::rescue: return kept(Kept::rescue).now;
      default: return nodes_.previous();
    }
  }
  State& kept(Kept where) { return kept_[where == Kept::step ? 0 : 1]; }
  const State& kept(Kept where) const { return kept_[where == Kept::step ? 0 : 1]; }
  [[gnu::cold]] void put_away(Kept where) override {  // takes no memory
    State& state = kept(where);
    state.now = nodes_.now();
    state.previous = nodes_.previous();
    state.last_h = last_h_;
  }
  [[gnu::cold]] void fetch(Kept where) override {
    const State& state = kept(where);
    nodes_.now() = state.now;
    nodes_.previous() = state.previous;
    last_h_ = state.last_h;
    t_ = nodes_.now().t;
  }

  Whole whole_;
  Step step_;
  P problem_;
  mutable typename P::Vector xi_ = P::Vector::Zero(problem_.dim());  // work space
  std::vector<double> coordinates_, rates_;                          // of what is logged
  double last_h_ = 0;  // of the last substep; 0 before the first
  NodeRing<P> nodes_;
  State kept_[2];
  StepUnknown unknown_;
  std::vector<Memory> memories_;     // of each substep of the composition
  std::unique_ptr<RateOf<P>> rate_;  // where symmetric steps are chosen
  ReversibleControl control_;
};

}  // namespace hamel
