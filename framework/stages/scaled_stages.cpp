#include <hamel/framework/stages/scaled_stages.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace hamel {
namespace {

constexpr int kSamples = 8;  // stages at which sizes are found

double positive(double size) { return size > 0 && std::isfinite(size) ? size : 1; }

class ScaledStages final : public StageProblem {
 public:
  ScaledStages(StageProblem& problem, const StageScales& scales)
      : problem_(problem), scales_(scales) {}

  int stages() const override { return problem_.stages(); }
  StageSizes sizes(int k) const override { return problem_.sizes(k); }
  int goals() const override { return problem_.goals(); }
  void retract(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& increment,
               Eigen::VectorXd& out) const override {
    moved_ = scales_.state.cwiseProduct(increment);
    problem_.retract(k, state, moved_, out);
  }
  void bounds(int k, Eigen::VectorXd& low, Eigen::VectorXd& high) const override {
    problem_.bounds(k, low, high);
    if (low.size() == 0) return;
    low = low.cwiseQuotient(scales_.inputs);
    high = high.cwiseQuotient(scales_.inputs);
  }
  bool values(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
              const Eigen::VectorXd* next, StageValues& out) override {
    set_inputs(inputs);
    if (!problem_.values(k, state, inputs_, next, out)) return false;
    if (next != nullptr) out.defect = out.defect.cwiseQuotient(scales_.state);
    out.path = out.path.cwiseQuotient(scales_.path.head(out.path.size()));
    out.cost /= scales_.cost;
    return true;
  }
  bool derivatives(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                   const Eigen::VectorXd* next, const Eigen::VectorXd& lambda,
                   const Eigen::VectorXd& y, StageDerivatives& out) override {
    set_inputs(inputs);
    lambda_ = scales_.cost * lambda;
    if (next != nullptr) lambda_ = lambda_.cwiseQuotient(scales_.state);
    y_ = scales_.cost * y.cwiseQuotient(scales_.path.head(y.size()));
    if (!problem_.derivatives(k, state, inputs_, next, lambda_, y_, out)) return false;
    const Eigen::Index n = state_size();
    all_.resize(n + inputs.size());
    all_.head(n) = scales_.state;
    all_.tail(inputs.size()) = scales_.inputs.head(inputs.size());
    if (next != nullptr) {
      divided_ = scales_.state.cwiseInverse();
      out.F = divided_.asDiagonal() * out.F * scales_.state.asDiagonal();
      out.B = divided_.asDiagonal() * out.B * scales_.inputs.asDiagonal();
    }
    out.cost_gradient = out.cost_gradient.cwiseProduct(all_) / scales_.cost;
    out.path_jacobian = out.path_jacobian * all_.asDiagonal();
    for (Eigen::Index i = 0; i < out.path_jacobian.rows(); ++i)
      out.path_jacobian.row(i) /= scales_.path[i];
    out.hessian = all_.asDiagonal() * out.hessian * all_.asDiagonal();
    out.hessian /= scales_.cost;
    return true;
  }
  void goal(const Eigen::VectorXd& last, Eigen::VectorXd& value) override {
    problem_.goal(last, value);
    value = value.cwiseQuotient(scales_.goal);
  }
  void goal_derivatives(const Eigen::VectorXd& last, const Eigen::VectorXd& nu,
                        Eigen::MatrixXd& jacobian, Eigen::MatrixXd& hessian) override {
    y_ = scales_.cost * nu.cwiseQuotient(scales_.goal);
    problem_.goal_derivatives(last, y_, jacobian, hessian);
    jacobian = scales_.goal.cwiseInverse().asDiagonal() * jacobian * scales_.state.asDiagonal();
    hessian = scales_.state.asDiagonal() * hessian * scales_.state.asDiagonal();
    hessian /= scales_.cost;
  }
  // Columns of size 1: w~ = L w, L the size of D^-1 J.
  Eigen::MatrixXd start_directions() const override {
    return scaled_directions() * start_sizes().cwiseInverse().asDiagonal();
  }

