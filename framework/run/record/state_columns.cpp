#include <hamel/framework/run/record/state_columns.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <hamel/framework/mechanics/components.hpp>
#include <hamel/framework/mechanics/quantity_names.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/record/measures.hpp>
#include <hamel/framework/run/record/named_columns.hpp>

namespace hamel {
namespace {

// The rows of one part together, those of the part that is named first at first: rear.reaction1 is
// one of rear. Rows without a name are last.
std::vector<std::size_t> by_parts(const std::vector<std::string>& reactions, std::size_t rows) {
  const auto part = [&](std::size_t row) {
    return reactions[row].substr(0, reactions[row].rfind('.'));
  };
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < reactions.size(); ++i) {
    std::size_t at = out.size();
    while (at > 0 && part(out[at - 1]) != part(i)) --at;
    out.insert(out.begin() + static_cast<long>(at > 0 ? at : out.size()), i);
  }
  for (std::size_t i = out.size(); i < rows; ++i) out.push_back(i);
  return out;
}

ColumnGroup numbered(const char* name, const char* meaning, std::size_t count) {
  ColumnGroup out{name, "", meaning, "", {}};
  for (std::size_t i = 1; i <= count; ++i) out.columns.push_back(name + std::to_string(i));
  return out;
}

std::vector<std::string> units_of(const std::vector<Component>& components, bool momentum) {
  std::vector<std::string> out;
  for (const Component& component : components)
    out.push_back(momentum ? unit_of_momentum(component) : component.unit);
  return out;
}

}  // namespace

StateColumns::StateColumns(const SystemModel& system, const Has& has) : sensors_(system.sensors) {
  const std::vector<Component> components = components_of(system);
  add(Of::time, kTime);
  add(Of::coordinate, element_columns(system), units_of_element(system.group));
  const ColumnGroup velocities = velocity_columns(system);
  add(Of::velocity, velocities, units_of(components, false));
  add(Of::energy, kEnergy);
  add(Of::energy_error, kEnergyError);
  add(Of::constraint, kConstraint);
  add(Of::group_defect, kGroupDefect);
  add(Of::iterations, kIterations);
  add(Of::residual, kResidual);
  if (has.holonomic) add(Of::holonomic, kHolonomic);
  ColumnGroup momenta = numbered("mu", "", static_cast<std::size_t>(system.group.dim));
  momenta.meaning = fmt::format("nodal body momentum, of {}", fmt::join(system.rates, ","));
  momenta.frame = velocities.frame;
  add(Of::momentum, std::move(momenta), units_of(components, true));
  if (has.work) add(Of::work, kWork);
  if (has.reactions) {
    const auto rows = static_cast<std::size_t>(system.mechanics->constraint_count());
    const std::vector<std::size_t> order = by_parts(system.reactions, rows);
    ColumnGroup group = numbered("lambda", "multipliers of the rows A xi = b", rows);
    std::vector<std::string> units;
    for (std::size_t i = 0; i < rows; ++i) {
      if (i < system.reactions.size()) group.columns[i] = system.reactions[order[i]];
      units.push_back(unit_of_reaction(system, static_cast<int>(order[i])));
    }
    add(Of::reaction, std::move(group), units, order);
  }
  if (has.reaction_power) add(Of::reaction_power, kReactionPower);
  add_sensors(has);
  if (has.modes) {
    for (const ContactLaw& law : system.contact_laws) {
      const std::string name = law.name + ".mode";
      columns_.push_back({Of::mode, groups_.size(), name, "1"});
      groups_.push_back({name, "1", "0 open, 1 rolling, 2 sliding", "", {name}});
    }
    std::size_t place = 0;
    for (Column& column : columns_)
      if (column.of == Of::mode) column.place = place++;
  }
  if (has.friction_works) {
    for (const ContactLaw& law : system.contact_laws)
      if (!law.tangential.empty())
        add(Of::friction_work,
            {friction_work_column(law),
             "J",
             "work of its friction since the start",
             "",
             {friction_work_column(law)}},
            {"J"});
  }
  if (has.exact) {
    add(Of::exact_error, kExactError);
    add(Of::exact_velocity_error, kExactVelocityError);
  }
  add_outputs(system);
}

void StateColumns::add_outputs(const SystemModel& system) {
  std::vector<std::string> variables;
  for (const Column& column : columns_) variables.push_back(name_in_formula(column.name));
  outputs_ = ready_outputs(
      system, variables, [&](const OutputFormula& output, const std::string& message) {
        missing_.push_back(fmt::format("{}outputs.{}: {}", output.where, output.name, message));
      });
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const OutputFormula& output = system.outputs[outputs_[i].output];
    columns_.push_back({Of::output, i, output.name, output.unit});
    groups_.push_back({output.name,
                       output.unit,
                       output.meaning.empty() ? output.formula : output.meaning,
                       "",
                       {output.name}});
  }
  values_.resize(columns_.size());
}

void StateColumns::complete(std::span<double> row) const {
  for (const ReadyOutput& output : outputs_) row[output.place] = output.formula(row);
}

