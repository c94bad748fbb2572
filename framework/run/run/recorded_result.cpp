#include <hamel/framework/run/run/recorded_result.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/record/recorded_system.hpp>
#include <hamel/framework/run/run/own_system.hpp>
#include <hamel/framework/run/run/plan/plan.hpp>

namespace hamel {
namespace {

// The configuration with the system and the tables that the file holds.
Config with_tables(Config config, const RunFile& run) {
  for (auto& [name, signal] : config.inputs) {
    if (const auto* table = std::get_if<InputFile>(&signal))
      signal = read_input_table(name, name, *table, run.file(table->path));
  }
  return config;
}

// The system by its name or text; else none, and the reason.
std::optional<PlannedSystem> known_system(const RunFile& run, const Registry& registry,
                                          const RecordedSystem& recorded, const Config& config,
                                          std::string& reason) {
  Mistakes mistakes;
  std::optional<PlannedSystem> out;
  if (names_file(config.system)) {
    const OwnSystem own{data_system_maker(registry, config.system, run.file(config.system))};
    out = plan_system(registry, config, &own, mistakes);
    mistakes.refuse();  // the file holds all that it is made of
    return out;
  }
  if (registry.system(config.system) == nullptr) {
    reason = fmt::format("the system '{}' is none of this program", recorded.model.name);
    return {};
  }
  out = plan_system(registry, config, nullptr, mistakes);
  if (out && mistakes.none() && recorded.has_columns_of(*out->model)) return out;
  reason =
      fmt::format("the system '{}' of this program is another than the recorded one{}",
                  recorded.model.name, mistakes.none() ? "" : " (" + mistakes.all().front() + ")");
  return {};
}

}  // namespace

RecordedResult recorded_result(const RunFile& run, const Registry& registry, std::size_t most) {
  const std::string record = run.record();
  RecordedResult out;
  Result& result = out.result;
  result.config = recorded_config(record, run.path());
  result.config.inputs = run.config().inputs;  // by their names
  RecordedSystem recorded(run, registry);
  std::string reason;
  if (auto known = known_system(run, registry, recorded, with_tables(result.config, run), reason)) {
    result.system = std::move(known->model);
    result.inputs = std::move(known->inputs);
  } else {
    out.lack = reason +
               ": it is shown by its columns, without what its program alone can draw, its bodies, "
               "and without the meaning of its reactions and inputs";
    result.system = std::make_shared<const SystemModel>(std::move(recorded.model));
  }
  read_record(record, run.path(), result);
  result.trajectory = read_rows(run, most, result.system.get());
  return out;
}

}  // namespace hamel
