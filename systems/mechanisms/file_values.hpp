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

#include <hamel/framework/io/toml_formulas.hpp>
#include <hamel/systems/mechanisms/mechanism.hpp>

namespace hamel::mechanisms {

class FileValues {
 public:
  using Node = toml::node;
  /// What to do with the value of a key.
  using Reader = std::function<void(const Node&, const std::string& key)>;
  using Keys = std::vector<std::pair<std::string, Reader>>;

  explicit FileValues(const std::string& origin) : toml(origin) {}

  /// Coordinates and velocities, for signals.
  void set_state(std::vector<std::string> names) { state_ = std::move(names); }

  double number(const Node& node, const std::string& key) { return formulas.number(node, key); }
  Point point(const Node& node, const std::string& key) {
    const auto values = formulas.numbers(node, key, 3);
    return {values[0], values[1], values[2]};
  }
  /// A formula of t, coordinates, velocities and parameters.
  Signal signal(const Node& node, const std::string& key) {
    const auto formula = formulas.expression(node, key, with_time(state_));
    if (!formula) return {};
    return [formula = *formula,
            values = std::vector<double>(1 + state_.size())](const Now& now) mutable {
      values[0] = now.t;
      const auto next =
          std::copy(now.coordinates.begin(), now.coordinates.end(), values.begin() + 1);
      std::copy(now.velocity.begin(), now.velocity.end(), next);
      return formula(values);
    };
  }
  /// A formula of t and parameters, or its derivative.
  std::function<double(double)> of_time(const Node& node, const std::string& key, bool derivative) {
    const auto formula = formulas.expression(node, key, {"t"});
    if (!formula) return {};
    return [formula = *formula, derivative](double t) {
      double slope = 0;
      const double value = formula.differentiate({&t, 1}, 1, {&slope, 1});
      return derivative ? slope : value;
    };
  }

  Reader read(double& to) {
    return [this, &to](const Node& node, const std::string& key) { to = number(node, key); };
  }
  Reader read(std::optional<double>& to) {
    return [this, &to](const Node& node, const std::string& key) { to = number(node, key); };
  }
  Reader read(std::vector<double>& to) {
    return
        [this, &to](const Node& node, const std::string& key) { to = formulas.numbers(node, key); };
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
  TomlFormulas formulas{toml};

 private:
  std::vector<std::string> with_time(const std::vector<std::string>& state) const {
    std::vector<std::string> names{"t"};
    names.insert(names.end(), state.begin(), state.end());
    return names;
  }

  std::vector<std::string> state_;
};

}  // namespace hamel::mechanisms
