#include <hamel/framework/tangent/sensitivities.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/tangent/step_differences.hpp>
#include <hamel/framework/tangent/tangent_motion.hpp>

namespace hamel {
namespace {

// The times of the rows of a run: those of the options, or its nodes.
std::vector<double> times_of_rows(const Simulation& simulation) {
  const Config config = simulation.config().completed();
  const std::vector<double> given = config.recorded_times();
  if (!given.empty()) return given;
  std::vector<double> out;
  Simulation plain = simulation;
  plain.with(&Config::no_exact, true).with(&Config::check, false);
  plain.observe([&](const Snapshot& row) {
    out.push_back(row.time);
    return true;
  });
  plain.run();
  return out;
}

// Columns of a table of sensitivities.
class SensitivityRows {
 public:
  SensitivityRows(const SystemModel& system, const std::vector<std::string>& names) {
    std::vector<std::string> units = units_of_element(system.group);
    units.resize(system.group.columns.size());
    std::vector<std::pair<std::string, std::string>> quantities;
    for (size_t i = 0; i < units.size(); ++i)
      quantities.emplace_back(system.group.columns[i], units[i]);
    for (const Component& c : components_of(system)) quantities.emplace_back(c.name, c.unit);
    table.columns.push_back({"t", "s", "time", std::vector<double>()});
    for (const auto& [name, unit] : quantities)
      table.columns.push_back({name, unit, "of the run", std::vector<double>()});
    for (const auto& [name, unit] : quantities)
      for (const std::string& by : names)
        table.columns.push_back({fmt::format("d({})/d({})", name, by), "", "derivative of the run",
                                 std::vector<double>()});
  }
  void add(double t, const Eigen::VectorXd& values, const Eigen::MatrixXd& derivatives) {
    size_t column = 0;
    const auto next = [&](double x) {
      std::get<std::vector<double>>(table.columns[column++].values).push_back(x);
    };
    next(t);
    for (const double x : values) next(x);
    for (Eigen::Index i = 0; i < derivatives.rows(); ++i)
      for (Eigen::Index j = 0; j < derivatives.cols(); ++j) next(derivatives(i, j));
  }
  Table table;
};

// The coordinates and velocities of a state.
void coordinates_and_velocities(MovedMotion& motion, const MotionState& state,
                                Eigen::VectorXd& out) {
  const std::vector<double> g = motion.map().coordinates(state);
  out.resize(static_cast<Eigen::Index>(g.size()) + state.xi.size());
  out << Eigen::Map<const Eigen::VectorXd>(g.data(), static_cast<Eigen::Index>(g.size())), state.xi;
}

constexpr double kLargestGrowth = 1e8;

}  // namespace

Sensitivities sensitivities(const Simulation& simulation, const std::vector<std::string>& names) {
  const MotionVariables variables("sensitivities", simulation, names);
  TangentMotion motion("sensitivities", variables, variables.values(),
                       TangentMotion::Carries::errors);
  Sensitivities out;
  for (const MotionVariable& one : variables.all()) out.names.push_back(one.name);
  SensitivityRows rows(*motion.motion().plan().system, out.names);
  Eigen::VectorXd values;
  Eigen::MatrixXd fine, coarse;
  for (const double t : times_of_rows(simulation)) {
    out.status = motion.advance_to(t);
    if (!out.status.ok) break;
    const TangentState& now = motion.now();
    const TangentState other{now.state, now.coarse, {}};
    if (!motion.derivative(now, coordinates_and_velocities, values, fine) ||
        !motion.derivative(other, coordinates_and_velocities, values, coarse)) {
      out.status = {false, 0, t, 0, "the coordinates have no derivative here"};
      break;
    }
    rows.add(t, values, fine);
    const Eigen::MatrixXd off = (fine - coarse).cwiseAbs();
    out.errors.resize(static_cast<size_t>(off.size()));
    for (Eigen::Index i = 0; i < off.rows(); ++i)
      for (Eigen::Index j = 0; j < off.cols(); ++j) {
        double& error = out.errors[static_cast<size_t>(i * off.cols() + j)];
        error = std::max(error, off(i, j));
      }
    for (Eigen::Index j = 0; j < now.columns.cols(); ++j)
      if (!variables.all()[static_cast<size_t>(j)].of_system())
        out.growth = std::max(out.growth, now.columns.col(j).lpNorm<Eigen::Infinity>());
    if (out.growth > kLargestGrowth) {
      out.status = {false, 0, t, 0,
                    fmt::format("derivatives by the start have grown to {:.2g}, more than {:.0e}: "
                                "they have lost their digits; take a shorter run",
                                out.growth, kLargestGrowth)};
      break;
    }
  }
  out.rows = std::move(rows.table);
  out.steps = motion.steps();
  return out;
}

RunTangent tangent(const Simulation& simulation) {
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
    constexpr double e = 0x1p-8;
    if (!ThreeDifferences::derivative(ThreeDifferences::fine, e, moved, column))
      throw ConfigError({"tangent: the start has no derivative"});
    columns.col(j) = column;
  }
  motion.begin_with(columns);
  RunTangent out;
  out.status = motion.advance_to(simulation.config().completed().until);
  const TangentState& end = motion.now();
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
