// The time loop in lanes of a scheme for a problem: W bodies with their own parameters and starts.
// The batch takes the steps (lane_steps.hpp); this half has the scalar solver and the measurements.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <hamel/framework/lanes/lane_batch.hpp>
#include <hamel/framework/loop/implicit_solve.hpp>
#include <hamel/framework/loop/lane_kernel.hpp>
#include <hamel/framework/loop/measure.hpp>

namespace hamel {

/// P: the problem of one body; Newton: solvers/newton.hpp.
template <class Scheme, class P, class Newton>
class LaneLoop final : public LaneKernel, private LaneRescue<P> {
 public:
  using Step = LaneStep<Scheme, P>;
  using Node = hamel::Node<P>;

  /// Null where the step of this s is not one of lanes.
  static std::unique_ptr<LaneKernel> make(std::span<const KernelSetup> setups,
                                          LaneMaker<Scheme, P> batch) {
    if constexpr (kImplicit) {
      if (!Step::in_lanes(setups.front().s)) return nullptr;
    }
    return std::make_unique<LaneLoop>(setups, batch);
  }
  LaneLoop(std::span<const KernelSetup> setups, LaneMaker<Scheme, P> maker) {
    for (const KernelSetup& setup : setups) bodies_.push_back(std::make_unique<Body>(setup));
    std::vector<const P*> problems;
    std::vector<const Step*> steps;
    for (const auto& body : bodies_) {
      problems.push_back(&body->problem);
      steps.push_back(&body->step);
    }
    const KernelSetup& common = bodies_.front()->setup;
    const double enough = Newton::aim(common.tolerance);
    batch_ =
        maker({problems, steps, common.step, enough, std::min(enough, common.tolerance), this});
    restart(setups);
  }

  void advance(long count) override {
    batch_->advance(count);
    steps_ += count;
  }
  bool failed(int lane) const override { return batch_->failed(lane); }
  void state(int lane, Snapshot& out, const StateParts& parts) const override {
    const Body& body = *bodies_[static_cast<std::size_t>(lane)];
    Node now(body.problem), previous(body.problem);
    batch_->get(lane, now, parts.measures ? &previous : nullptr);
    typename P::Vector xi;
    body.problem.velocity(now.x, xi);
    const double h = steps_ == 0 ? 0 : body.setup.step;
    out.step = steps_;
    out.time = body.setup.from + static_cast<double>(steps_) * body.setup.step;
    out.time_offset = (1 - body.setup.s) * h;
    hamel::state(body.problem, now.g, xi, out, parts);
    if (!parts.measures) return;
    hamel::measure(body.problem, {previous.g, previous.t, now.g, now.t, h}, body.setup.s, xi, out);
  }
  void restart(std::span<const KernelSetup> setups) override {
    steps_ = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Body& body = *bodies_[i];
      body.put(setups[i]);
      batch_->put(static_cast<int>(i), body.node);
    }
  }

 private:
  static constexpr bool kImplicit = ImplicitStep<Step>;
  using StepUnknown = hamel::StepUnknown<Scheme, Step, Newton>;
  using Solve = typename LaneRescue<P>::Solve;

  static Step step_of(const P& problem, const KernelSetup& setup) {
    if constexpr (kImplicit) return Step(problem, setup.s);
    else return Step(problem, Scheme::tableau());
  }
  struct Body {
    explicit Body(const KernelSetup& given)
        : setup(given),
          problem(setup.geometry, setup.mechanics),
          step(step_of(problem, setup)),
          node(problem),
          unknown(setup, step, true),
          memory(unknown.memory()) {}
    void put(const KernelSetup& start) {
      problem.from_coordinates(start.configuration, node.g);
      const Eigen::Map<const Eigen::VectorXd> xi(start.velocity.data(), problem.dim());
      problem.to_state(typename P::Vector(xi), node.x);
      node.t = start.from;
      memory = unknown.memory();
    }
    KernelSetup setup;
    P problem;
    Step step;
    Node node;
    StepUnknown unknown;
    typename StepUnknown::Memory memory;
  };

  bool solve(int lane, Solve& step) override {
    if constexpr (kImplicit) {
      Body& body = *bodies_[static_cast<std::size_t>(lane)];
      body.node.x = step.node;
      body.memory.extrapolation.restore(step.differences, step.count);
      body.step.begin(body.node, body.setup.step);
      // The batch has tried the Jacobian that it kept.
      if (HasJacobian<Step> && body.memory.trusted) body.memory.newton.valid = false;
      SolveReport report;
      body.unknown.solve(body.step, body.node, body.setup.step, body.memory, report);
      if (!report.ok()) return false;
      step.x = body.unknown.x();
      step.inverse = body.memory.newton.factors.matrix();
      step.trusted = body.memory.trusted;
      step.kept = body.memory.newton.valid && step.trusted;
    }
    return true;
  }

  std::vector<std::unique_ptr<Body>> bodies_;
  std::unique_ptr<LaneBatch<P>> batch_;
  long steps_ = 0;
};

}  // namespace hamel
