// Reads nodes of a TOML table into fields and gathers the mistakes, each with its place. Not
// installed, since it needs toml++.
#pragma once

#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {

class TomlReader {
 public:
  explicit TomlReader(const std::string& origin);

  /// ConfigError with its place when text is not TOML, longer than kMaxText, or nested so deep that
  /// toml++ and its tables, which work by recursion, would run out of stack.
  toml::table parse(const std::string& text) const;

  /// The node as the type of `out`, else a mistake; one entry is a list too.
  void value(const toml::node& node, const std::string& key, std::string& out) {
    scalar(node, key, out, "a string");
  }
  void value(const toml::node& node, const std::string& key, double& out) {
    scalar(node, key, out, "a number");
  }
  void value(const toml::node& node, const std::string& key, std::optional<double>& out) {
    value(node, key, out.emplace());
  }
  void value(const toml::node& node, const std::string& key, bool& out) {
    scalar(node, key, out, "true or false", node.is_boolean());
  }
  template <std::integral Integer>
  void value(const toml::node& node, const std::string& key, Integer& out) {
    scalar(node, key, out, "a whole number", node.is_integer());
  }
  void value(const toml::node& node, const std::string& key, std::vector<double>& out) {
    entries(node, key, out, "numbers", "a number or a list of numbers");
  }
  void value(const toml::node& node, const std::string& key, std::vector<std::string>& out) {
    entries(node, key, out, "strings", "a string or a list of strings");
  }
  /// A table of lists of numbers.
  void lists(const toml::node& node, const std::string& key,
             std::map<std::string, std::vector<double>>& out) {
    const toml::table* table = node.as_table();
    if (table == nullptr) return wrong(node, key, "a table of parameters");
    for (const auto& [name, entry] : *table) {
      const std::string field(name.str());
      value(entry, key + "." + field, out[field]);
    }
  }
  void wrong(const toml::node& node, const std::string& key, const std::string& expected) {
    mistakes.push_back(fmt::format("{}: {}: expected {}", place(node), key, expected));
  }
  /// Mistake with the value of the node: "key: got 5, expected a string".
  void wrong_value(const toml::node& node, const std::string& key, const std::string& expected);
  void unknown_key(const toml::node& node, const std::string& key,
                   const std::vector<std::string>& known) {
    unknown(node, "key", key, known);
  }

  void unknown(const toml::node& node, const std::string& kind, const std::string& name,
               const std::vector<std::string>& known) {
    mistakes.push_back(fmt::format("{}: {}", place(node), unknown_name(kind, name, known)));
  }

  /// "file:line:column"; "file" of a text that was converted.
  std::string place(const toml::node& node) const { return place(node.source().begin); }
  std::string place(const toml::source_position& at) const;

  std::vector<std::string> mistakes;

 private:
  template <class T>
  void scalar(const toml::node& node, const std::string& key, T& out, const char* expected,
              bool fits = true) {
    if (const auto value = node.value<T>(); value && fits) out = *value;
    else wrong_value(node, key, expected);
  }
  template <class T>
  void entries(const toml::node& node, const std::string& key, std::vector<T>& out,
               const std::string& kind, const char* expected) {
    out.clear();
    if (const toml::array* array = node.as_array()) {
      for (const toml::node& entry : *array) {
        if (const auto value = entry.value<T>()) out.push_back(*value);
        else wrong_value(entry, key, "a list of " + kind);
      }
    } else if (const auto value = node.value<T>()) {
      out.push_back(*value);
    } else {
      wrong_value(node, key, expected);
    }
  }

  std::string origin_;
  bool converted_ = false;
};

/// Origin of a text that was made of another file, whose lines nobody has seen.
std::string converted_origin(const std::string& file);

/// A text as TOML has it, in double quotes.
std::string toml_string(const std::string& text);

}  // namespace hamel
