// The systems of a study: registered ones, and data files as they were when the study began.
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/run/own_system.hpp>
#include <hamel/framework/study/parts.hpp>

namespace hamel::study {
namespace {

// Null for a name that is neither registered nor a file's.
OwnSystem::Maker maker(const Registry& registry, const StudySystem& system) {
  if (system.model) return system.model;
  if (names_file(system.name))
    return system.data.empty() ? data_system_maker(registry, system.name)
                               : data_system_maker(registry, system.name, system.data);
  const SystemInfo* info = registry.system(system.name);
  return info == nullptr ? OwnSystem::Maker() : info->make;
}

}  // namespace

void read_data(StudyConfig& config) {
  for (StudySystem& system : config.systems) {
    for (auto& [name, signal] : system.inputs) {
      try {
        if (const InputFile* file = std::get_if<InputFile>(&signal))
          signal = read_input_table("input", name, *file);
      } catch (const ConfigError&) {  // the checks report it
      }
    }
    if (system.model || !names_file(system.name) || !system.data.empty()) continue;
    try {
      system.data = read_system_file(system.name);
    } catch (const ConfigError&) {  // the checks report it
    }
  }
}

Simulation simulation(const Registry& registry, const StudySystem& system, const Config& config) {
  const auto make = maker(registry, system);
  Simulation out =
      make ? Simulation(registry, system.name, OwnSystem{make}) : Simulation(registry, system.name);
  return out.config(config);
}

SystemModel model(const Registry& registry, const StudySystem& system) {
  SystemModel out = maker(registry, system)(system.parameters);
  registry.complete(out);
  if (std::vector<std::string> mistakes; !system.inputs.empty() && out.drive)
    drive(out, make_inputs(out, {}, {0, 0}, mistakes));  // of what orders hold there
  return out;
}

Status advance(Run& run, long steps, const std::atomic<bool>* stop) {
  constexpr long kChunk = 256;
  Status status;
  for (; steps > 0 && status.ok && !stopped(stop); steps -= kChunk)
    status = run.step(std::min(steps, kChunk));
  return status;
}

}  // namespace hamel::study
