#include <hamel/systems/by_name.hpp>

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/run/events.hpp>
#include <hamel/framework/run/run/own_system.hpp>
#include <hamel/systems/by_text.hpp>

namespace hamel {

Simulation simulate(const Mechanism& mechanism) {
  return {registry(), mechanism.name(), OwnSystem{maker(mechanism)}};
}

std::vector<std::string> groups() { return registry().groups(); }
std::vector<std::string> retractions(const std::string& group) {
  return group.empty() ? registry().retractions() : registry().retractions_or_common(group);
}
std::vector<std::string> schemes() { return registry().schemes(); }
std::vector<std::string> solvers() { return registry().solvers(); }
std::vector<std::string> systems() { return registry().systems_and_files(); }

SystemDescription describe_system(const std::string& name) {
  const SystemInfo* info = registry().system(name);
  if (info == nullptr)
    throw ConfigError({unknown_name("system", name, registry().systems_and_files())});
  SystemDescription out{.name = info->name,
                        .group = info->group.name,
                        .summary = info->summary,
                        .formula = info->formula,
                        .known = info->known,
                        .source = info->source,
                        .parameters = info->fields,
                        .inputs = info->inputs,
                        .coordinates = {},
                        .velocities = {},
                        .events = {}};
  const ModelDescription model = describe_model(info->make({}));
  out.coordinates = model.coordinates;
  out.velocities = model.velocities;
  out.events = model.events;
  return out;
}

Simulation simulate_text(const std::string& text, const std::string& origin) {
  return {registry(), origin, OwnSystem{data_system_maker(registry(), origin, text)}};
}

ModelDescription describe_model(const SystemModel& model) {
  SystemModel complete = model;
  registry().complete(complete);
  ModelDescription out;
  out.name = complete.name;
  out.group = complete.group.name;
  out.parameters = complete.fields;
  out.inputs = complete.inputs;
  out.parts = complete.parts;
  out.coordinates = complete.group.columns;
  out.coordinate_units = units_of_element(complete.group);
  for (const Component& c : components_of(complete)) {
    out.velocities.push_back(c.name);
    out.velocity_units.push_back(c.unit);
  }
  for (const OtherName& other : complete.other_names)
    out.other_names.emplace_back(other.name, other.place);
  for (const Event& event : events_of(complete)) out.events.push_back(event.name);
  return out;
}

}  // namespace hamel
