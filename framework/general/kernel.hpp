// The time loop of a general system: the erased step of a scheme, Newton or another solver, and the
// measurements. One instantiation serves every group, retraction, scheme and system.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <hamel/framework/general/motion.hpp>
#include <hamel/framework/general/step.hpp>
#include <hamel/framework/time_loop.hpp>

namespace hamel {

template <class Newton>
class GeneralKernel final : public TimeLoop<GeneralKernel<Newton>> {
  using Loop = TimeLoop<GeneralKernel>;
  friend Loop;
  using Loop::composition_, Loop::h_, Loop::last_, Loop::solver_, Loop::steps_, Loop::tolerance_;

 public:
  GeneralKernel(const KernelSetup& setup, const GeneralSetup& general,
                std::unique_ptr<GeneralStep> step)
      : Loop(setup),
        geometry_(general.geometry),
        system_(general.mechanics),
        step_(std::move(step)),
        place_(*system_),
        s_(general.s),
        stages_(setup.composition.size()) {
    now_.g.resize(geometry_->size());
    geometry_->from_coordinates(setup.configuration, now_.g.data());
    now_.xi = setup.velocity;
    start_of_step_ = previous_ = before_ = next_ = now_;
    x_.resize(step_->size());
    for (Stage& stage : stages_) {
      for (Eigen::VectorXd& x : stage.x) x.resize(step_->size());
      stage.memory.work.resize(x_);
      stage.memory.jacobian.setIdentity(step_->size(), step_->size());
      if (step_->size() > 0) stage.memory.factors.compute(stage.memory.jacobian);
    }
  }

  void measure(Snapshot& out) const override {
    out.step = steps_;
    out.time = static_cast<double>(steps_) * h_;
    out.coordinates.resize(static_cast<size_t>(geometry_->columns()));
    geometry_->coordinates(now_.g.data(), out.coordinates.data());
    out.velocity.assign(now_.xi.begin(), now_.xi.end());
    place_.set(*system_, now_.t, now_.g.data());
    const Eigen::VectorXd momentum = place_.inertia * now_.xi;
    out.momentum.assign(momentum.begin(), momentum.end());
    out.energy = 0.5 * momentum.dot(now_.xi) + system_->potential(now_.g.data());
    out.constraint = recovered_residual();
    Eigen::VectorXd phi(system_->holonomic_rows());
    system_->holonomic(now_.g.data(), phi);
    out.holonomic = phi.size() == 0 ? 0.0 : phi.template lpNorm<Eigen::Infinity>();
    out.group_defect = geometry_->defect(now_.g.data());
    out.iterations = last_.iterations;
    out.residual = last_.residual;
  }

 private:
  // The guess is the polynomial extrapolation of up to six solutions (as in CompiledKernel).
  struct Stage {
    std::array<Eigen::VectorXd, 6> x;
    int count = 0;
    typename Newton::template Memory<GeneralStep> memory;

    void push(const Eigen::VectorXd& latest) {
      std::rotate(x.begin(), x.end() - 1, x.end());
      x[0] = latest;
      if (count < 6) ++count;
    }
    void extrapolate(Eigen::VectorXd& out) const {
      static constexpr double weights[6][6] = {
          {1}, {2, -1}, {3, -3, 1}, {4, -6, 4, -1}, {5, -10, 10, -5, 1}, {6, -15, 20, -15, 6, -1}};
      const double* weight = weights[count - 1];
      out.setZero();
      for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
        const double* from = x[i].data();
        for (Eigen::Index j = 0; j < out.size(); ++j) out.data()[j] += weight[i] * from[j];
      }
    }
  };

