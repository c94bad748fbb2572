// The tangent of a run that is stepped by hand: of the run repeated from its start.
#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/run/run/driver.hpp>
#include <hamel/framework/tangent/sensitivities.hpp>
#include <hamel/framework/tangent/step_differences.hpp>
#include <hamel/framework/tangent/tangent_motion.hpp>

namespace hamel {
namespace {

// The builder of a run, with the start and the constant inputs that this has now.
Simulation repeated(const Simulation& of, const Run& run) {
  Simulation out = of.unobserved();
  out.with(&Config::speed, std::nullopt).with(&Config::start_values, {});
  out.start(run.config().start);
  const std::shared_ptr<Inputs>& inputs = run.inputs();
  if (inputs == nullptr) return out;
  const InputValues now = inputs->at(run.config().from);
  for (size_t i = 0; i < inputs->fields().size(); ++i)
    if (inputs->tables()[i].times.size() <= 1)
      out.input(inputs->fields()[i].name, now[static_cast<Eigen::Index>(i)]);
  return out;
}

// Other steps lead to another state, as far as their errors.
bool leads_to(TangentMotion& motion, const Snapshot& now) {
  const RunPlan& plan = motion.motion().plan();
  const MotionState there = motion.motion().map().state_of(now.time, now.coordinates, now.velocity);
  Eigen::VectorXd off;
  if (!displacement(*plan.geometry, motion.now().state, there, off)) return false;
  constexpr double round_off = 1e-8, steps = 1e3;
  const double error = plan.config.chooses_steps() ? steps * plan.setup.errors.at(0) : 0;
  return motion.natural_length(motion.now().state, off) <= std::max(round_off, error);
}

}  // namespace

RunTangent Run::tangent() {
  const Snapshot now = state();
  const Simulation simulation = repeated(*of_, *this);
  const MotionVariables none("tangent", simulation, {});
  TangentMotion motion("tangent", none, none.values(), TangentMotion::Carries::errors);
  const MotionState& start = motion.motion().start();
  const Eigen::Index n = start.xi.size();
  Run run = simulation.build();
  Eigen::MatrixXd columns(2 * n, 2 * n);
  // The start that a build makes of one beside the constraints.
  for (Eigen::Index j = 0; j < 2 * n; ++j) {
    Eigen::VectorXd column;
    const auto moved = [&](double x, Eigen::VectorXd& by) {
      MotionState there;
      displace(motion.motion().geometry(), start, Eigen::VectorXd::Unit(2 * n, j), x, there);
      run.restart({.configuration = motion.motion().map().coordinates(there),
                   .velocity = {there.xi.data(), there.xi.data() + n},
                   .momentum = {}});
      const Start& made = run.config().start;
      motion.motion().geometry().from_coordinates(made.configuration, there.g.data());
      there.xi = Eigen::Map<const Eigen::VectorXd>(made.velocity.data(), n);
      return displacement(motion.motion().geometry(), start, there, by);
    };
    const double e = 0x1p-8 / motion.natural_length(start, Eigen::VectorXd::Unit(2 * n, j));
    if (!ThreeDifferences::derivative(ThreeDifferences::fine, e, moved, column))
      throw ConfigError({"tangent: the start has no derivative"});
    columns.col(j) = column;
  }
  motion.begin_with(columns);
  RunTangent out;
  // An event that ended the run is met again on the way to the end.
  const bool met_end = over() && !simulation.config().stop_at.empty();
  out.status = motion.advance_to(met_end ? simulation.config().completed().until : now.time);
  if (!out.status.ok) return out;
  const TangentState& end = motion.now();
  if (!leads_to(motion, now)) {
    out.status = {false, 0, now.time, 0,
                  "tangent: the run repeated from its start does not lead to its current state: "
                  "its inputs were changed on the way"};
    return out;
  }
  const auto size = static_cast<int>(2 * n);
  out.matrix = NumberMatrix(size, size);
  out.errors = NumberMatrix(size, size);
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      out.matrix(i, j) = end.columns(i, j);
      out.errors(i, j) = std::abs(end.columns(i, j) - end.coarse(i, j));
    }
  return out;
}

}  // namespace hamel
