// Stages, rows and bounds of a problem, as the solver holds them.
#include <hamel/framework/stages/stage_newton.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace hamel {
namespace {

constexpr double kLeastSlack = 1e-2;  // of path rows at the start
constexpr double kInside = 1e-2;      // part of a range of inputs that a guess is moved in
constexpr double kFree = std::numeric_limits<double>::infinity();

}  // namespace

StageNewton::StageNewton(StageProblem& problem, const StageOptions& options,
                         const StagePoint& guess)
    : problem_(problem), options_(options), last_(static_cast<size_t>(problem.stages())) {
  if (guess.states.size() != last_ + 1 || guess.inputs.size() != last_ + 1)
    throw std::invalid_argument("solve_stages: the guess has another number of stages");
  resize(guess);
}

void StageNewton::resize(const StagePoint& guess) {
  const size_t count = last_ + 1;
  sizes_.resize(count);
  rows_.resize(count);
  derivatives_.resize(count);
  lambda_.resize(count);
  linear_.stages.resize(count);
  now_.point = guess;
  now_.stages.resize(count);
  for (size_t k = 0; k < count; ++k) sizes_[k] = problem_.sizes(static_cast<int>(k));
  for (size_t k = 0; k < count; ++k) {
    const StageSizes s = sizes_[k];
    const int next = k < last_ ? sizes_[k + 1].state : 0, all = s.state + s.inputs;
    if (guess.inputs[k].size() != s.inputs || (k == last_ && s.inputs != 0))
      throw std::invalid_argument("solve_stages: the guess has another number of inputs");
    now_.stages[k].defect.setZero(next);
    now_.stages[k].path.setZero(s.path);
    StageDerivatives& d = derivatives_[k];
    d.F.setZero(next, s.state);
    d.B.setZero(next, s.inputs);
    d.cost_gradient.setZero(all);
    d.hessian.setZero(all, all);
    d.path_jacobian.setZero(s.path, all);
    linear_.stages[k].resize(s.state, s.inputs, next);
    lambda_[k].setZero(s.state);
    rows_[k].path.resize(s.path);
    set_bounds(static_cast<int>(k));
    has_rows_ = has_rows_ || s.path > 0 || rows_[k].bound_jacobian.rows() > 0;
  }
  now_.goal.setZero(problem_.goals());
  nu_.setZero(problem_.goals());
  goal_jacobian_.setZero(problem_.goals(), sizes_[last_].state);
  goal_hessian_.setZero(sizes_[last_].state, sizes_[last_].state);
  linear_.start = problem_.start_directions();
  trial_ = now_;
}

// Rows u - low >= 0, then high - u >= 0; a guess outside is moved inside.
void StageNewton::set_bounds(int k) {
  StageRows& rows = rows_[static_cast<size_t>(k)];
  const StageSizes s = sizes_[static_cast<size_t>(k)];
  Eigen::VectorXd low = Eigen::VectorXd::Constant(s.inputs, -kFree), high = -low;
  problem_.bounds(k, low, high);
  Eigen::VectorXd& u = now_.point.inputs[static_cast<size_t>(k)];
  std::vector<std::pair<int, double>> found;  // (+-(input + 1), offset)
  for (int i = 0; i < s.inputs; ++i) {
    const double inside = std::min(kInside * (high[i] - low[i]), kInside * (1 + std::abs(u[i])));
    if (std::isfinite(low[i])) u[i] = std::max(u[i], low[i] + inside);
    if (std::isfinite(high[i])) u[i] = std::min(u[i], high[i] - inside);
    if (std::isfinite(low[i])) found.emplace_back(i + 1, -low[i]);
  }
  rows.lows = static_cast<int>(found.size());
  for (int i = 0; i < s.inputs; ++i)
    if (std::isfinite(high[i])) found.emplace_back(-i - 1, high[i]);
  const auto count = static_cast<Eigen::Index>(found.size());
  rows.bound_jacobian.setZero(count, s.state + s.inputs);
  rows.bound_offset.setZero(count);
  rows.bound_values.setZero(count);
  rows.bounds.resize(static_cast<int>(count));
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto [which, offset] = found[static_cast<size_t>(i)];
    rows.bound_jacobian(i, s.state + std::abs(which) - 1) = which > 0 ? 1 : -1;
    rows.bound_offset[i] = offset;
  }
}

void StageNewton::bound_values(size_t k, const Eigen::VectorXd& inputs,
                               Eigen::VectorXd& out) const {
  out = rows_[k].bound_offset;
  out.noalias() += rows_[k].bound_jacobian.rightCols(inputs.size()) * inputs;
}

void StageNewton::start_rows() {
  mu_ = has_rows_ ? options_.barrier : 0;
  for (size_t k = 0; k <= last_; ++k) {
    rows_[k].path.start(now_.stages[k].path, kLeastSlack, mu_);
    bound_values(k, now_.point.inputs[k], rows_[k].bound_values);
    rows_[k].bounds.start(rows_[k].bound_values, 0, mu_);
  }
}

}  // namespace hamel
