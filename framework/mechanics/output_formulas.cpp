#include <hamel/framework/mechanics/output_formulas.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/mechanics/quantities.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>

namespace hamel {

std::map<std::string, double> constants_in_formulas(const SystemModel& system,
                                                    const std::vector<std::string>& variables) {
  std::map<std::string, double> out;
  for (const Field& field : system.fields) {
    for (size_t i = 0; i < field.value.size(); ++i) {
      const std::string name =
          field.value.size() == 1 ? field.name : fmt::format("{}{}", field.name, i + 1);
      if (std::find(variables.begin(), variables.end(), name) == variables.end())
        out.emplace(name, field.value[i]);
    }
  }
  return out;
}

std::vector<ReadyOutput> ready_outputs(
    const SystemModel& system, std::vector<std::string>& variables,
    const std::function<void(const OutputFormula&, const std::string&)>& missing) {
  std::vector<ReadyOutput> out;
  if (system.outputs.empty()) return out;
  const QuantityNames names(system);
  const auto constants = constants_in_formulas(system, variables);
  std::vector<size_t> left;
  for (size_t i = 0; i < system.outputs.size(); ++i) left.push_back(i);
  std::vector<std::string> messages(left.size());
  for (bool found = true; found;) {
    found = false;
    std::vector<size_t> rest;
    for (const size_t i : left) {
      try {
        Expression formula(names.in_formula(system.outputs[i].formula), variables, constants);
        out.push_back({i, variables.size(), std::move(formula)});
        variables.push_back(system.outputs[i].name);
        found = true;
      } catch (const ExpressionError& error) {
        messages[i] = names.in_words(error.what());
        rest.push_back(i);
      }
    }
    left = std::move(rest);
  }
  if (missing)
    for (const size_t i : left) missing(system.outputs[i], messages[i]);
  return out;
}

std::string path_column(const Sensor& sensor) {
  return sensor.velocity < 0 ? "" : sensor.name + ".path";
}

std::string friction_work_column(const ContactLaw& law) { return law.name + ".friction_work"; }

std::vector<std::string> output_mistakes(const SystemModel& system) {
  std::vector<std::string> columns = QuantityNames(system).variables(), out;
  const auto add = [&](const std::vector<std::string>& names) {
    columns.insert(columns.end(), names.begin(), names.end());
  };
  add(system.reactions);
  for (const Quantity& quantity : kMeasuredColumns)
    if (std::string(quantity.name) != kTime.name) columns.emplace_back(quantity.name);
  for (int i = 1; i <= system.group.dim; ++i) {
    columns.push_back(fmt::format("mu{}", i));
    if (static_cast<size_t>(i) > system.reactions.size())  // how many there are is up to the run
      columns.push_back(fmt::format("lambda{}", i));
  }
  for (const Sensor& sensor : system.sensors) {
    add(sensor.columns);
    if (sensor.velocity >= 0) columns.push_back(path_column(sensor));
  }
  for (const ContactLaw& law : system.contact_laws) {
    columns.push_back(law.name + ".mode");
    if (!law.tangential.empty()) columns.push_back(friction_work_column(law));
  }
  const auto wrong = [&](const OutputFormula& output, const std::string& what) {
    out.push_back(fmt::format("{}outputs.{}: {}", output.where, output.name, what));
  };
  const auto constants = constants_in_formulas(system, {});
  std::vector<std::string> taken = columns;
  for (const OutputFormula& output : system.outputs) {
    if (!Expression::allows(output.name)) wrong(output, "expected a name allowed in a formula");
    else if (constants.contains(output.name) ||
             std::find(taken.begin(), taken.end(), output.name) != taken.end())
      wrong(output, "expected a name that nothing else has");
    taken.push_back(output.name);
  }
  if (out.empty()) ready_outputs(system, columns, wrong);
  return out;
}

}  // namespace hamel
