// Guesses of a plan.
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <Eigen/Core>

#include <hamel/framework/inverse/plan_builder.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/io/text_file.hpp>

namespace hamel {
namespace {

constexpr double kSway = 0.3;       // of the states aside, rad and m for a displacement of 1
constexpr double kInputSway = 0.1;  // of inputs without bounds
constexpr int kWaves = 3;

// In (-1, 1); the same on every machine.
double draw(std::mt19937& random) {
  return (static_cast<double>(random()) + 0.5) / 2147483648.0 - 1;
}

// Sines over the whole time, zero at both ends: column i of `count`.
Eigen::MatrixXd waves(int steps, Eigen::Index count, double size, std::mt19937& random) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(steps + 1, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (int j = 1; j <= kWaves; ++j) {
      const double a = size * draw(random) / j;
      for (int k = 0; k <= steps; ++k) out(k, i) += a * std::sin(std::numbers::pi * j * k / steps);
    }
  }
  return out;
}

}  // namespace

// The states of the inputs of a file.
StagePoint PlanBuilder::rolled_out(PlanStages& stages) const {
  StagePoint out;
  const std::string text = read_text_file("guess.file", request_.guess_file);
  std::vector<InputTable> tables;
  for (const std::string& name : request_.inputs)
    tables.push_back(read_input_table("guess.file", name, {request_.guess_file, true}, text));
  const double h = stages.step;
  MotionState state = stages.map.start(), next;
  for (int k = 0; k <= stages.steps; ++k) {
    out.states.push_back(stages.numbers(state));
    Eigen::VectorXd u(k < stages.steps ? static_cast<Eigen::Index>(tables.size()) : 0);
    for (Eigen::Index i = 0; i < u.size(); ++i)
      u[i] = tables[static_cast<std::size_t>(i)].at(stages.from + (k + 0.5) * h);
    out.inputs.push_back(u);
    if (k == stages.steps) break;
    stages.map.set_inputs(u);
    if (!stages.map.step(state, stages.from + (k + 1) * h, next).ok)
      throw ConfigError(
          {fmt::format("guess.file: step {} of these inputs has no solution", k + 1)});
    state = next;
  }
  return out;
}

StagePoint PlanBuilder::guess(PlanStages& stages, unsigned seed) const {
  StagePoint out;
  if (!request_.guess_file.empty()) {
    out = rolled_out(stages);
  } else {
    std::mt19937 random(seed);
    StepMap& map = stages.map;
    const MotionState first = map.start();
    Eigen::VectorXd end = stages.numbers(first), way;
    for (const PlanGoal& goal : stages.goal_rows) end[goal.place] = goal.value;
    MotionState last = stages.motion_state(first.time, end), state;
    if (stages.goal_place) last.g = stages.goal_place->g;
    map.project(last);
    if (!map.difference(first, last, way)) way.setZero(map.increments());
    const Eigen::Index n = map.velocities();
    const double size = std::max(way.head(n).lpNorm<Eigen::Infinity>(), 0.1);
    const Eigen::MatrixXd aside = waves(stages.steps, n, kSway * size, random);
    const auto count = static_cast<Eigen::Index>(request_.inputs.size());
    const Eigen::MatrixXd inputs = waves(stages.steps, count, kInputSway, random);
    Eigen::VectorXd increment(map.increments());
    for (int k = 0; k <= stages.steps; ++k) {
      increment = static_cast<double>(k) / stages.steps * way;
      increment.head(n) += aside.row(k).transpose();
      map.retract(first, increment, state);
      out.states.push_back(stages.numbers(k == 0 ? first : state));
      out.inputs.emplace_back(Eigen::VectorXd(inputs.row(k).head(k < stages.steps ? count : 0)));
    }
  }
  if (!stages.free_time) return out;
  for (Eigen::VectorXd& state : out.states) {
    state.conservativeResize(state.size() + 1);
    state[state.size() - 1] = stages.step;
  }
  return out;
}

}  // namespace hamel
