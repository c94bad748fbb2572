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
#include <hamel/framework/io/let_names.hpp>
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
  const LetNames& lets() const { return lets_; }

  /// Names for parts of formulas, in every formula from now on: the table [let] of a file.
  void read_lets(const toml::table& file) {
    const Node* node = file.get("let");
    if (node == nullptr) return;
    const toml::table* table = node->as_table();
    if (table == nullptr) return toml_.wrong(*node, "let", "a table, name = \"formula\"");
    for (const auto& [key, entry] : *table) {
      const std::string name(key.str());
      if (!Expression::allows(name))
        toml_.wrong(entry, "let", fmt::format("a name allowed in a formula, got '{}'", name));
      else if (constants_.contains(name))
        toml_.wrong(entry, "let." + name, "a name that nothing else has");
      else if (entry.is_string() || entry.is_number()) lets_.set(name, written(entry));
      else toml_.wrong(entry, "let." + name, "a number or a formula");
    }
    for (const auto& let : lets_.texts()) {  // names are known where it stands
      const Node& entry = *table->get(let.first);
      parse(entry, "let." + let.first, [&] {
        const std::string whole = lets_.expand(let.second).text;
        return Expression(whole, LetNames::words(whole));
      });
    }
  }

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
    return parse(node, key, [&] { return Expression(text(node), variables, constants_); });
  }

  /// The formula of a node that is a number or a text, without names of [let].
  std::string text(const Node& node) const {
    const std::string out = lets_.empty() ? written(node) : lets_.expand(written(node)).text;
    return reader_ ? reader_(out) : out;
  }

 private:
  static std::string written(const Node& node) {
    return node.is_number() ? fmt::format("{}", *node.value<double>())
                            : node.value_or(std::string());
  }
  // Calls make(); its error becomes a mistake at its character.
  template <class Make>
  std::optional<Expression> parse(const Node& node, const std::string& key, const Make& make) {
    try {
      return make();
    } catch (const ExpressionError& error) {
      size_t position = error.position();
      std::string within;
      try {
        const LetNames::Expanded whole = lets_.expand(written(node));
        if (position < whole.origin.size()) {
          if (const std::string* let = whole.let[position])
            within = fmt::format(" (in let.{})", *let);
          position = whole.origin[position];
        }
      } catch (const ExpressionError&) {  // that is the error
      }
      toml::source_position at = node.source().begin;
      if (node.source().end.line == at.line)  // behind the quote
        at.column += static_cast<toml::source_index>(1 + position);
      toml_.mistakes.push_back(
          fmt::format("{}: {}: {}{}", toml_.place(at), key, error.what(), within));
      return {};
    }
  }

  TomlReader& toml_;
  Constants constants_;
  LetNames lets_;
  std::function<std::string(const std::string&)> reader_;
  int count_ = 0;
};

}  // namespace hamel
