// Numbers of a TOML file, which may be formulas of its parameters, and formulas of more
// (expression.hpp). Mistakes have the place of the character. Not installed.
#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/io/toml_reader.hpp>

namespace hamel {

constexpr int kMostFormulas = 20000;  // of a file; a second to read

class TomlFormulas {
 public:
  using Node = toml::node;
  using Constants = std::map<std::string, double>;

  explicit TomlFormulas(TomlReader& toml) : toml_(toml) {}

  /// Names allowed in every formula from now on.
  void set(const std::string& name, double value) { constants_[name] = value; }
  const Constants& constants() const { return constants_; }

  /// Texts of formulas are read as this function returns them.
  void read_by(std::function<std::string(const std::string&)> reader) {
    reader_ = std::move(reader);
  }

  /// A finite number, or a formula of the constants.
  double number(const Node& node, const std::string& key) {
    double out = 0;
    if (node.is_number()) out = *node.value<double>();
    else if (const auto formula = expression(node, key, {})) out = (*formula)({});
    if (!std::isfinite(out)) toml_.wrong(node, key, fmt::format("a finite number, got {}", out));
    return std::isfinite(out) ? out : 0;
  }
  /// So many of them; any number of them where count < 0.
  std::vector<double> numbers(const Node& node, const std::string& key, long count = -1) {
    std::vector<double> out;
    const toml::array* array = node.as_array();
    if (array != nullptr) {
      for (const Node& entry : *array) out.push_back(number(entry, key));
    }
    if (array == nullptr || (count >= 0 && static_cast<long>(out.size()) != count)) {
      toml_.wrong(node, key, count < 0 ? "a list of numbers" : fmt::format("{} numbers", count));
      out.assign(static_cast<size_t>(std::max(0L, count)), 0.0);
    }
    return out;
  }
  /// A number or a text, as a formula of these variables and the constants.
  std::optional<Expression> expression(const Node& node, const std::string& key,
                                       const std::vector<std::string>& variables) {
    if (node.is_number() && !std::isfinite(*node.value<double>()))
      return toml_.wrong(node, key, "a finite number"), std::nullopt;
    if (!node.is_number() && !node.is_string())
      return toml_.wrong(node, key, "a number or a formula"), std::nullopt;
    if (++count_ > kMostFormulas)
      throw ConfigError(
          {fmt::format("{}: more than {} formulas", toml_.place(node), kMostFormulas)});
    try {
      return Expression(text(node), variables, constants_);
    } catch (const ExpressionError& error) {
      toml::source_position at = node.source().begin;
      if (node.source().end.line == at.line)  // behind the quote
        at.column += static_cast<toml::source_index>(1 + error.position());
      toml_.mistakes.push_back(fmt::format("{}: {}: {}", toml_.place(at), key, error.what()));
      return {};
    }
  }

  /// The formula of a node that is a number or a text.
  std::string text(const Node& node) const {
    const std::string out =
        node.is_number() ? fmt::format("{}", *node.value<double>()) : node.value_or(std::string());
    return reader_ ? reader_(out) : out;
  }

 private:
  TomlReader& toml_;
  Constants constants_;
  std::function<std::string(const std::string&)> reader_;
  int count_ = 0;
};

}  // namespace hamel
