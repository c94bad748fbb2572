#include <hamel/framework/tangent/sensitivities.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <hamel/framework/tangent/observed.hpp>
#include <hamel/framework/tangent/tangent_motion.hpp>

namespace hamel {
namespace {

// The times of the rows of a run: those of the options, or its nodes.
std::vector<double> times_of_rows(const Simulation& simulation) {
  const Config config = simulation.config().completed();
  const std::vector<double> given = config.recorded_times();
  if (!given.empty()) return given;
  std::vector<double> out;
  Simulation plain = simulation.unobserved();
  plain.observe([&](const Snapshot& row) {
    out.push_back(row.time);
    return true;
  });
  const Result result = plain.run();
  // The event that ended it is met again on the way to the end.
  if (result.stopped_by_event) out.back() = config.until;
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

Sensitivities Simulation::sensitivities(const std::vector<std::string>& names) const {
  const Simulation simulation = unobserved();
  const MotionVariables variables("sensitivities", simulation, names);
  TangentMotion motion("sensitivities", variables, variables.values(),
                       TangentMotion::Carries::errors);
  Sensitivities out;
  for (const MotionVariable& one : variables.all()) out.names.push_back(one.name);
  SensitivityRows rows(*motion.motion().plan().system, out.names);
  Eigen::VectorXd values, first = Eigen::VectorXd::Zero(variables.values().size());
  for (Eigen::Index j = 0; j < first.size(); ++j)
    if (!variables.all()[static_cast<size_t>(j)].of_system())
      first[j] = motion.natural_length(motion.now().state, motion.now().columns.col(j));
  Eigen::MatrixXd fine, coarse;
  const bool given_times = !config().completed().recorded_times().empty();
  for (const double t : times_of_rows(*this)) {
    out.status = motion.advance_to(t);
    if (!out.status.ok) break;
    const TangentState& now = motion.now();
    if (motion.over()) {
      out.end_time.assign(now.time.begin(), now.time.end());
      if (given_times) break;
    }
    const TangentState other{now.state, now.coarse, {}, now.time};
    if (!motion.derivative(now, coordinates_and_velocities, values, fine) ||
        !motion.derivative(other, coordinates_and_velocities, values, coarse)) {
      out.status = {false, 0, t, 0, "the coordinates have no derivative here"};
      break;
    }
    rows.add(now.state.time, values, fine);
    const Eigen::MatrixXd off = (fine - coarse).cwiseAbs();
    out.errors.resize(static_cast<size_t>(off.size()));
    for (Eigen::Index i = 0; i < off.rows(); ++i)
      for (Eigen::Index j = 0; j < off.cols(); ++j) {
        double& error = out.errors[static_cast<size_t>(i * off.cols() + j)];
        error = std::max(error, off(i, j));
      }
    for (Eigen::Index j = 0; j < now.columns.cols(); ++j)
      if (first[j] > 0)
        out.growth =
            std::max(out.growth, motion.natural_length(now.state, now.columns.col(j)) / first[j]);
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

Gradient Simulation::gradient(const std::string& objective,
                              const std::vector<std::string>& names) const {
  const Simulation simulation = unobserved();
  const MotionVariables variables("gradient", simulation, names);
  TangentMotion motion("gradient", variables, variables.values(), TangentMotion::Carries::errors);
  ObservedQuantities quantity;
  quantity.add(*motion.motion().plan().system, "gradient", objective);
  const auto of_state = [&](MovedMotion& at, const MotionState& state, Eigen::VectorXd& out) {
    quantity(at, state, out);
  };
  Gradient out;
  for (const MotionVariable& one : variables.all()) out.names.push_back(one.name);
  out.status = motion.advance_to(simulation.config().completed().until);
  if (!out.status.ok) return out;
  const TangentState& end = motion.now();
  const TangentState other{end.state, end.coarse, {}, end.time};
  Eigen::VectorXd value;
  Eigen::MatrixXd fine, coarse;
  if (!motion.derivative(end, of_state, value, fine) ||
      !motion.derivative(other, of_state, value, coarse)) {
    out.status = {false, 0, end.state.time, 0, objective + " has no derivative here"};
    return out;
  }
  out.value = value[0];
  for (Eigen::Index j = 0; j < fine.cols(); ++j) {
    out.by.push_back(fine(0, j));
    out.errors.push_back(std::abs(fine(0, j) - coarse(0, j)));
  }
  return out;
}

}  // namespace hamel
