// The one time loop: a scheme's step over a problem, its substeps where it is composed, the solver, what is done
// about a step that fails, and the measurements. Compiled for (scheme, problem, solver): with fixed sizes there is
// no heap and no virtual call in a step.
//
// Large steps. Far from the identity the equation of a step can have roots that have nothing to do with the motion,
// inside the domain of tau too. The principal root is where the solution y of F(y; lambda h) = 0 arrives that begins
// at lambda = 0. A root is taken for it
//   - if a correction or two with the kept Jacobian gave it, or it is within a percent of the extrapolation, and the
//     roots before it were principal;
//   - else if following the path from lambda = 0 to 1 ends there. That costs some thirty solves.
// Otherwise it is refused, as is a root outside the domain (measured by tests/solvers/large_steps.cpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/loop/denormals.hpp>
#include <hamel/framework/loop/extrapolation.hpp>
#include <hamel/framework/loop/kernel.hpp>
#include <hamel/framework/schemes/scheme.hpp>

namespace hamel {

template <class Scheme, class Whole, class Newton>
class Loop final : public Kernel {
 public:
  using Step = typename Scheme::template Step<Whole>;
  using P = typename Step::Problem;  // Whole, or Whole without its rows
  using Unknown = typename Step::Unknown;
  using Node = hamel::Node<P>;
  static_assert(SchemeStep<Step>, "the scheme's Step does not satisfy hamel::SchemeStep");

  [[gnu::cold]] explicit Loop(const KernelSetup& setup)
      : whole_(setup.geometry, setup.mechanics),
        step_(whole_, setup.s),
        problem_(problem_of(whole_)),
        setup_(setup),
        h_(setup.step),
        symmetric_(whole_.symmetric()),
        nodes_{Node(problem_), Node(problem_), Node(problem_)},
        start_of_step_(save()),
        x_(Unknown::Zero(step_.size())),
        guess_(x_),
        path_x_(x_),
        path_memory_(x_) {
    problem_.from_coordinates(setup.configuration, now_->g);
    typename P::Vector velocity = setup.velocity;
    problem_.carry(velocity, now_->x);
    now_->t = setup.from;
    *previous_ = *now_;
    for (const double c : setup.composition)
      stages_.push_back({c, Extrapolation<Unknown>(x_), Memory(x_)});
  }

  Status advance(long count) override {
    const FlushDenormals flushed;
    for (long k = 0; k < count; ++k) {
      SolveReport report = one_step();
      if (!report.ok()) [[unlikely]] {
        report = recover(report);
        if (!report.ok()) return failure(report);
      }
      last_ = report;
      ++steps_;
      stats_.iterations += report.iterations;
      stats_.evaluations += report.evaluations;
      stats_.iterations_max = std::max(stats_.iterations_max, report.iterations);
      stats_.residual_max = std::max(stats_.residual_max, report.residual);
    }
    return {};
  }
  const SolverStats& stats() const override { return stats_; }

  [[gnu::cold]] void state(Snapshot& out) const override {
    typename P::Vector xi(problem_.dim());
    state(out, xi);
  }
  [[gnu::cold]] void measure(Snapshot& out) const override {
    typename P::Vector xi(problem_.dim());
    state(out, xi);
    out.constraint = recover_rates(xi, out.row_rates);
    typename Whole::Held phi(whole_.held());
    whole_.holonomic(now_->g, phi);
    out.holonomic = phi.size() == 0 ? 0.0 : phi.template lpNorm<Eigen::Infinity>();
    out.group_defect = problem_.defect(now_->g);
    out.iterations = last_.iterations;
    out.residual = last_.residual;
  }

 private:
  using Memory = typename Newton::template Memory<Step>;
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

