// The inputs of a run or of a system of a study, read from TOML. Not installed.
//
//   [inputs]
//   torque = 2.5                                         a constant
//   rate = "gait.csv:hold"                               a file (input_signals.hpp)
//   angle = {t = [0, 1], value = [0, 0.2], hold = true}  a table
#pragma once

#include <string>

#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/framework/run/names/input_signals.hpp>

namespace hamel {

inline void read_inputs(TomlReader& read, const toml::node& node, InputSignals& out) {
  const toml::table* table = node.as_table();
  if (table == nullptr) return read.wrong(node, "inputs", "a table of inputs");
  for (const auto& [name, entry] : *table) {
    const std::string field(name.str()), key = "inputs." + field;
    if (const auto value = entry.value<double>()) {
      out[field] = *value;
    } else if (const auto text = entry.value<std::string>()) {
      out[field] = input_signal(*text);
    } else if (const toml::table* rows = entry.as_table()) {
      InputTable given;
      for (const auto& [column, values] : *rows) {
        const std::string word(column.str());
        if (word == "t") read.value(values, key + ".t", given.times);
        else if (word == "value") read.value(values, key + ".value", given.values);
        else if (word == "hold") read.value(values, key + ".hold", given.hold);
        else read.unknown_key(values, word, {"t", "value", "hold"});
      }
      out[field] = given;
    } else {
      read.wrong(entry, key, "a number, the name of a file, or {t = [...], value = [...]}");
    }
  }
}

}  // namespace hamel
