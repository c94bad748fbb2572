#include <hamel/framework/inverse/motion_plan.hpp>

#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <hamel/framework/inverse/plan_builder.hpp>
#include <hamel/framework/inverse/plan_feedback.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/stages/scaled_stages.hpp>

namespace hamel {
namespace {

constexpr unsigned kGuesses = 4;  // seeds that are tried, one after the other

PlanStatus status_of(StageStatus status) {
  switch (status) {
    case StageStatus::ok: return PlanStatus::ok;
    case StageStatus::out_of_reach: return PlanStatus::out_of_reach;
    case StageStatus::failed: break;
  }
  return PlanStatus::failed;
}

// Goals by name, of a solution.
std::map<std::string, double> by_goal(const PlanStages& stages, const Eigen::VectorXd& values) {
  std::map<std::string, double> out;
  Eigen::Index row = 0;
  for (const PlanGoal& goal : stages.goal_rows) {
    if (row < values.size()) out[goal.name] = values[row++];
  }
  for (int i = 1; row < values.size(); ++i) out[fmt::format("configuration{}", i)] = values[row++];
  return out;
}

void fill_motion(Plan& out, const PlanStages& stages, const PlanBuilder& builder,
                 const PlanRequest& request, const StageSolution& solution) {
  const double h = stages.step_of(solution.point.states[0]);
  out.step = h;
  out.steps = stages.steps;
  for (int k = 0; k <= stages.steps; ++k) out.t.push_back(stages.from + k * h);
  out.until = out.t.back();
  for (std::size_t i = 0; i < builder.quantities().size(); ++i) {
    std::vector<double> values;
    for (const Eigen::VectorXd& state : solution.point.states)
      values.push_back(state[static_cast<Eigen::Index>(i)]);
    out.states.emplace_back(builder.quantities()[i], std::move(values));
  }
  for (std::size_t i = 0; i < request.inputs.size(); ++i) {
    std::vector<double> values;
    for (int k = 0; k < stages.steps; ++k)
      values.push_back(
          solution.point.inputs[static_cast<std::size_t>(k)][static_cast<Eigen::Index>(i)]);
    out.inputs.emplace_back(request.inputs[i], std::move(values));
  }
}

StageSolution solve(PlanStages& stages, const PlanBuilder& builder, const PlanRequest& request,
                    const StageOptions& options, Plan& out) {
  StageSolution solution;
  for (unsigned i = 0; i < kGuesses; ++i) {
    const PlanBuilder::Guess guess = builder.guess(stages, request.seed + i);
    solution = solve_scaled(stages, guess.scales, guess.point, options);
    out.iterations += solution.iterations;
    const bool stopped = options.stop != nullptr && options.stop->load();
    if (solution.status != StageStatus::failed || stopped || !request.guess_file.empty()) {
      if (request.guess_file.empty())
        out.notes.push_back(fmt::format(
            "the guess is the way to the goal, moved aside at random: seed {}", request.seed + i));
      break;
    }
  }
  return solution;
}

}  // namespace

Plan make_plan(const Registry& registry, const PlanRequest& request,
               const std::function<void(long, double, double)>& progress,
               const std::atomic<bool>* stop) {
  const auto begin = std::chrono::steady_clock::now();
  PlanBuilder builder(registry, request);
  std::unique_ptr<PlanStages> stages = builder.stages();
  StageOptions options;
  options.stop = stop;
  if (progress)
    options.progress = [&](const StageProgress& p) {
      progress(p.iteration, p.objective, p.defect);
    };
  Plan out;
  StageSolution solution = solve(*stages, builder, request, options, out);
  if (!stages->repeats(solution.point)) {  // another root of an equation than that of the run
    stages->take_steps_of_run_alone();
    solution = solve(*stages, builder, request, options, out);
  }
  out.status = status_of(solution.status);
  out.reason = solution.reason;
  out.objective = solution.objective;
  out.defect_max = solution.defect;
  fill_motion(out, *stages, builder, request, solution);
  if (out.status == PlanStatus::out_of_reach) out.missed = by_goal(*stages, solution.missed);
  if (out.status == PlanStatus::out_of_reach && solution.path_missed > 0)
    out.missed[fmt::format("{} at t = {:.6g}", stages->row_name(solution.path_missed_row),
                           out.t[static_cast<std::size_t>(solution.path_missed_at)])] =
        solution.path_missed;
  out.goal_multipliers = by_goal(*stages, solution.goal_multipliers);
  for (const Eigen::VectorXd& lambda : solution.multipliers)
    out.adjoint.emplace_back(lambda.data(), lambda.data() + lambda.size());
  out.run = builder.config();
  out.run.step = out.step;
  out.run.until = out.until;
  for (const auto& [name, values] : out.inputs) out.run.inputs[name] = out.table(name);
  out.tracking = std::make_shared<PlanFeedback>(std::move(stages), solution, request.inputs);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

InputTable Plan::table(const std::string& input) const {
  std::vector<std::string> names;
  for (const auto& [name, values] : inputs) {
    names.push_back(name);
    if (name != input) continue;
    InputTable out{t, values, true};
    out.values.push_back(values.back());  // held to the end
    return out;
  }
  throw ConfigError({unknown_name("input of this plan", input, names)});
}

std::vector<double> Plan::feedback(long step_number, std::span<const double> configuration,
                                   std::span<const double> velocity) const {
  return tracking->inputs(step_number, configuration, velocity);
}

std::string Plan::gains() const { return tracking->csv(); }

std::string Plan::csv() const {
  std::string out = "t";
  for (const auto& [name, values] : inputs) out += "," + name;
  out += "\n";
  for (std::size_t k = 0; k < t.size(); ++k) {
    out += fmt::format("{:.17g}", t[k]);
    for (const auto& [name, values] : inputs)
      out += fmt::format(",{:.17g}", values[std::min(k, values.size() - 1)]);
    out += "\n";
  }
  return out;
}

}  // namespace hamel
