#include <hamel/framework/stages/stage_solver.hpp>

#include <algorithm>

#include <hamel/framework/stages/stage_newton.hpp>

namespace hamel {
namespace {

// Weights of goals as costs, from soft to hard.
constexpr double kWeights[] = {1, 1e2, 1e4, 1e6};
constexpr double kReached = 1e-3;  // of the first miss, where hard goals are tried again

bool has_path(const StageProblem& problem) {
  for (int k = 0; k <= problem.stages(); ++k)
    if (problem.sizes(k).path > 0) return true;
  return false;
}

// Goals and path rows as costs of growing weight. A miss that shrinks with the weight is one that
// a plan can avoid, and hard goals are tried from there; one that stays is the least.
StageStatus soften(StageNewton& newton, const StagePoint& guess, const StageOptions& options) {
  double before = newton.missed();
  const double first = before;
  for (const double weight : kWeights) {
    StageNewton::End end = newton.iterate(weight);
    if (end == StageNewton::End::solved && !newton.is_least()) {
      // The minimum of a smaller weight, as no input at all, is a saddle of this one.
      newton.restart(guess);
      end = newton.iterate(weight);
    }
    if (end == StageNewton::End::stopped) return StageStatus::failed;
    const double miss = newton.missed();
    const bool converged = end == StageNewton::End::solved;
    if (converged && miss < kReached * std::max(1.0, first)) {
      newton.goal_multipliers(weight * newton.goal());
      if (newton.iterate(0) == StageNewton::End::solved) return StageStatus::ok;
      if (newton.iterate(weight) != StageNewton::End::solved) return StageStatus::failed;
    }
    if (weight == kWeights[3] && converged && miss > 0.5 * before && miss > 10 * options.tolerance)
      return StageStatus::out_of_reach;
    before = miss;
  }
  return StageStatus::failed;
}

}  // namespace

StageSolution solve_stages(StageProblem& problem, const StagePoint& guess,
                           const StageOptions& options) {
  StageNewton newton(problem, options, guess);
  StageSolution out;
  const StageNewton::End end = newton.iterate(0);
  if (end == StageNewton::End::solved) {
    out.status = StageStatus::ok;
  } else if (end == StageNewton::End::stuck && (problem.goals() > 0 || has_path(problem))) {
    const std::string reason = newton.reason();
    StageNewton soft(problem, options, guess);
    out.status = soften(soft, guess, options);
    if (out.status == StageStatus::out_of_reach) out.reason = "the goal is out of reach";
    else if (out.status == StageStatus::failed) out.reason = reason;
    soft.fill(out);
    out.iterations += newton.iterations();
    return out;
  } else {
    out.reason = newton.reason();
  }
  newton.fill(out);
  return out;
}

}  // namespace hamel
