// Values in the file of a mechanism: numbers, points, and formulas of parameters, time and state. Not installed.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/io/toml_reader.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>

namespace hamel::mechanisms {

class FileValues {
 public:
  using Node = toml::node;
  /// What to do with the value of a key.
  using Reader = std::function<void(const Node&, const std::string& key)>;
  using Keys = std::vector<std::pair<std::string, Reader>>;

  explicit FileValues(const std::string& origin) : toml(origin) {}

  /// The values that stand in formulas from now on.
  void set_parameters(std::vector<std::string> names, std::vector<double> values) {
    names_ = std::move(names);
    values_ = std::move(values);
  }
  /// Coordinates and velocities, for signals.
  void set_state(std::vector<std::string> names) { state_ = std::move(names); }

  double number(const Node& node, const std::string& key) {
    double out = 0;
    if (node.is_number()) out = *node.value<double>();
    else if (const auto formula = compile(node, key, names_)) out = (*formula)(values_);
    if (!std::isfinite(out)) toml.wrong(node, key, fmt::format("a finite number, got {}", out));
    return out;
  }
  std::vector<double> numbers(const Node& node, const std::string& key) {
    std::vector<double> out;
    if (const toml::array* array = node.as_array()) {
      for (const Node& entry : *array) out.push_back(number(entry, key));
    } else {
      toml.wrong(node, key, "a list of numbers");
    }
    return out;
  }
  Point point(const Node& node, const std::string& key) {
    const auto values = numbers(node, key);
    if (values.size() == 3) return {values[0], values[1], values[2]};
    if (node.is_array()) toml.wrong(node, key, fmt::format("3 numbers, got {}", values.size()));
    return {0, 0, 0};
  }
  /// A formula of t, coordinates, velocities and parameters.
  Signal signal(const Node& node, const std::string& key) {
    if (node.is_number()) return [x = number(node, key)](const Now&) { return x; };
    const auto formula = compile(node, key, with_time(state_));
    if (!formula) return {};
    return [formula = *formula, values = room(state_.size())](const Now& now) mutable {
      values[0] = now.t;
      const auto next =
          std::copy(now.coordinates.begin(), now.coordinates.end(), values.begin() + 1);
      std::copy(now.velocity.begin(), now.velocity.end(), next);
      return formula(values);
    };
  }
  /// A formula of t and parameters, or its derivative.
  std::function<double(double)> of_time(const Node& node, const std::string& key, bool derivative) {
    if (node.is_number()) return [x = derivative ? 0 : number(node, key)](double) { return x; };
    const auto formula = compile(node, key, with_time({}));
    if (!formula) return {};
    return [formula = *formula, values = room(0), slopes = room(0), derivative](double t) mutable {
      values[0] = t;
      slopes[0] = 0;
      const double value = formula.differentiate(values, 1, slopes);
      return derivative ? slopes[0] : value;
    };
  }

  Reader read(double& to) {
    return [this, &to](const Node& node, const std::string& key) { to = number(node, key); };
  }
  Reader read(std::optional<double>& to) {
    return [this, &to](const Node& node, const std::string& key) { to = number(node, key); };
  }
  Reader read(std::vector<double>& to) {
    return [this, &to](const Node& node, const std::string& key) { to = numbers(node, key); };
  }
  Reader read(Point& to) {
    return [this, &to](const Node& node, const std::string& key) { to = point(node, key); };
  }
  Reader read(Signal& to) {
    return [this, &to](const Node& node, const std::string& key) { to = signal(node, key); };
  }
  template <class Text>
  Reader read(Text& to) {  // string, bool, list of strings
    return [this, &to](const Node& node, const std::string& key) { toml.value(node, key, to); };
  }
  /// All keys of a table; others are mistakes.
  void entries(const toml::table& table, const Keys& keys) {
    for (const auto& [name, node] : table) {
      const std::string key(name.str());
      const auto it =
          std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return k.first == key; });
      if (it != keys.end()) {
        it->second(node, key);
        continue;
      }
      std::vector<std::string> known;
      for (const auto& [word, reader] : keys) known.push_back(word);
      toml.unknown_key(node, key, known);
    }
  }

  TomlReader toml;

 private:
  std::optional<Expression> compile(const Node& node, const std::string& key,
                                    const std::vector<std::string>& names) {
    const auto text = node.value<std::string>();
    if (!text) {
      toml.wrong(node, key, "a number or a formula");
      return {};
    }
    try {
      return Expression(*text, names);
    } catch (const ExpressionError& error) {
      toml::source_position at = node.source().begin;
      at.column += static_cast<toml::source_index>(1 + error.position());
      toml.mistakes.push_back(fmt::format("{}: {}: {}", toml.place(at), key, error.what()));
      return {};
    }
  }
  // t, the state, the parameters.
  std::vector<std::string> with_time(const std::vector<std::string>& state) const {
    std::vector<std::string> names{"t"};
    names.insert(names.end(), state.begin(), state.end());
    names.insert(names.end(), names_.begin(), names_.end());
    return names;
  }
  std::vector<double> room(size_t state) const {
    std::vector<double> values(1 + state, 0.0);
    values.insert(values.end(), values_.begin(), values_.end());
    return values;
  }

  std::vector<std::string> names_, state_;
  std::vector<double> values_;
};

}  // namespace hamel::mechanisms
