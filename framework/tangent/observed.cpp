#include <hamel/framework/tangent/observed.hpp>

#include <fmt/format.h>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/mechanics/quantities.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>

namespace hamel {
namespace {

// The unit of a column; "" of a formula.
std::string unit_of_quantity(const SystemModel& system, const std::string& name) {
  if (name == kEnergy.name) return kEnergy.unit;
  const auto place = QuantityNames(system).find(name);
  if (!place) return "";
  const size_t columns = system.group.columns.size();
  if (*place >= columns) return components_of(system)[*place - columns].unit;
  std::vector<std::string> units = units_of_element(system.group);
  units.resize(columns);
  return units[*place];
}

}  // namespace

ObservedQuantities::Value ObservedQuantities::value_of(const SystemModel& system,
                                                       const std::string& formula) {
  if (formula == kEnergy.name) return {};
  const QuantityNames names(system);
  if (const auto found = names.find(formula))  // needs no formula
    return [place = *found](double, std::span<const double> g, std::span<const double> xi) {
      return place < g.size() ? g[place] : xi[place - g.size()];
    };
  const StateVariables variables(system, names.variables());
  return variables.value(Expression(names.in_formula(formula), variables.names(),
                                    constants_in_formulas(system, variables.names())));
}

void ObservedQuantities::add(const SystemModel& system, const std::string& where,
                             const std::string& formula) {
  try {
    value_of(system, formula);
  } catch (const ExpressionError& error) {
    const QuantityNames names(system);
    const StateVariables variables(system, names.variables());
    throw ConfigError(
        {fmt::format("{}: {}", where, names.in_words(variables.explain(error.what())))});
  }
  formulas_.push_back(formula);
  units_.push_back(unit_of_quantity(system, formula));
}

void ObservedQuantities::operator()(const MovedMotion& motion, const MotionState& state,
                                    Eigen::VectorXd& out) {
  std::vector<Value>& values = values_[&motion];
  if (values.empty())
    for (const std::string& formula : formulas_)
      values.push_back(value_of(*motion.plan().system, formula));
  out.resize(static_cast<Eigen::Index>(formulas_.size()));
  const std::vector<double> g = motion.map().coordinates(state);
  const std::span<const double> xi(state.xi.data(), static_cast<size_t>(state.xi.size()));
  for (size_t i = 0; i < values.size(); ++i) {
    double& number = out[static_cast<Eigen::Index>(i)];
    if (values[i]) {
      number = values[i](state.time, g, xi);
      continue;
    }
    const Mechanics& mechanics = *motion.plan().setup.mechanics;
    Eigen::MatrixXd inertia(state.xi.size(), state.xi.size());
    mechanics.inertia(state.g.data(), inertia);
    number = 0.5 * state.xi.dot(inertia * state.xi) + mechanics.potential(state.g.data());
  }
}

}  // namespace hamel
