// The time loop, compiled for one (group, m, tau, scheme, solver).
//
// Kernel is what the run-time layer holds: one virtual call per run or per recorded row, none inside a
// step. CompiledKernel is the loop itself: fixed sizes, no heap, the solver inlined.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/diagnostics.hpp>
#include <hamel/framework/problem.hpp>
#include <hamel/framework/solver.hpp>

namespace hamel {

/// Everything a kernel needs to know of a run; matrices are erased here and fixed in the kernel.
struct KernelSetup {
  Eigen::MatrixXd inertia;      // n x n, symmetric positive definite
  Eigen::MatrixXd constraints;  // k x n, rank k
  Eigen::MatrixXd frame;        // n x m, E
  double s = 0.5;
  double step = 0.01;  // h, of either sign
  double tolerance = 1e-13;
  std::vector<double> composition = {1.0};
  std::shared_ptr<Solver> solver;     // null: the solver compiled into the kernel
  std::vector<double> configuration;  // the element's coordinates at t = 0
  Eigen::VectorXd momentum;           // mu_bar at t = 0, m entries
};

/// Running totals over the steps taken.
struct SolverStats {
  long iterations = 0;
  long evaluations = 0;
  int iterations_max = 0;  // over one step
  double residual_max = 0;
};

/// A state with its measurements.
struct Snapshot {
  long step = 0;
  double time = 0;
  std::vector<double> coordinates;  // of g
  std::vector<double> velocity;     // nodal body velocity, n
  std::vector<double> momentum;     // nodal body momentum, n
  double energy = 0;
  double constraint = 0;    // |A xi/h| of the last step, xi recovered from the configurations
  double group_defect = 0;  // how far g is from the group
  int iterations = 0;       // of the last step, all substeps
  double residual = 0;      // relative, the largest of the last step's substeps
};

class Kernel {
 public:
  virtual ~Kernel() = default;
  /// count steps. On failure the state is that of the last good step.
  virtual Status advance(long count) = 0;
  /// Measures the current state into out (its vectors are reused).
  virtual void measure(Snapshot& out) const = 0;
  virtual const SolverStats& stats() const = 0;
};

template <class G, int M, class Tau, class Scheme, class Newton>
class CompiledKernel final : public Kernel {
 public:
  using Problem = LeftInvariant<G, M>;
  using Step = typename Scheme::template Step<Problem, Tau>;
  using Element = typename G::template Element<double>;
  using Unknown = typename Step::Unknown;
  static constexpr int n = G::dim;

  explicit CompiledKernel(const KernelSetup& setup)
      : problem_(Mat<n, n>(setup.inertia), typename Problem::Frame(setup.frame)),
        scheme_(problem_, Scheme::uses_s ? setup.s : 0.0),
        constraints_(setup.constraints),
        s_(Scheme::uses_s ? setup.s : 0.0),
        h_(setup.step),
        tolerance_(setup.tolerance),
        composition_(setup.composition),
        solver_(setup.solver),
        element_(G::from_coordinates(setup.configuration)),
        previous_(element_),
        momentum_(setup.momentum),
        stages_(setup.composition.size()) {}

  Status advance(long count) override {
    for (long k = 0; k < count; ++k) {
      const SolveReport report = M == kRunTime ? step() : flat_step();
      if (!report.ok()) {
        return {false, steps_ + 1, static_cast<double>(steps_) * h_, report.residual,
                to_string(report.reason)};
      }
    }
    return {};
  }

  void measure(Snapshot& out) const override {
    out.step = steps_;
    out.time = static_cast<double>(steps_) * h_;
    out.coordinates = G::coordinates(element_);
    const Vec<n> velocity = problem_.velocity(momentum_), full = problem_.momentum(momentum_);
    out.velocity.assign(velocity.begin(), velocity.end());
    out.momentum.assign(full.begin(), full.end());
    out.energy = 0.5 * full.dot(velocity);
    const Vec<n> discrete = steps_ == 0 ? velocity : recovered_velocity();
    out.constraint = constraints_.lazyProduct(discrete).norm();
    out.group_defect = G::defect(element_);
    out.iterations = last_.iterations;
    out.residual = last_.residual;
  }
  const SolverStats& stats() const override { return stats_; }
  const Element& element() const { return element_; }

 private:
  // What one substep of the composition remembers of its last solves: the guess is the polynomial
  // extrapolation of up to six solutions.
  struct Stage {
    std::array<Unknown, 6> x;
    int count = 0;
    typename Newton::template Memory<Step> memory;