  StagePoint scaled(StagePoint point) const {
    for (Eigen::VectorXd& u : point.inputs)
      u = u.cwiseQuotient(scales_.inputs.head(u.size())).eval();
    return point;
  }
  /// A solution of this problem as one of the problem itself.
  void restore(StageSolution& out) {
    const Eigen::VectorXd by_state = scales_.cost * scales_.state.cwiseInverse(),
                          by_inputs = scales_.cost * scales_.inputs.cwiseInverse(),
                          by_path = scales_.cost * scales_.path.cwiseInverse();
    for (Eigen::VectorXd& u : out.point.inputs)
      u = u.cwiseProduct(scales_.inputs.head(u.size())).eval();
    out.objective *= scales_.cost;
    for (Eigen::VectorXd& x : out.multipliers) x = x.cwiseProduct(by_state).eval();
    out.goal_multipliers = scales_.cost * out.goal_multipliers.cwiseQuotient(scales_.goal).eval();
    for (Eigen::VectorXd& y : out.path_multipliers)
      y = y.cwiseProduct(by_path.head(y.size())).eval();
    for (auto* all : {&out.low_multipliers, &out.high_multipliers})
      for (Eigen::VectorXd& y : *all) y = y.cwiseProduct(by_inputs.head(y.size())).eval();
    out.missed = out.missed.cwiseProduct(scales_.goal).eval();
    if (out.path_missed_row >= 0) out.path_missed *= scales_.path[out.path_missed_row];
    if (const Eigen::VectorXd sizes = start_sizes(); out.start_information.size() > 0)
      out.start_information =
          (scales_.cost * sizes.asDiagonal() * out.start_information * sizes.asDiagonal()).eval();
    for (Eigen::MatrixXd& K : out.gains)
      K = (scales_.inputs.head(K.rows()).asDiagonal() * K *
           scales_.state.cwiseInverse().asDiagonal())
              .eval();
  }

 private:
  Eigen::Index state_size() const { return scales_.state.size(); }
  Eigen::MatrixXd scaled_directions() const {
    return scales_.state.cwiseInverse().asDiagonal() * problem_.start_directions();
  }
  Eigen::VectorXd start_sizes() const {
    Eigen::VectorXd out = Eigen::VectorXd::Ones(problem_.start_directions().cols());
    const Eigen::MatrixXd all = scaled_directions();
    for (Eigen::Index i = 0; i < out.size(); ++i)
      out[i] = positive(all.col(i).lpNorm<Eigen::Infinity>());
    return out;
  }
  void set_inputs(const Eigen::VectorXd& inputs) {
    inputs_ = inputs.cwiseProduct(scales_.inputs.head(inputs.size()));
  }

  StageProblem& problem_;
  const StageScales& scales_;
  mutable Eigen::VectorXd moved_;
  Eigen::VectorXd inputs_, lambda_, y_, all_, divided_;
};

// Sums and maxima over stages of a guess.
class ScaleSearch {
 public:
  ScaleSearch(StageProblem& problem, const StagePoint& guess, const Eigen::VectorXd& state,
              const Eigen::VectorXd& goal)
      : problem_(problem), guess_(guess), state_(state), goal_(goal) {
    StageSizes most;
    for (int k = 0; k <= problem.stages(); ++k) {
      most.inputs = std::max(most.inputs, problem.sizes(k).inputs);
      most.path = std::max(most.path, problem.sizes(k).path);
    }
    moved_.setZero(most.inputs);
    curved_.setZero(most.inputs);
    path_.setZero(most.path);
  }

