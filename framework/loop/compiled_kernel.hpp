// The time loop, compiled for one (group, m, tau, scheme, solver): fixed sizes, no heap, the solver inlined.
//
// Large steps. Far from the identity the equation of a step can have roots that have nothing to do with
// the motion, inside the domain of tau too. The one that is meant is where the solution y of F(y; lambda h)
// = 0 arrives that begins at lambda = 0. A root is taken for that one
//   - if one correction with the kept Jacobian gave it, or it is within a percent of the extrapolation,
//     and the roots before it were the ones meant;
//   - if |J_rest^-1 J - 1| <= 1/2 there: J is then regular on the whole segment from rest to it;
//   - else if following the path from lambda = 0 to 1 ends there. That costs some thirty solves.
// Otherwise it is refused, as is a root outside the domain (measured by tests/solvers/large_steps.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/lie/recover_step.hpp>
#include <hamel/framework/schemes/problem.hpp>
#include <hamel/framework/loop/time_loop.hpp>

namespace hamel {

/// inverse = matrix^-1, column-major n x n; matrix is overwritten. NaN where it is singular.
void invert(double* matrix, double* inverse, int n);
/// The Frobenius norm of inverse * matrix - 1.
double departure(const double* inverse, const double* matrix, int n);

template <class G, int M, class Tau, class Scheme, class Newton>
class CompiledKernel final : public TimeLoop<CompiledKernel<G, M, Tau, Scheme, Newton>> {
  using Loop = TimeLoop<CompiledKernel>;
  friend Loop;
  using Loop::composition_, Loop::h_, Loop::last_, Loop::solver_, Loop::steps_, Loop::tolerance_;

 public:
  using Problem = LeftInvariant<G, M>;
  using Step = typename Scheme::template Step<Problem, Tau>;
  using Element = typename G::template Element<double>;
  using Unknown = typename Step::Unknown;
  static constexpr int n = G::dim;

  explicit CompiledKernel(const KernelSetup& setup)
      : Loop(setup),
        problem_(Mat<n, n>(setup.inertia), typename Problem::Frame(setup.frame)),
        scheme_(problem_, Scheme::uses_s ? setup.s : 0.0),
        constraints_(setup.constraints),
        s_(Scheme::uses_s ? setup.s : 0.0),
        element_(G::from_coordinates(setup.configuration)),
        previous_(element_),
        momentum_(setup.momentum),
        stages_(setup.composition.size()) {
    const typename Step::Momentum rest = 0 * momentum_;
    scheme_.begin(rest, 1e-3 * h_);
    Unknown f = scheme_.guess();
    typename Step::Jacobian jacobian;
    scheme_.linearise(scheme_.guess(), f, jacobian);
    rest_inverse_ = jacobian;
    invert(jacobian.data(), rest_inverse_.data(), static_cast<int>(f.size()));
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
    const Eigen::VectorXd rates = constraints_.lazyProduct(discrete);
    out.row_rates.assign(rates.begin(), rates.end());
    out.constraint = rates.norm();
    out.group_defect = G::defect(element_);
    out.iterations = last_.iterations;
    out.residual = last_.residual;
  }
  const Element& element() const { return element_; }

 private:
  // What one substep of the composition remembers of its last solves: the guess is the polynomial
  // extrapolation of up to six solutions.
  struct Stage {
    std::array<Unknown, 6> x;
    int count = 0;
    bool trusted = false;  // the last solution was the root that is meant
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

  SolveReport one_step() { return M == kRunTime ? step() : flat_step(); }

  // With m fixed at compile time every small product is inlined: half the time of a step.
  [[gnu::flatten]] SolveReport flat_step() { return step(); }

  SolveReport step() {
    const bool composed = stages_.size() > 1;
    if (composed) start_of_step_ = save();
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
      if (report.ok() && !is_meant(stage, report, x, h)) total.reason = Reason::outside_domain;
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
    return total;
  }

  // Whether this root is the one that the motion means (top of this file).
  bool is_meant(Stage& stage, const SolveReport& report, const Unknown& x, double h) {
    if (!Tau::in_domain(scheme_.xi(x))) return false;
    if (stage.trusted && solver_ == nullptr && report.iterations <= 1) [[likely]]
      return true;
    stage.trusted = examine(stage, x, h);
    return stage.trusted;
  }
  [[gnu::noinline]] bool examine(const Stage& stage, const Unknown& x, double h) {
    if (Scheme::claimed_order(s_, Tau::symmetric).order == 0) return true;  // no limit, no meaning
    const double size = x.squaredNorm();
    if (stage.trusted && (x - stage.extrapolate()).squaredNorm() <= 1e-4 * size) return true;
    Unknown f = x;
    typename Step::Jacobian jacobian;
    scheme_.linearise(x, f, jacobian);
    if (departure(rest_inverse_.data(), jacobian.data(), static_cast<int>(x.size())) <= 0.5)
      return true;
    return (x - end_of_path(size, h)).squaredNorm() <= 1e-10 * size;
  }
  // Follows the root from lambda = 0 to 1 with steps that move it by 3 percent at most; NaN where the path ends.
  Unknown end_of_path(double size, double h) {
    Unknown y = scheme_.guess();
    typename Newton::template Memory<Step> memory;
    for (double at = 0, length = 0.1; at < 1;) {
      const double next = std::min(at + length, 1.0);
      scheme_.begin(momentum_, next * h);
      Unknown trial = y;
      const SolveReport report = Newton::solve(scheme_, trial, 1e-9, memory);
      if (report.ok() && (trial - y).squaredNorm() <= 1e-3 * size) {
        y = trial;
        at = next;
        length *= 1.5;
      } else {
        length /= 2;
        if (length < 1e-4) {
          y.setConstant(std::numeric_limits<double>::quiet_NaN());
          break;
        }
      }
    }
    scheme_.begin(momentum_, h);
    return y;
  }

  // Nothing to extrapolate, and no Jacobian kept.
  void forget() {
    for (Stage& stage : stages_) {
      stage.count = 0;
      stage.trusted = stage.memory.valid = false;
    }
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
  State save() const { return {element_, previous_, momentum_, last_h_}; }
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
  double s_, last_h_ = 1;
  typename Step::Jacobian rest_inverse_;
  Element element_, previous_;
  typename Step::Momentum momentum_;
  State start_of_step_;
  std::vector<Stage> stages_;
};

}  // namespace hamel
