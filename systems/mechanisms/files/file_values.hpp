// Values in the file of a mechanism: numbers, points, and formulas of parameters, time and state.
// Not installed.
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
  /// Takes the value of a key.
  using Reader = std::function<void(const Node&, const std::string& key)>;
  using Keys = std::vector<std::pair<std::string, Reader>>;

  explicit FileValues(const std::string& origin) : toml(origin) {}

  /// Sets the names that signals may use beside t and parameters.
  void set_names(const std::vector<std::string>& coordinates, const std::vector<std::string>& rates,
                 const std::vector<InputField>& inputs) {
    names_ = {"t"};
    first_rate_ = 1 + coordinates.size();
    rates_ = rates.size();
    names_.insert(names_.end(), coordinates.begin(), coordinates.end());
    names_.insert(names_.end(), rates.begin(), rates.end());
    for (size_t i = 0; i < inputs.size(); ++i) {  // the rate of a prescribed joint is there already
      if (std::find(names_.begin(), names_.end(), inputs[i].name) != names_.end()) continue;
      names_.push_back(inputs[i].name);
      inputs_.push_back(i);
    }
  }

  /// Is this the name of t, or of a coordinate, velocity or input?
  bool names(const std::string& name) const {
    return std::find(names_.begin(), names_.end(), name) != names_.end();
  }
  /// Is this name that of an input, and of nothing else of the state?
  bool names_input(const std::string& name) const {
    const auto at = std::find(names_.begin(), names_.end(), name);
    return at >= names_.end() - static_cast<std::ptrdiff_t>(inputs_.size()) && at != names_.end();
  }

  double number(const Node& node, const std::string& key) { return formulas.number(node, key); }
  Point point(const Node& node, const std::string& key) {
    const auto values = formulas.numbers(node, key, 3);
    return {values[0], values[1], values[2]};
  }
  /// A formula of t, coordinates, velocities, inputs and parameters; time_dependent becomes true
  /// where it depends on t.
  Signal signal(const Node& node, const std::string& key, bool& time_dependent) {
    const auto formula = formulas.expression(node, key, names_);
    if (!formula) return {};
    for (const size_t i : formula->used()) time_dependent |= i == 0;
    if (formula->may_jump()) note_jump(node, key, *formula);
    return [formula = *formula, inputs = inputs_,
            values = std::vector<double>(names_.size())](const SignalInput& now) mutable {
      values[0] = now.t;
      auto next = std::copy(now.coordinates.begin(), now.coordinates.end(), values.begin() + 1);
      next = std::copy(now.velocity.begin(), now.velocity.end(), next);
      for (const size_t i : inputs) *next++ = i < now.inputs.size() ? now.inputs[i] : 0;
      return formula(values);
    };
  }
  /// The text of a formula of t, coordinates, velocities and parameters; empty where it is a
  /// mistake.
  std::string formula(const Node& node, const std::string& key) {
    std::vector<std::string> names(names_.begin(), names_.end() - std::ssize(inputs_));
    const bool read = formulas.expression(node, key, names).has_value();
    return read ? formulas.text(node) : "";
  }
  /// A formula of t and parameters; empty where it is a mistake.
  struct OfTime {
    std::function<double(double)> value, slope;
    bool constant = false;  // the rate, which is the slope of an angle
  };
  OfTime time_dependent(const Node& node, const std::string& key) {
    const auto any = formulas.expression(node, key, names_);
    if (!any) return {};
    for (const size_t i : any->used()) {
      if (i == 0) continue;
      toml.wrong(node, key,
                 fmt::format("a formula of t and parameters, since its rate is needed too; '{}' is "
                             "none of them",
                             names_[i]));
      return {};
    }
    const auto formula = formulas.expression(node, key, {"t"});
    if (key == "angle" && formula->may_jump()) {
      toml.wrong(node, key,
                 "a formula without comparisons, a ? b : c, sign and rint, since its rate contains "
                 "nothing of a jump; prescribe the rate instead");
      return {};
    }
    const OfTime out = {[formula = *formula](double t) {
                          return formula({&t, 1});
                        },
                        [formula = *formula](double t) {
                          double slope = 0;
                          formula.differentiate({&t, 1}, 1, {&slope, 1});
                          return slope;
                        },
                        key == "angle" ? formula->linear() : formula->constant()};
    const auto finite = [&](double first, const char* what) {
      if (!std::isfinite(first))
        toml.wrong(node, key, fmt::format("{} finite at t = 0, got {}", what, first));
      return std::isfinite(first);
    };
    if (finite(out.value(0), key == "angle" ? "an angle" : "a rate") && key == "angle")
      finite(out.slope(0), "an angle whose rate is");
    return out;
  }

  Reader read(double& to) {
    return [this, &to](const Node& node, const std::string& key) { to = number(node, key); };
  }
  Reader read(std::optional<double>& to) {
    return [this, &to](const Node& node, const std::string& key) { to = number(node, key); };
  }
  Reader read(std::optional<bool>& to) {
    return [this, &to](const Node& node, const std::string& key) {
      toml.value(node, key, to.emplace());
    };
  }
  Reader read(std::vector<double>& to) {
    return
        [this, &to](const Node& node, const std::string& key) { to = formulas.numbers(node, key); };
  }
  Reader read(Point& to) {
    return [this, &to](const Node& node, const std::string& key) { to = point(node, key); };
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
  std::vector<std::string> notes;

 private:
  /// A note where a formula jumps as a velocity changes its sign, tried at scattered values.
  void note_jump(const Node& node, const std::string& key, const Expression& formula) {
    std::vector<double> at(names_.size());
    for (size_t i = 0; i < at.size(); ++i) at[i] = std::sin(12.9898 * (static_cast<double>(i) + 1));
    for (const size_t i : formula.used()) {
      if (i < first_rate_ || i >= first_rate_ + rates_) continue;
      const auto beside = [&](double rate) {
        std::vector<double> values = at;
        values[i] = rate;
        return formula(values);
      };
      const double before = beside(-1e-9), after = beside(1e-9);
      if (!(std::abs(after - before) > 1e-6 * (std::abs(after) + std::abs(before)))) continue;
      notes.push_back(
          fmt::format("{}: {}: jumps where {} changes its sign: steps shrink there without end; "
                      "dry friction is "
                      "`friction` of a joint or contact",
                      toml.place(node), key, names_[i]));
    }
  }

  size_t first_rate_ = 0, rates_ = 0;
  std::vector<std::string> names_;
  std::vector<size_t> inputs_;  // of those of the system, that names_ ends with
};

}  // namespace hamel::mechanisms