  StageScales find() {
    const int last = problem_.stages(), samples = std::min(kSamples, last);
    for (int i = 0; i < samples; ++i)
      at_stage(i * last / samples, static_cast<double>(last) / samples);
    if (last > 1) at_stage(1, 0);  // it may have rows of its own
    at_stage(last, 1);
    StageScales out{state_, moved_.cwiseInverse() / kUnitTime, path_, goal_sizes(), 0};
    double of_inputs = 0;
    for (double& u : out.inputs) u = positive(u);
    for (double& r : out.path) r = positive(r);
    for (Eigen::Index i = 0; i < curved_.size(); ++i) {
      const double one = curved_[i] * out.inputs[i] * out.inputs[i] / 2;
      if (one > 0 && (of_inputs == 0 || one < of_inputs)) of_inputs = one;
    }
    out.cost = positive(std::max(std::abs(cost_), of_inputs));
    return out;
  }

 private:
  void at_stage(int k, double weight) {
    const auto at = static_cast<size_t>(k);
    const StageSizes s = problem_.sizes(k);
    const bool ends = k == problem_.stages();
    const Eigen::VectorXd* next = ends ? nullptr : &guess_.states[at + 1];
    const int width = ends ? 0 : problem_.sizes(k + 1).state, all = s.state + s.inputs;
    StageValues v{Eigen::VectorXd::Zero(width), 0, Eigen::VectorXd::Zero(s.path)};
    StageDerivatives d{Eigen::MatrixXd::Zero(width, s.state),
                       Eigen::MatrixXd::Zero(width, s.inputs), Eigen::VectorXd::Zero(all),
                       Eigen::MatrixXd::Zero(all, all), Eigen::MatrixXd::Zero(s.path, all)};
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(width),
                          no_rows = Eigen::VectorXd::Zero(s.path);
    if (!problem_.values(k, guess_.states[at], guess_.inputs[at], next, v) ||
        !problem_.derivatives(k, guess_.states[at], guess_.inputs[at], next, none, no_rows, d))
      return;
    cost_ += weight * v.cost;
    for (Eigen::Index i = 0; i < s.inputs; ++i) {
      moved_[i] += weight * d.B.col(i).cwiseQuotient(state_).lpNorm<Eigen::Infinity>();
      curved_[i] += weight * std::abs(d.hessian(s.state + i, s.state + i));
    }
    for (Eigen::Index i = 0; i < s.path; ++i)
      path_[i] = std::max({path_[i], std::abs(v.path[i]),
                           d.path_jacobian.row(i)
                               .head(s.state)
                               .transpose()
                               .cwiseProduct(state_)
                               .lpNorm<Eigen::Infinity>()});
  }

  Eigen::VectorXd goal_sizes() {
    const Eigen::Index rows = problem_.goals(), n = state_.size();
    Eigen::VectorXd out = goal_;
    if (rows == 0) return out;
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(rows, n),
                    hessian = Eigen::MatrixXd::Zero(n, n);
    problem_.goal_derivatives(guess_.states.back(), Eigen::VectorXd::Zero(rows), jacobian, hessian);
    for (Eigen::Index i = 0; i < rows; ++i)
      if (out[i] == 0)
        out[i] =
            positive(jacobian.row(i).transpose().cwiseProduct(state_).lpNorm<Eigen::Infinity>());
    return out;
  }

  StageProblem& problem_;
  const StagePoint& guess_;
  const Eigen::VectorXd &state_, &goal_;
  double cost_ = 0;
  Eigen::VectorXd moved_, curved_, path_;
};

}  // namespace

StageScales find_scales(StageProblem& problem, const StagePoint& guess,
                        const Eigen::VectorXd& state, const Eigen::VectorXd& goal) {
  return ScaleSearch(problem, guess, state, goal).find();
}

StageSolution solve_scaled(StageProblem& problem, const StageScales& scales,
                           const StagePoint& guess, const StageOptions& options) {
  ScaledStages scaled(problem, scales);
  StageOptions of_scaled = options;
  if (options.progress)
    of_scaled.progress = [&](StageProgress now) {
      now.objective *= scales.cost;
      options.progress(now);
    };
  StageSolution out = solve_stages(scaled, scaled.scaled(guess), of_scaled);
  scaled.restore(out);
  return out;
}

}  // namespace hamel