void StateColumns::add_sensors(const Has& has) {
  std::size_t place = 0, path = 0;
  for (const Sensor& sensor : sensors_) {
    ColumnGroup group{sensor.name, "", sensor.meaning, "", {}};
    std::vector<std::string> units;
    for (std::size_t i = 0; i < sensor.columns.size(); ++i, ++place) {
      const bool of_acceleration = i >= sensor.first_acceleration;
      if (of_acceleration && !has.acceleration) continue;
      columns_.push_back({of_acceleration ? Of::acceleration : Of::sensor, place, sensor.columns[i],
                          sensor.units[i]});
      group.columns.push_back(sensor.columns[i]);
      units.push_back(sensor.units[i]);
    }
    if (has.paths && sensor.velocity >= 0) {
      columns_.push_back({Of::path, path++, path_column(sensor), "m"});
      group.columns.push_back(columns_.back().name);
      units.emplace_back("m");
    }
    group.unit = fmt::format("{}", fmt::join(units, ","));
    groups_.push_back(std::move(group));
  }
}

double StateColumns::measured(std::size_t place, const Snapshot& state,
                              const StateExtras& extras) const {
  for (const Sensor& sensor : sensors_) {
    const std::size_t count = sensor.columns.size();
    if (place >= count) {
      place -= count;
      continue;
    }
    std::vector<double> values(count);
    sensor.value(state.coordinates, state.velocity, extras.acceleration, values);
    return values[place];
  }
  return 0;
}

void StateColumns::add(Of of, const Quantity& quantity) {
  columns_.push_back({of, 0, quantity.name, quantity.unit});
  groups_.push_back({quantity.name, quantity.unit, quantity.meaning, "", {quantity.name}});
}

void StateColumns::add(Of of, ColumnGroup group, const std::vector<std::string>& units,
                       const std::vector<std::size_t>& places) {
  for (std::size_t i = 0; i < group.columns.size(); ++i) {
    columns_.push_back(
        {of, places.empty() ? i : places[i], group.columns[i], i < units.size() ? units[i] : ""});
  }
  const bool known = std::ranges::any_of(units, [](const auto& unit) { return !unit.empty(); });
  if (of != Of::reaction || known) group.unit = fmt::format("{}", fmt::join(units, ","));
  groups_.push_back(std::move(group));
}

std::optional<std::size_t> StateColumns::find(Of of) const {
  const auto it = std::ranges::find(columns_, of, &Column::of);
  if (it == columns_.end()) return {};
  return static_cast<std::size_t>(it - columns_.begin());
}

double StateColumns::output(std::size_t place, const Snapshot& state,
                            const StateExtras& extras) const {
  const Expression& formula = outputs_[place].formula;
  for (const std::size_t j : formula.used()) values_[j] = value(j, state, extras);
  return formula(values_);
}

double StateColumns::value(std::size_t i, const Snapshot& state, const StateExtras& extras) const {
  const Column& column = columns_[i];
  switch (column.of) {
    case Of::time: return state.time;
    case Of::coordinate: return state.coordinates[column.place];
    case Of::velocity: return state.velocity[column.place];
    case Of::momentum: return state.momentum[column.place];
    case Of::energy: return state.energy;
    case Of::energy_error:
      return extras.balance_error.value_or(energy_error(state.energy, extras.energy_start));
    case Of::constraint: return state.constraint;
    case Of::holonomic: return state.holonomic;
    case Of::group_defect: return state.group_defect;
    case Of::iterations: return static_cast<double>(state.iterations);
    case Of::residual: return state.residual;
    case Of::work: return extras.work;
    case Of::reaction: return extras.reactions.empty() ? 0 : extras.reactions[column.place];
    case Of::reaction_power: return extras.reaction_power;
    case Of::sensor:
    case Of::acceleration: return measured(column.place, state, extras);
    case Of::path: return extras.paths.empty() ? 0 : extras.paths[column.place];
    case Of::mode: return extras.modes.empty() ? 0 : extras.modes[column.place];
    case Of::friction_work: return 0;  // known when it is settled
    case Of::exact_error: return extras.exact_error;
    case Of::exact_velocity_error: return extras.exact_velocity_error;
    case Of::output: return output(column.place, state, extras);
  }
  return 0;
}

void StateColumns::require(std::size_t i, StateParts& parts) const {
  each_source(i, [&](std::size_t j) { require(columns_[j].of, parts); });
}

void StateColumns::require(Of of, StateParts& parts) {
  switch (of) {
    case Of::coordinate:
    case Of::sensor:
    case Of::acceleration: parts.coordinates = true; break;
    case Of::momentum: parts.momentum = true; break;
    case Of::energy:
    case Of::energy_error: parts.energy = true; break;
    case Of::constraint:
    case Of::holonomic:
    case Of::group_defect:
    case Of::iterations:
    case Of::residual: parts.measures = true; break;
    default: break;
  }
}

}  // namespace hamel
