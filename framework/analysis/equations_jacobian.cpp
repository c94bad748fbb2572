// Derivatives of the quantities of a state: exact where there are formulas, else differences.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include <Eigen/Core>

#include <hamel/framework/analysis/central_differences.hpp>
#include <hamel/framework/analysis/equations_insides.hpp>
#include <hamel/framework/analysis/motion_formulas.hpp>
#include <hamel/framework/analysis/recorded_jacobian.hpp>
#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/natural_units.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>

namespace hamel {
namespace {

constexpr double kEpsilonOfEquations = std::numeric_limits<double>::epsilon();

}  // namespace

// Derivatives of the recorded rates; none where there are no formulas, or inputs that change.
std::optional<JacobianOfState> Equations::exact_jacobian(const std::string& of, const Start& at,
                                                         double t) const {
  insides_->put(at, t);
  const std::shared_ptr<Inputs>& given = insides_->plan.setup.inputs;
  std::vector<double> values = {t};
  values.insert(values.end(), at.configuration.begin(), at.configuration.end());
  values.insert(values.end(), at.velocity.begin(), at.velocity.end());
  for (size_t i = 0; i < system().inputs.size(); ++i) {
    if (given != nullptr && !given->tables()[i].times.empty()) return {};
    values.push_back(given == nullptr ? 0 : given->at(t)[static_cast<Eigen::Index>(i)]);
  }
  std::optional<RecordedJacobian> recorded_jacobian;
  try {
    recorded_jacobian.emplace(recorded(), of);
  } catch (const std::domain_error&) {
    return {};
  }
  const auto rows = static_cast<int>(at.velocity.size());
  const std::vector<double> found = (*recorded_jacobian)(values);
  const int columns = static_cast<int>(found.size()) / rows;
  const Eigen::VectorXd noise = noise_of(
      [&](double e) -> Eigen::VectorXd {
        std::vector<double> there = values;
        for (size_t i = 0; i < there.size(); ++i)
          there[i] += e * std::max(1.0, std::abs(there[i])) *
                      std::sin(12.9898 * static_cast<double>(i + 1));
        const std::vector<double> moved = (*recorded_jacobian)(there);
        return Eigen::Map<const Eigen::VectorXd>(moved.data(),
                                                 static_cast<Eigen::Index>(moved.size()));
      },
      0x1p-30);
  JacobianOfState out{NumberMatrix(rows, columns), NumberMatrix(rows, columns)};
  for (int j = 0; j < columns; ++j) {
    for (int i = 0; i < rows; ++i) {
      out.values(i, j) = found[static_cast<size_t>(j * rows + i)];
      out.errors(i, j) = noise[j * rows + i];
    }
  }
  return out;
}

// The round-off of a quantity, which is that of a linear solve: along a line on which all numbers
// of the state change, in units of the system's own.
std::vector<double> Equations::round_off_of(const std::string& quantity, const Start& state,
                                            double t) const {
  insides_->put(state, t);
  const Eigen::VectorXd g = insides_->g, xi = insides_->xi;
  const std::vector<double> scales =
      natural_units(components_of(system()), insides_->mechanics, g.data());
  const Eigen::Map<const Eigen::VectorXd> units(scales.data(), xi.size());
  double rate = xi.cwiseQuotient(units).lpNorm<Eigen::Infinity>();
  if (!(rate > 0)) rate = 1;
  Eigen::VectorXd along(xi.size());
  for (Eigen::Index i = 0; i < along.size(); ++i)
    along[i] = units[i] * std::sin(12.9898 * static_cast<double>(i + 1));
  const Eigen::VectorXd noise = noise_of(
      [&](double e) -> Eigen::VectorXd {
        Start there = state;
        there.configuration = insides_->moved(g, e * along);
        there.velocity = Insides::numbers_of(xi + e * rate * along);
        const std::vector<double> values = quantity_at(quantity, there, t);
        return Eigen::Map<const Eigen::VectorXd>(values.data(),
                                                 static_cast<Eigen::Index>(values.size()));
      },
      0x1p-30);
  return Insides::numbers_of(noise);
}

JacobianOfState Equations::jacobian(const std::string& quantity, const std::string& of,
                                    const Start& state, double t) const {
  std::vector<std::string> mistakes;
  const std::vector<std::string> known = arguments();
  if (std::ranges::count(quantities(), quantity) == 0)
    mistakes.push_back(unknown_name("quantity", quantity, quantities()));
  if (std::ranges::count(known, of) == 0) mistakes.push_back(unknown_name("of", of, known));
  if (!mistakes.empty()) throw ConfigError(mistakes);

  insides_->put(state, t);
  const Start here{insides_->state.coordinates, insides_->state.velocity, {}};
  const bool of_parameter = std::ranges::count(system().fields, of, &Field::name) > 0;
  if (quantity == "rate" && !of_parameter) {
    if (auto exact = exact_jacobian(of, here, t)) return std::move(*exact);
    insides_->put(here, t);
  }
  const Eigen::VectorXd g = insides_->g;
  const int n = insides_->mechanics.dim();
  const RunPlan& plan = insides_->plan;
  // The quantity with the j-th component of the argument moved by x.
  std::function<std::vector<double>(int j, double x)> moved;
  std::vector<double> sizes;  // of the components, whose round-off is that of the argument
  if (of == "velocity") {
    sizes = here.velocity;
    moved = [&](int j, double x) {
      Start there = here;
      there.velocity[static_cast<size_t>(j)] += x;
      return quantity_at(quantity, there, t);
    };
  } else if (of == "configuration") {
    const auto [least, most] = std::ranges::minmax(here.configuration);
    sizes.assign(static_cast<size_t>(n), std::max(std::abs(least), std::abs(most)));
    moved = [&](int j, double x) {
      Start there = here;
      there.configuration = insides_->moved(g, x * Eigen::VectorXd::Unit(n, j));
      return quantity_at(quantity, there, t);
    };
  } else if (of == "time") {
    sizes = {t};
    moved = [&](int /*j*/, double x) { return quantity_at(quantity, here, t + x); };
  } else {
    const auto field = std::ranges::find(system().fields, of, &Field::name);
    const bool parameter = field != system().fields.end();
    if (parameter) {
      sizes = field->value;
    } else {
      const auto input = std::ranges::find(system().inputs, of, &InputField::name);
      const auto i = static_cast<Eigen::Index>(input - system().inputs.begin());
      sizes = {plan.setup.inputs == nullptr ? 0 : plan.setup.inputs->at(t)[i]};
    }
    moved = [&, parameter](int j, double x) {
      std::vector<double> there = sizes;
      there[static_cast<size_t>(j)] += x;
      Simulation other = insides_->simulation;
      if (parameter) other.set(of, there);
      else other.input(of, there.front());
      return Equations(other).quantity_at(quantity, here, t);
    };
  }

  const std::vector<double> noise = round_off_of(quantity, here, t);
  const auto columns = static_cast<int>(sizes.size());
  const auto rows = static_cast<int>(quantity_at(quantity, here, t).size());
  JacobianOfState out{NumberMatrix(rows, columns), NumberMatrix(rows, columns)};
  for (int j = 0; j < columns; ++j) {
    const auto curve = [&](double x) -> Eigen::VectorXd {
      try {
        const std::vector<double> values = moved(j, x);
        return Eigen::Map<const Eigen::VectorXd>(values.data(), rows);
      } catch (const ConfigError&) {  // out of the range of the argument
        return Eigen::VectorXd::Constant(rows, std::numeric_limits<double>::quiet_NaN());
      }
    };
    StepRange steps =
        steps_of_any_scale(kEpsilonOfEquations * std::abs(sizes[static_cast<size_t>(j)]));
    steps.noise = Eigen::Map<const Eigen::VectorXd>(noise.data(), rows);
    const Derivative found = CentralDifferences(curve, steps).derivative(1);
    for (int i = 0; i < rows; ++i) {
      out.values(i, j) = found.value[i];
      out.errors(i, j) = found.error[i];
    }
  }
  return out;
}

}  // namespace hamel
