// Reads nodes of a TOML table into fields and gathers the mistakes, each with its place. Not installed, since it
// needs toml++.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>
#include <toml++/toml.h>

#include <hamel/framework/io/errors.hpp>

namespace hamel {

class TomlReader {
 public:
  explicit TomlReader(const std::string& origin) : origin_(origin) {}

  /// ConfigError with line and column when text is not TOML.
  toml::table parse(const std::string& text) const {
    try {
      return toml::parse(text);
    } catch (const toml::parse_error& error) {
      throw ConfigError({fmt::format("{}: {}", place(error.source().begin), error.description())});
    }
  }

  void text(const toml::node& node, const std::string& key, std::string& out) {
    if (auto value = node.value<std::string>()) out = *value;
    else wrong(node, key, "a string");
  }
  void number(const toml::node& node, const std::string& key, double& out) {
    if (auto value = node.value<double>()) out = *value;
    else wrong(node, key, "a number");
  }
  template <class Integer>
  void whole(const toml::node& node, const std::string& key, Integer& out) {
    if (auto value = node.value<Integer>(); value && node.is_integer()) out = *value;
    else wrong(node, key, "a whole number");
  }
  void list(const toml::node& node, const std::string& key, std::vector<double>& out) {
    out.clear();
    if (const toml::array* array = node.as_array()) {
      for (const toml::node& entry : *array) {
        if (auto value = entry.value<double>()) out.push_back(*value);
        else wrong(entry, key, "a list of numbers");
      }
    } else if (auto value = node.value<double>()) {
      out.push_back(*value);
    } else {
      wrong(node, key, "a number or a list of numbers");
    }
  }
  void wrong(const toml::node& node, const std::string& key, const std::string& expected) {
    mistakes.push_back(fmt::format("{}: {}: expected {}", place(node), key, expected));
  }
  void unknown_key(const toml::node& node, const std::string& key,
                   const std::vector<std::string>& known) {
    unknown(node, "key", key, known);
  }

  void unknown(const toml::node& node, const std::string& kind, const std::string& name,
               const std::vector<std::string>& known) {
    mistakes.push_back(fmt::format("{}: {}", place(node), unknown_name(kind, name, known)));
  }

  /// "file:line:column".
  std::string place(const toml::node& node) const { return place(node.source().begin); }
  std::string place(const toml::source_position& at) const {
    return fmt::format("{}:{}:{}", origin_, at.line, at.column);
  }

  std::vector<std::string> mistakes;

 private:
  std::string origin_;
};

}  // namespace hamel
