// The time loop of a general system: the erased step of a scheme, Newton or another solver, and the
// measurements. One instantiation serves every group, retraction, scheme and system.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include <hamel/framework/mechanics/motion.hpp>
#include <hamel/framework/schemes/general_step.hpp>
#include <hamel/framework/loop/time_loop.hpp>

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
      prepare(stage.memory, x_);
    }
    guess_ = path_x_ = x_;
    prepare(path_memory_, x_);
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
    out.constraint = recover_rates(out.row_rates);
    Eigen::VectorXd phi(system_->holonomic_rows());
    system_->holonomic(now_.g.data(), phi);
    out.holonomic = phi.size() == 0 ? 0.0 : phi.template lpNorm<Eigen::Infinity>();
    out.group_defect = geometry_->defect(now_.g.data());
    out.iterations = last_.iterations;
    out.residual = last_.residual;
  }

 private:
  using Memory = typename Newton::template Memory<GeneralStep>;
  static void prepare(Memory& memory, const Eigen::VectorXd& x) {  // so that no step takes memory
    memory.work.resize(x);
    memory.jacobian.setIdentity(x.size(), x.size());
    if (x.size() > 0) memory.factors.compute(memory.jacobian);
  }

  // The guess is the polynomial extrapolation of up to six solutions (as in CompiledKernel).
  struct Stage {
    std::array<Eigen::VectorXd, 6> x;
    int count = 0;
    bool trusted = false;  // the last solution was the root that is meant
    Memory memory;

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

  // A v of the last substep, v recovered from its two configurations; for holonomic rows the change of
  // phi. Returns |A v - b| over the other rows.
  double recover_rates(std::vector<double>& rates) const {
    const Eigen::Index k = system_->rows(), held = system_->holonomic_rows(), free = k - held;
    rates.assign(static_cast<size_t>(k), kNaN);
    if (k == 0) return 0;
    Eigen::VectorXd v = now_.xi, base = now_.g;
    double t = now_.t;
    if (steps_ > 0) {
      Eigen::VectorXd delta(geometry_->size());
      geometry_->inverse(previous_.g.data(), delta.data());
      geometry_->compose(delta.data(), now_.g.data(), delta.data());
      if (!recover_step(*geometry_, delta.data(), s_, v)) {
        return kNaN;
      }
      Eigen::VectorXd z = -s_ * v;
      geometry_->tau(z.data(), delta.data());
      geometry_->inverse(delta.data(), delta.data());
      geometry_->compose(previous_.g.data(), delta.data(), base.data());
      t = previous_.t + s_ * last_h_;
      v /= last_h_;
    }
    place_.set(*system_, t, base.data());
    Eigen::VectorXd found = place_.a * v;
    if (steps_ > 0 && held > 0) {
      Eigen::VectorXd before(held), after(held);
      system_->holonomic(previous_.g.data(), before);
      system_->holonomic(now_.g.data(), after);
      found.tail(held) = (after - before) / last_h_;
    }
    rates.assign(found.begin(), found.end());
    return (found - place_.b).head(free).norm();
  }

  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  SolveReport one_step() {
    const bool composed = stages_.size() > 1;  // else a failed substep leaves the state alone
    if (composed) {
      start_of_step_ = now_;
      before_ = previous_;
      h_before_ = last_h_;
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
          last_h_ = h_before_;
        }
        break;
      }
    }
    return total;
  }

  struct State {
    Node now, previous;
    double last_h;
  };
  State save() const { return {now_, previous_, last_h_}; }
  void restore(const State& state) {
    now_ = state.now;
    previous_ = state.previous;
    last_h_ = state.last_h;
  }
  void forget() {
    for (Stage& stage : stages_) {
      stage.count = 0;
      stage.trusted = stage.memory.valid = false;
    }
  }

  SolveReport substep(Stage& stage, double h) {
    step_->begin(now_, h);
    SolveReport report;
    if (step_->size() > 0) {
      if (stage.count == 0) step_->guess(x_);
      else stage.extrapolate(x_);
      guess_ = x_;
      report = solve(stage);
      if (report.ok() && !is_meant(stage, report, h)) report.reason = Reason::outside_domain;
    }
    if (report.ok() && !step_->finish(x_, next_)) report.reason = Reason::outside_domain;
    if (!report.ok()) return report;
    last_h_ = h;
    if (step_->size() > 0) stage.push(x_);
    std::swap(previous_, now_);
    std::swap(now_, next_);
    return report;
  }

  // Whether x is the root that the motion means: one that a kept Jacobian reached or that is within a percent
  // of the extrapolation, the roots before it being the ones meant, or the end of the path that begins at
  // rest (top of compiled_kernel.hpp).
  bool is_meant(Stage& stage, const SolveReport& report, double h) {
    const double size = x_.squaredNorm();
    if (stage.trusted && solver_ == nullptr && report.iterations <= 2) return true;
    if (stage.trusted && (x_ - guess_).squaredNorm() <= 1e-4 * size) return true;
    follow_path(size + 1e-20 * step_->scale_squared(), h);
    stage.trusted = (x_ - path_x_).squaredNorm() <= 1e-10 * size + 1e-20 * step_->scale_squared();
    return stage.trusted;
  }
  // The solution for lambda h from lambda = 0 to 1, with steps that move it by 3 percent at most; NaN where the
  // path ends.
  void follow_path(double size, double h) {
    constexpr double start =
        1e-3;  // where there is one root, not always next to the scheme's guess
    step_->begin(now_, start * h);
    step_->guess(path_x_);
    path_memory_.valid = false;
    if (!Newton::solve(*step_, path_x_, 1e-9, path_memory_).ok()) path_x_.setConstant(kNaN);
    for (double at = start, length = 0.1; at < 1 && path_x_.allFinite();) {
      const double next = std::min(at + length, 1.0);
      step_->begin(now_, next * h);
      guess_ = path_x_;
      const SolveReport report = Newton::solve(*step_, guess_, 1e-9, path_memory_);
      if (report.ok() && (guess_ - path_x_).squaredNorm() <= 1e-3 * size) {
        path_x_ = guess_;
        at = next;
        length *= 1.5;
      } else {
        length /= 2;
        if (length < 1e-4) path_x_.setConstant(kNaN);
      }
    }
    step_->begin(now_, h);
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
  double s_, last_h_ = 1, h_before_ = 1;
  Node now_, previous_, next_, start_of_step_, before_;
  Eigen::VectorXd x_, guess_, path_x_;
  Memory path_memory_;
  std::vector<Stage> stages_;
};

}  // namespace hamel
