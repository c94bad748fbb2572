#include <hamel/systems/by_name.hpp>

#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/run/events.hpp>
#include <hamel/framework/run/run/own_system.hpp>

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
  SystemModel model = info->make({});
  if (model.group.dim == 0) model.group = *registry().group_or_product(model.group.name);
  out.coordinates = model.group.columns;
  for (const Component& c : components_of(model)) out.velocities.push_back(c.name);
  for (const Event& event : events_of(model, nullptr)) out.events.push_back(event.name);
  return out;
}

}  // namespace hamel