    void push(const Unknown& latest) {
      for (size_t i = x.size() - 1; i > 0; --i) x[i] = x[i - 1];
      x[0] = latest;
      if (count < 6) ++count;
    }
    Unknown extrapolate() const {
      switch (count) {
        case 1: return x[0];
        case 2: return 2 * x[0] - x[1];
        case 3: return 3 * (x[0] - x[1]) + x[2];
        case 4: return 4 * (x[0] + x[2]) - 6 * x[1] - x[3];
        case 5: return 5 * (x[0] - x[3]) + 10 * (x[2] - x[1]) + x[4];
        default: return 6 * (x[0] + x[4]) - 15 * (x[1] + x[3]) + 20 * x[2] - x[5];
      }
    }
  };

  Vec<n> recovered_velocity() const {
    return recover_step<Tau>(G::compose(G::inverse(previous_), element_), s_) / last_h_;
  }

  // With m fixed at compile time every small product is inlined: half the time of a step.
  [[gnu::flatten]] SolveReport flat_step() { return step(); }

  SolveReport step() {
    const bool composed = stages_.size() > 1;
    if (composed) start_of_step_ = {element_, previous_, momentum_, last_h_};
    SolveReport total;
    for (size_t i = 0; i < stages_.size(); ++i) {
      Stage& stage = stages_[i];
      const double h = composition_[i] * h_;
      scheme_.begin(momentum_, h);
      Unknown x = stage.count == 0 ? scheme_.guess() : stage.extrapolate();
      const SolveReport report = solve(stage, x);
      total.iterations += report.iterations;
      total.evaluations += report.evaluations;
      total.residual = std::max(total.residual, report.residual);
      total.reason = report.reason;
      if (report.ok() && !Tau::in_domain(scheme_.xi(x))) total.reason = Reason::outside_domain;
      if (!total.ok()) {
        if (composed) restore(start_of_step_);
        return total;
      }
      stage.push(x);
      Element increment;
      scheme_.finish(x, increment, momentum_);
      previous_ = element_;
      element_ = G::normalise(G::compose(element_, increment));
      last_h_ = h;
    }
    last_ = total;
    ++steps_;
    stats_.iterations += total.iterations;
    stats_.evaluations += total.evaluations;
    stats_.iterations_max = std::max(stats_.iterations_max, total.iterations);
    stats_.residual_max = std::max(stats_.residual_max, total.residual);
    return total;
  }

  SolveReport solve(Stage& stage, Unknown& x) {
    if (solver_ == nullptr) return Newton::solve(scheme_, x, tolerance_, stage.memory);
    return solver_->solve(ErasedEquation(scheme_, static_cast<int>(x.size())),
                          {x.data(), static_cast<size_t>(x.size())}, tolerance_);
  }

  // A state between steps; a composed step that fails half-way goes back to it.
  struct State {
    Element element, previous;
    typename Step::Momentum momentum;
    double last_h = 1;
  };
  void restore(const State& state) {
    element_ = state.element;
    previous_ = state.previous;
    momentum_ = state.momentum;
    last_h_ = state.last_h;
  }

  class ErasedEquation final : public Equation {
   public:
    ErasedEquation(const Step& step, int size) : step_(step), size_(size) {}
    int size() const override { return size_; }
    double scale() const override {
      return step_.scale_squared() > 0 ? std::sqrt(step_.scale_squared()) : 1.0;
    }
    void evaluate(std::span<const double> x, std::span<double> f,
                  std::span<double> jacobian) const override {
      const Unknown point = Eigen::Map<const Unknown>(x.data(), size_);
      Unknown value = point;
      if (jacobian.empty()) {
        step_.residual(point, value);
      } else {
        typename Step::Jacobian derivative;
        step_.linearise(point, value, derivative);
        Eigen::Map<typename Step::Jacobian>(jacobian.data(), size_, size_) = derivative;
      }
      Eigen::Map<Unknown>(f.data(), size_) = value;
    }

   private:
    const Step& step_;
    int size_;
  };

  Problem problem_;
  Step scheme_;
  Eigen::Matrix<double, Eigen::Dynamic, n, n == 1 ? Eigen::AutoAlign : Eigen::ColMajor, n, n>
      constraints_;
  double s_, h_, last_h_ = 1, tolerance_;
  std::vector<double> composition_;
  std::shared_ptr<Solver> solver_;
  Element element_, previous_;
  typename Step::Momentum momentum_;
  State start_of_step_;
  std::vector<Stage> stages_;
  SolverStats stats_;
  SolveReport last_;
  long steps_ = 0;
};

}  // namespace hamel
