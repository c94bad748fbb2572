// [outputs] of a file that describes a system. Not installed.
//
//   [outputs]
//   slip = "front.vx - radius*spin"     # of any columns, parameters and other outputs
//   height = { value = "tip.z - 0.1", unit = "m", meaning = "of the tip over the table" }
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/toml_formulas.hpp>
#include <hamel/framework/mechanics/output_formulas.hpp>

namespace hamel {

/// Mistakes of names and formulas are found where the system is complete (output_mistakes).
inline std::vector<OutputFormula> read_outputs(TomlReader& read, TomlFormulas& formulas,
                                               const toml::table& file) {
  std::vector<OutputFormula> out;
  const toml::node* entries = file.get("outputs");
  if (entries == nullptr) return out;
  if (!entries->is_table()) return read.wrong(*entries, "outputs", "a table"), out;
  for (const auto& [name, node] : *entries->as_table()) {
    OutputFormula output{std::string(name.str()), "", "", "", read.place(node) + ": "};
    const std::string key = "outputs." + output.name;
    const toml::node* value = &node;
    if (const toml::table* table = node.as_table()) {
      value = table->get("value");
      for (const auto& [word, entry] : *table) {
        if (word == "meaning") read.value(entry, key + ".meaning", output.meaning);
        else if (word == "unit") read.value(entry, key + ".unit", output.unit);
        else if (word != "value")
          read.unknown_key(entry, std::string(word.str()), {"value", "unit", "meaning"});
      }
    }
    if (value == nullptr || !(value->is_string() || value->is_number())) {
      read.wrong(node, key, "a formula, or { value = ..., unit = ..., meaning = ... }");
      continue;
    }
    output.formula = formulas.text(*value);
    out.push_back(std::move(output));
  }
  return out;
}

}  // namespace hamel
