// Numbers given as a formula in a file: "m*g*sin(slope)", over named variables and constants.
//
// The language is muParser's: + - * / ^, comparisons, && ||, a ? b : c, the functions of
// expression_rules.hpp, and pi. Names may have dots (steer.angle) and end in ' (theta'). muParser
// reads the text; what it read is kept as a list of instructions, which is evaluated, and
// differentiated exactly: by all variables backwards, along one direction forwards.
#pragma once

#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace hamel {

namespace graph {
class Number;
}

constexpr size_t kMostCharacters = 2000;  // of a formula

/// Error of a formula: its message, and behind how many of its characters.
class ExpressionError : public std::invalid_argument {
 public:
  ExpressionError(const std::string& what, size_t position)
      : std::invalid_argument(what), position_(position) {}
  size_t position() const { return position_; }

 private:
  size_t position_;
};

/// Formula of named variables. An object serves one thread at a time. Evaluation takes no memory.
class Expression {
 public:
  /// A formula over these variables; those with a name that is not allowed are left out.
  /// Throws ExpressionError, with the nearest name for one that is unknown.
  Expression(const std::string& text, const std::vector<std::string>& variables,
             const std::map<std::string, double>& constants = {});
  /// Its value; values in the order of the variables.
  double operator()(std::span<const double> values) const;
  /// Adds factor times its derivatives by the variables to out; its value.
  double differentiate(std::span<const double> values, double factor, std::span<double> out) const;
  /// Its rate of change where the variables change at these rates.
  double rate(std::span<const double> values, std::span<const double> rates) const;
  /// The formula of these variables as a node of the thread's graph::Recording, whose values and
  /// derivatives are those of this object up to round-off.
  graph::Number record(std::span<const graph::Number> variables) const;
  /// The variables that occur in it, by index.
  std::vector<size_t> used() const;
  bool constant() const { return inputs_.empty(); }
  /// How it depends on its variables from `first` on, of so many: linearly, linearly but for a term
  /// without them, or neither; tried at scattered values of all.
  enum class Dependence { linear, affine, nonlinear };
  Dependence dependence(size_t first, size_t count) const;
  /// Are its derivatives constant, as its form shows?
  bool linear() const;
  /// Does a comparison, a ? b : c, sign or rint of variables occur in it?
  bool may_jump() const;

  /// May a variable or constant have this name?
  static bool allows(const std::string& name);
  /// The names of its functions.
  static std::vector<std::string> functions();

  struct Rule;  // of an operator or a function: value and slopes

 private:
  enum class Op { add, subtract, multiply, square, rule, choose };
  // slots[to] = rule(slots[a], slots[b]), of the commonest rules without a call; choose: slots[a] ?
  // slots[b] : slots[c].
  struct Instruction {
    Op op;
    const Rule* rule;
    size_t a, b, c, to;
  };
  class Reader;
  double value_of(const Instruction& i) const;
  void pass_slope(const Instruction& i) const;  // its slope to what it was made of
  double rate_of(const Instruction& i) const;   // from the rates of what it was made of

  std::vector<std::pair<size_t, size_t>> inputs_;  // slot, variable
  std::vector<Instruction> instructions_;
  size_t result_ = 0;
  mutable std::vector<double> slots_, slopes_;  // slopes_: rates, on request
  std::vector<bool> fixed_;                     // slots that hold a constant
};

}  // namespace hamel
