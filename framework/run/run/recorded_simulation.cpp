#include <hamel/framework/run/run/recorded_simulation.hpp>

#include <variant>

#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/run/own_system.hpp>

namespace hamel {

Simulation recorded_simulation(const RunFile& run, const Registry& registry) {
  Config config = run.config();
  for (auto& [name, signal] : config.inputs) {
    if (const auto* table = std::get_if<InputFile>(&signal))
      signal = read_input_table(name, *table, run.file(table->path));
  }
  const std::string& system = config.system;
  Simulation out =
      names_file(system)
          ? Simulation(registry, system,
                       OwnSystem{data_system_maker(registry, system, run.file(system))})
          : Simulation(registry, system);
  out.config(std::move(config));
  return out;
}

}  // namespace hamel