  // |A v - b| of the last substep, v recovered from its two configurations.
  double recovered_residual() const {
    if (system_->rows() == 0) return 0;
    Eigen::VectorXd v = now_.xi, base = now_.g;
    double t = now_.t;
    if (steps_ > 0) {
      Eigen::VectorXd delta(geometry_->size());
      geometry_->inverse(previous_.g.data(), delta.data());
      geometry_->compose(delta.data(), now_.g.data(), delta.data());
      if (!recover_step(*geometry_, delta.data(), s_, v)) {
        return std::numeric_limits<double>::quiet_NaN();
      }
      Eigen::VectorXd z = -s_ * v;
      geometry_->tau(z.data(), delta.data());
      geometry_->inverse(delta.data(), delta.data());
      geometry_->compose(previous_.g.data(), delta.data(), base.data());
      const double h = now_.t - previous_.t;
      t = previous_.t + s_ * h;
      v /= h;
    }
    place_.set(*system_, t, base.data());
    const Eigen::VectorXd rows = place_.a * v - place_.b;
    return rows.head(rows.size() - system_->holonomic_rows()).norm();
  }

  SolveReport one_step() {
    const bool composed = stages_.size() > 1;  // else a failed substep leaves the state alone
    if (composed) {
      start_of_step_ = now_;
      before_ = previous_;
    }
    SolveReport total;
    for (size_t i = 0; i < stages_.size(); ++i) {
      const SolveReport report = substep(stages_[i], composition_[i] * h_);
      total.iterations += report.iterations;
      total.evaluations += report.evaluations;
      total.residual = std::max(total.residual, report.residual);
      total.reason = report.reason;
      if (!total.ok()) {
        if (composed) {
          now_ = start_of_step_;
          previous_ = before_;
        }
        break;
      }
    }
    return total;
  }

  using State = std::pair<Node, Node>;
  State save() const { return {now_, previous_}; }
  void restore(const State& state) {
    now_ = state.first;
    previous_ = state.second;
  }
  void forget() {
    for (Stage& stage : stages_) {
      stage.count = 0;
      stage.memory.valid = false;
    }
  }

  SolveReport substep(Stage& stage, double h) {
    step_->begin(now_, h);
    SolveReport report;
    if (step_->size() > 0) {
      if (stage.count == 0) step_->guess(x_);
      else stage.extrapolate(x_);
      report = solve(stage);
    }
    if (report.ok() && !step_->finish(x_, next_)) report.reason = Reason::outside_domain;
    if (!report.ok()) return report;
    if (step_->size() > 0) stage.push(x_);
    std::swap(previous_, now_);
    std::swap(now_, next_);
    return report;
  }

  SolveReport solve(Stage& stage) {
    if (solver_ == nullptr) return Newton::solve(*step_, x_, tolerance_, stage.memory);
    return solver_->solve(ErasedEquation(*step_), {x_.data(), static_cast<size_t>(x_.size())},
                          tolerance_);
  }

  class ErasedEquation final : public Equation {
   public:
    explicit ErasedEquation(const GeneralStep& step)
        : step_(step), x_(step.size()), f_(step.size()) {}
    int size() const override { return step_.size(); }
    double scale() const override { return std::sqrt(step_.scale_squared()); }
    void evaluate(std::span<const double> x, std::span<double> f,
                  std::span<double> jacobian) const override {
      const Eigen::Index n = step_.size();
      x_ = Eigen::Map<const Eigen::VectorXd>(x.data(), n);
      if (jacobian.empty()) {
        step_.residual(x_, f_);
      } else {
        step_.linearise(x_, f_, j_);
        Eigen::Map<Eigen::MatrixXd>(jacobian.data(), n, n) = j_;
      }
      Eigen::Map<Eigen::VectorXd>(f.data(), n) = f_;
    }

   private:
    const GeneralStep& step_;
    mutable Eigen::VectorXd x_, f_;
    mutable Eigen::MatrixXd j_;
  };

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> system_;
  std::unique_ptr<GeneralStep> step_;
  mutable Place<> place_;
  double s_;
  Node now_, previous_, next_, start_of_step_, before_;
  Eigen::VectorXd x_;
  std::vector<Stage> stages_;
};

}  // namespace hamel
