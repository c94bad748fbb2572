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

// In natural sizes (plan_stages.hpp).
constexpr double kSway = 0.3;      // of the states aside, for a displacement of 1
constexpr double kLeastWay = 0.1;  // for which they are moved aside
constexpr double kInputSway = 0.3;
constexpr double kMoving = 0.03;  // part of them where the start moves: linearised there, a system
                                  // is controllable that is not so at rest
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

// The start, moved on by its own velocity: g_{k+1} = g_k tau(h xi_0).
std::vector<MotionState> PlanBuilder::carried(const PlanStages& stages) const {
  const Geometry& geometry = stages.map.geometry();
  std::vector<MotionState> out{stages.map.start()};
  Eigen::VectorXd by = Eigen::VectorXd::Zero(2 * stages.map.velocities());
  by.head(stages.map.velocities()) = out[0].xi;
  for (int k = 1; k <= stages.steps; ++k) {
    out.emplace_back();
    displace(geometry, out[out.size() - 2], by, stages.step, out.back());
    geometry.normalise(out.back().g.data());
    out.back().time = stages.from + k * stages.step;
  }
  return out;
}

// The goal, what is free where the start is carried to, and the increment from there.
MotionState PlanBuilder::goal_state(PlanStages& stages, const MotionState& carried,
                                    Eigen::VectorXd& way) const {
  StepMap& map = stages.map;
  Eigen::VectorXd end = stages.numbers(carried);
  for (const PlanGoal& goal : stages.goal_rows) end[goal.place] = goal.value;
  MotionState last = stages.motion_state(carried.time, end);
  if (stages.goal_place) last.g = stages.goal_place->g;
  map.project(last);
  if (!map.difference(carried, last, way)) way.setZero(map.increments());
  return last;
}

// Angles are moved aside by no more than they would be for a displacement of 1.
Eigen::VectorXd PlanBuilder::sizes_aside(const PlanStages& stages,
                                         const Eigen::VectorXd& way) const {
  const std::vector<Component> components = components_of(stages.system());
  const Eigen::Index n = stages.map.velocities();
  Eigen::VectorXd out = kSway * stages.state_scales.head(n);
  const double size = std::max(
      way.head(n).cwiseQuotient(stages.state_scales.head(n)).lpNorm<Eigen::Infinity>(), kLeastWay);
  for (Eigen::Index i = 0; i < n; ++i) {
    const bool angle = components[static_cast<std::size_t>(i)].unit == "rad/s";
    out[i] *= angle ? std::min(size, 1.0) : size;
  }
  return out;
}

PlanBuilder::Guess PlanBuilder::guess(PlanStages& stages, unsigned seed) const {
  Guess out;
  StagePoint& point = out.point;
  std::mt19937 random(seed);
  const auto count = static_cast<Eigen::Index>(request_.inputs.size());
  const double part = stages.map.start().xi.isZero(0) ? 1 : kMoving;
  const bool from_file = !request_.guess_file.empty();
  if (from_file) {
    point = rolled_out(stages);
  } else {
    StepMap& map = stages.map;
    const std::vector<MotionState> base = carried(stages);
    Eigen::VectorXd way, increment;
    goal_state(stages, base.back(), way);
    const Eigen::Index n = map.velocities();
    const Eigen::MatrixXd aside =
        waves(stages.steps, n, part, random) * sizes_aside(stages, way).asDiagonal();
    MotionState state;
    const bool held = map.plan().system->mechanics->holonomic_rows() > 0;
    for (int k = 0; k <= stages.steps; ++k) {
      increment = static_cast<double>(k) / stages.steps * way;
      increment.head(n) += aside.row(k).transpose();
      map.choose_stage(k);
      map.retract(base[static_cast<std::size_t>(k)], increment, state);
      if (held && k > 0) map.make_admissible(state);
      point.states.push_back(stages.numbers(k == 0 ? base[0] : state));
      point.inputs.emplace_back(Eigen::VectorXd::Zero(k < stages.steps ? count : 0));
    }
  }
  if (stages.free_time) {
    for (Eigen::VectorXd& state : point.states) {
      state.conservativeResize(state.size() + 1);
      state[state.size() - 1] = stages.step;
    }
  }
  out.scales = find_scales(stages, point, stages.state_scales, stages.goal_scales());
  if (from_file) return out;
  const Eigen::MatrixXd inputs = waves(stages.steps, count, part * kInputSway, random);
  for (int k = 0; k < stages.steps; ++k)
    point.inputs[static_cast<std::size_t>(k)] =
        inputs.row(k).transpose().cwiseProduct(out.scales.inputs);
  return out;
}

}  // namespace hamel