  double time() const { return setup_.from + static_cast<double>(steps_) * h_; }
  [[gnu::cold]] void state(Snapshot& out, typename P::Vector& xi) const {
    out.step = steps_;
    out.time = time();
    out.coordinates.resize(static_cast<size_t>(problem_.columns()));
    problem_.coordinates(now_->g, out.coordinates.data());
    typename P::Vector mu(problem_.dim());
    typename P::Matrix inertia(problem_.dim(), problem_.dim());
    nodal_velocity(*now_, xi);
    problem_.inertia(now_->g, inertia);
    mu = inertia.lazyProduct(xi);
    out.velocity.assign(xi.begin(), xi.end());
    out.momentum.assign(mu.begin(), mu.end());
    out.energy = 0.5 * mu.dot(xi) + problem_.potential(now_->g);
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
  void nodal_velocity(const Node& node, typename P::Vector& xi) const {
    if constexpr (requires { step_.velocity(node, xi); }) step_.velocity(node, xi);
    else problem_.velocity(node.x, xi);
  }

  // A v of the last substep, v recovered from its two configurations (xi at the start); for holonomic rows the
  // change of phi. Returns |A v - b| over the other rows.
  [[gnu::cold]] double recover_rates(const typename P::Vector& xi,
                                     std::vector<double>& rates) const {
    const int k = whole_.rows();
    rates.assign(static_cast<size_t>(k), kNaN);
    if constexpr (Whole::Few::RowsAtCompileTime == 0) {
      return 0;
    } else {
      return k == 0 ? 0.0 : recover_rates_of_rows(xi, rates);
    }
  }
  [[gnu::cold]] double recover_rates_of_rows(const typename P::Vector& xi,
                                             std::vector<double>& rates) const {
    const int k = whole_.rows(), held = whole_.held();
    typename P::Vector v = xi;
    typename P::Element base = now_->g;
    double t = now_->t;
    if (steps_ > 0) {
      typename P::Element delta = problem_.element();
      problem_.inverse(previous_->g, delta);
      problem_.compose(delta, now_->g, delta);
      if (!problem_.recover_step(delta, setup_.s, v)) return kNaN;
      const typename P::Vector z = -setup_.s * v;
      problem_.tau(z, delta);
      problem_.inverse(delta, delta);
      problem_.compose(previous_->g, delta, base);
      t = previous_->t + setup_.s * last_h_;
      v /= last_h_;
    }
    typename Whole::Rows a(k, whole_.dim());
    typename Whole::Few b(k);
    whole_.constraints(t, base, a, b);
    Eigen::VectorXd found = a * v;
    if (steps_ > 0 && held > 0) {
      typename Whole::Held before(held), after(held);
      whole_.holonomic(previous_->g, before);
      whole_.holonomic(now_->g, after);
      found.tail(held) = (after - before) / last_h_;
    }
    rates.assign(found.begin(), found.end());
    return (found - b).head(k - held).norm();
  }

  [[gnu::always_inline]] SolveReport one_step() {
    if (stages_.size() == 1) [[likely]]
      return flat_substep(stages_.front());  // one that fails leaves the state alone
    return composed_step();
  }
  SolveReport composed_step() {
    start_of_step_.now = *now_;  // takes no memory
    start_of_step_.previous = *previous_;
    start_of_step_.last_h = last_h_;
    SolveReport total;
    for (Stage& stage : stages_) {
      const SolveReport report = flat_substep(stage);
      total.iterations += report.iterations;
      total.evaluations += report.evaluations;
      total.residual = std::max(total.residual, report.residual);
      total.reason = report.reason;
      if (!total.ok()) {
        restore(start_of_step_);
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
    if (report.ok() && !step_.finish(x_, *next_)) report.reason = Reason::outside_domain;
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

  // So many corrections with a kept Jacobian do not change the root; those by differences are kept longer.
  static constexpr int kSure = HasJacobian<Step> ? 1 : 2;

  // Whether x_ is the principal root (top of this file).
  [[gnu::noinline, gnu::cold]] bool is_principal(Stage& stage, double h) {
    if (Scheme::claim(setup_.s, symmetric_, setup_.mechanics->left_invariant()).order == 0) {
      return true;  // no limit, no principal root
    }
    const double size = x_.squaredNorm(), small = 1e-20 * step_.scale_squared();
    if (stage.trusted && stage.extrapolation.count() > 0) {
      stage.extrapolation(guess_);
      if ((x_ - guess_).squaredNorm() <= 1e-4 * size) return true;
    }
    follow_path(size + small, h);
    stage.trusted = (x_ - path_x_).squaredNorm() <= 1e-10 * size + small || are_one_root();
    return stage.trusted;
  }
  // Where the equation is ill-conditioned (masses of 1 and 1e6, the row of a height at h = 1e-6) one root has many
  // solutions to within round-off: between two of them F stays small, between two roots it does not.
  bool are_one_root() {
    guess_ = 0.5 * (x_ + path_x_);
    Unknown& f = path_memory_.f;
    step_.residual(guess_, f);
    return f.squaredNorm() <= 1e-16 * step_.scale_squared();
  }
  // The solution for lambda h from lambda = 0 to 1, with steps that move it by 3 percent at most; NaN where the
  // path ends. It starts where there is one root, which is not always next to the scheme's guess.
  [[gnu::noinline, gnu::cold]] void follow_path(double size, double h) {
    constexpr double start = 1e-3;
    const double tolerance = std::min(1e-9, setup_.tolerance);
    step_.begin(*now_, start * h);
    step_.guess(path_x_);
    path_memory_.valid = false;
    if (!Newton::solve(step_, path_x_, tolerance, path_memory_).ok()) path_x_.setConstant(kNaN);
    for (double at = start, length = 0.1; at < 1 && path_x_.allFinite();) {
      const double next = std::min(at + length, 1.0);
      step_.begin(*now_, next * h);
      guess_ = path_x_;
      const SolveReport report = Newton::solve(step_, guess_, tolerance, path_memory_);
      if (report.ok() && (guess_ - path_x_).squaredNorm() <= 1e-3 * size) {
        path_x_ = guess_;
        at = next;
        length *= 1.5;
      } else {
        length /= 2;
        if (length < 1e-4) path_x_.setConstant(kNaN);
      }
    }
    step_.begin(*now_, h);
  }

  [[gnu::always_inline]] SolveReport solve(Stage& stage) {
    if (setup_.solver == nullptr) [[likely]]
      return Newton::solve(step_, x_, setup_.tolerance, stage.memory);
    return setup_.solver->solve(ErasedEquation(step_, stage.memory),
                                {x_.data(), static_cast<size_t>(x_.size())}, setup_.tolerance);
  }
  class ErasedEquation final : public Equation {
   public:
    ErasedEquation(const Step& step, Memory& memory)
        : step_(step), memory_(memory), x_(Unknown::Zero(step.size())), f_(x_) {}
    int size() const override { return step_.size(); }
    double scale() const override {
      const double squared = step_.scale_squared();
      return squared > 0 ? std::sqrt(squared) : 1.0;
    }
    int jacobian_cost() const override { return HasJacobian<Step> ? 1 : 2 * size() + 1; }
    void evaluate(std::span<const double> x, std::span<double> f,
                  std::span<double> jacobian) const override {
      using Jacobian = typename Step::Jacobian;
      const Eigen::Index n = step_.size();
      x_ = Eigen::Map<const Unknown>(x.data(), n);
      if (jacobian.empty()) {
        step_.residual(x_, f_);
      } else {
        linearise(step_, x_, f_, memory_.jacobian, memory_.differences, /*in_frame=*/false);
        Eigen::Map<Jacobian>(jacobian.data(), n, n) = memory_.jacobian;
      }
      Eigen::Map<Unknown>(f.data(), n) = f_;
    }

   private:
    const Step& step_;
    Memory& memory_;
    mutable Unknown x_, f_;
  };

  // A state between steps; a composed or rescued step that fails goes back to it.
  struct State {
    Node now, previous;
    double last_h;
  };
  State save() const { return {*now_, *previous_, last_h_}; }
  void restore(const State& state) {
    *now_ = state.now;
    *previous_ = state.previous;
    last_h_ = state.last_h;
  }
  // Nothing to extrapolate, and no Jacobian kept.
  void forget() {
    for (Stage& stage : stages_) {
      stage.extrapolation.forget();
      stage.trusted = stage.memory.valid = false;
    }
  }

  // A step has failed, and the state is still that of the last good one: what on_failure asks for.
  [[gnu::noinline, gnu::cold]] SolveReport recover(SolveReport failed) {
    if (setup_.on_failure == OnFailure::stop) return failed;
    const State start = save();
    const double h = h_;
    if (stages_.size() > 1) forget();  // its first substeps are solved a second time
    SolveReport rescued;
    std::string action;
    if (setup_.on_failure == OnFailure::retry) {
      std::swap(setup_.solver, setup_.fallback);
      rescued = one_step();
      std::swap(setup_.solver, setup_.fallback);
      action = "solved by " + setup_.fallback_name;
    } else {
      int parts = 0;
      rescued = halve(1, parts);
      h_ = h;
      forget();
      action = "taken in " + std::to_string(parts) + " parts";
    }
    if (!rescued.ok()) restore(start);
    else if (++stats_.fallbacks <= 20) {
      stats_.first_fallbacks.push_back({steps_ + 1, time(), action});
    }
    SolveReport& report = rescued.ok() ? rescued : failed;
    const SolveReport& other = rescued.ok() ? failed : rescued;
    report.iterations += other.iterations;
    report.evaluations += other.evaluations;
    return report;
  }
  // h_ as two steps of half its size, each halved again where it fails.
  [[gnu::noinline, gnu::cold]] SolveReport halve(int level, int& parts) {
    SolveReport total;
    const double half = h_ / 2;
    for (int i = 0; i < 2 && total.ok(); ++i) {
      forget();  // of steps of another size
      h_ = half;
      SolveReport part = one_step();
      if (part.ok()) ++parts;
      else if (level < 10) {
        const SolveReport finer = halve(level + 1, parts);
        part = {finer.reason, finer.residual, part.iterations + finer.iterations,
                part.evaluations + finer.evaluations};
      }
      total = {part.reason, std::max(total.residual, part.residual),
               total.iterations + part.iterations, total.evaluations + part.evaluations};
    }
    return total;
  }
  [[gnu::noinline, gnu::cold]] Status failure(const SolveReport& report) const {
    std::string reason = to_string(report.reason);
    if (setup_.on_failure == OnFailure::halve) reason += ", in halved steps too";
    if (setup_.on_failure == OnFailure::retry) {
      reason += ", and " + setup_.fallback_name + " failed too";
    }
    return {false, steps_ + 1, time(), report.residual, reason};
  }

  Whole whole_;
  Step step_;
  P problem_;
  KernelSetup setup_;
  double h_, last_h_ = 1;
  bool symmetric_;
  int products_ = 0;
  Node nodes_[3];
  Node *now_ = &nodes_[0], *previous_ = &nodes_[1], *next_ = &nodes_[2];
  State start_of_step_;
  Unknown x_, guess_, path_x_;
  Memory path_memory_;
  std::vector<Stage> stages_;
  SolveReport last_;
  long steps_ = 0;
  SolverStats stats_;
};

}  // namespace hamel
