// [events] of a file that describes a system. Not installed.
//
//   [events]
//   straight = "steer"        # zero at the event
//   tipped = { value = "abs(lean) - 1", meaning = "it lies", direction = 1 }
//                             # +1, -1, or 0 for both ways
#pragma once

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/toml_formulas.hpp>
#include <hamel/framework/mechanics/system.hpp>
#include <hamel/framework/run/data/event_formula.hpp>

namespace hamel {

/// An event as stated, whose function is a formula.
struct StatedEvent {
  Event event;
  std::string key;
  const toml::node* value;
};

/// Events of the file; their formulas are read where the system is complete.
inline std::vector<StatedEvent> stated_events(TomlReader& read, const toml::table& file) {
  std::vector<StatedEvent> out;
  const toml::node* entries = file.get("events");
  if (entries == nullptr) return out;
  if (!entries->is_table()) return read.wrong(*entries, "events", "a table"), out;
  for (const auto& [name, node] : *entries->as_table()) {
    Event event{std::string(name.str()), "", 0, {}};
    const std::string key = "events." + event.name;
    const toml::node* value = &node;
    if (const toml::table* table = node.as_table()) {
      value = table->get("value");
      for (const auto& [word, entry] : *table) {
        if (word == "meaning") read.value(entry, key + ".meaning", event.meaning);
        else if (word == "direction") read.value(entry, key + ".direction", event.direction);
        else if (word != "value")
          read.unknown_key(entry, std::string(word.str()), {"value", "meaning", "direction"});
      }
      if (value == nullptr) {
        read.wrong(node, key, "a formula, value = ...");
        continue;
      }
    }
    if (std::abs(event.direction) > 1) read.wrong(node, key + ".direction", "-1, 0 or 1");
    out.push_back({std::move(event), key, value});
  }
  return out;
}

/// Formulas of t, of these names of coordinates and rates, and of sensors and outputs of a system
/// that is complete. Mistakes are those of `read`.
inline std::vector<Event> read_events(TomlReader& read, TomlFormulas& formulas,
                                      const toml::table& file, const SystemModel& system,
                                      const std::vector<std::string>& coordinates,
                                      const std::vector<std::string>& rates) {
  std::vector<Event> out;
  std::vector<std::string> names = {"t"};
  names.insert(names.end(), coordinates.begin(), coordinates.end());
  names.insert(names.end(), rates.begin(), rates.end());
  const StateVariables variables(system, std::move(names));
  for (StatedEvent& stated : stated_events(read, file)) {
    const size_t before = read.mistakes.size();
    auto formula = formulas.expression(*stated.value, stated.key, variables.names());
    for (size_t i = before; i < read.mistakes.size(); ++i)
      read.mistakes[i] = variables.explain(read.mistakes[i]);
    if (!formula) continue;
    stated.event.value = variables.value(std::move(*formula));
    out.push_back(std::move(stated.event));
  }
  return out;
}

}  // namespace hamel
