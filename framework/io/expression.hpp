// Numbers that stand as a formula in a file: "m*g*sin(slope)", over named values.
//
// The language is muParser's: + - * / ^, comparisons, a ? b : c, sin cos tan asin acos atan atan2 sinh cosh tanh exp ln
// sqrt abs sign rint min max, and pi. Names may have dots: steer.angle.
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace hamel {

/// What is wrong with a formula, and behind how many of its characters.
class ExpressionError : public std::invalid_argument {
 public:
  ExpressionError(const std::string& what, size_t position)
      : std::invalid_argument(what), position_(position) {}
  size_t position() const { return position_; }

 private:
  size_t position_;
};

/// One object serves one thread at a time; copies share it. Evaluation takes no memory.
class Expression {
 public:
  /// A formula over these names. Throws ExpressionError, with the nearest name for one that is unknown.
  Expression(const std::string& text, const std::vector<std::string>& names);
  /// Its value; values in the order of the names.
  double operator()(std::span<const double> values) const;
  /// The names that stand in it.
  const std::vector<std::string>& used() const;

 private:
  struct Compiled;
  std::shared_ptr<Compiled> compiled_;
};

}  // namespace hamel
