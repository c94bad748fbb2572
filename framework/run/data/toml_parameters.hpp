// [parameters] and [inputs] of a file that describes a system. Not installed.
//
//   [parameters]
//   mass = 2                                                        a number
//   slope = { value = 0.1, unit = "rad", meaning = "...", least = 0, most = 1 }
//   [inputs]
//   torque = { unit = "N m", meaning = "...", least = -5, most = 5 }
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <hamel/framework/io/toml_formulas.hpp>
#include <hamel/framework/mechanics/fields.hpp>
#include <hamel/framework/mechanics/inputs.hpp>

namespace hamel {

inline const std::vector<std::string>& parameter_keys() {
  static const std::vector<std::string> all = {"value", "unit", "meaning", "least", "most"};
  return all;
}

namespace detail {

// The keys of one parameter or input; value: null for an input.
inline void read_stated(TomlReader& read, const toml::node& node, const std::string& key,
                        double* value, std::string& unit, std::string& meaning, Range& range) {
  const toml::table* table = node.as_table();
  if (value != nullptr && table == nullptr) return read.value(node, key, *value);
  if (table == nullptr)
    return read.wrong(node, key, "a table, { unit = ..., meaning = ..., least = ..., most = ... }");
  if (value != nullptr && !table->contains("value"))
    read.wrong(node, key, "a number, or { value = ..., unit = ..., meaning = ... }");
  for (const auto& [name, entry] : *table) {
    const std::string word(name.str()), place = key + "." + word;
    if (word == "value" && value != nullptr) read.value(entry, place, *value);
    else if (word == "unit") read.value(entry, place, unit);
    else if (word == "meaning") read.value(entry, place, meaning);
    else if (word == "least") read.value(entry, place, range.least);
    else if (word == "most") read.value(entry, place, range.most);
    else
      read.unknown_key(entry, word,
                       {parameter_keys().begin() + (value == nullptr), parameter_keys().end()});
  }
  if (!(range.least <= range.most))
    read.wrong(node, key, fmt::format("least below most, got {} and {}", range.least, range.most));
}

// visit(name, node, key) for the entries of a table of the file, where it has it.
template <class Visit>
void each_stated(TomlReader& read, const toml::table& file, const std::string& key, Visit&& visit) {
  const toml::node* node = file.get(key);
  if (node == nullptr) return;
  const toml::table* table = node->as_table();
  if (table == nullptr) return read.wrong(*node, key, "a table");
  for (const auto& [name, entry] : *table) {
    const std::string word(name.str());
    if (!Expression::allows(word))
      read.wrong(entry, key, fmt::format("a name allowed in a formula, got '{}'", word));
    else visit(word, entry, key + "." + word);
  }
}

}  // namespace detail

/// The parameters of a file with the values given, which its formulas may use from now on. Throws
/// ConfigError.
inline std::vector<Field> read_parameters(TomlReader& read, TomlFormulas& formulas,
                                          const toml::table& file, const std::string& system,
                                          const Parameters& given) {
  std::vector<Field> out;
  detail::each_stated(read, file, "parameters",
                      [&](const std::string& name, const toml::node& node, const std::string& key) {
                        Field field{name, {0}, "", "", {}};
                        detail::read_stated(read, node, key, &field.value[0], field.unit,
                                            field.meaning, field.range);
                        out.push_back(std::move(field));
                      });
  if (!read.mistakes.empty()) throw ConfigError(read.mistakes);
  detail::check_parameters(system, out, given);
  for (Field& field : out) {
    if (const auto it = given.find(field.name); it != given.end()) field.value = it->second;
    formulas.set(field.name, field.value[0]);
  }
  if (const auto wrong = out_of_range(system, out); !wrong.empty()) throw ConfigError(wrong);
  return out;
}

inline std::vector<InputField> read_input_fields(TomlReader& read, const toml::table& file) {
  std::vector<InputField> out;
  detail::each_stated(read, file, "inputs",
                      [&](const std::string& name, const toml::node& node, const std::string& key) {
                        InputField field{name, "", "", {}};
                        detail::read_stated(read, node, key, nullptr, field.unit, field.meaning,
                                            field.range);
                        out.push_back(std::move(field));
                      });
  if (out.size() > kMostInputs)
    read.wrong(*file.get("inputs"), "inputs", fmt::format("at most {}", kMostInputs));
  return out;
}

}  // namespace hamel
