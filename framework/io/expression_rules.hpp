// The functions and operators of a formula, each with its derivatives. Not installed.
//
// A value is one formula, over double and over recorded numbers (framework/graph).
#pragma once

#include <algorithm>
#include <cmath>

#include <muParser.h>

#include <hamel/framework/graph/number.hpp>
#include <hamel/framework/io/expression.hpp>

namespace hamel {

struct Expression::Rule {
  using Function = double (*)(double x, double y);
  using Recorded = graph::Number (*)(graph::Number x, graph::Number y);
  const char* name;
  int arguments;
  Function value;
  Recorded recorded;
  Function by_first, by_second;

  /// of: a function of two numbers of either kind.
  template <class Of>
  constexpr Rule(const char* its_name, int its_arguments, Of of, Function first, Function second)
      : name(its_name),
        arguments(its_arguments),
        value(of),
        recorded(of),
        by_first(first),
        by_second(second) {}
};

namespace rules {

using Rule = Expression::Rule;
inline constexpr Rule::Function kNone = [](double, double) { return 0.0; };
inline constexpr Rule::Function kOne = [](double, double) { return 1.0; };

inline double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }
inline double one_if(bool c) { return c ? 1 : 0; }
inline graph::Number one_if(const graph::Condition& c) { return graph::select(c, 1, 0); }
// Found for doubles beside those of recorded numbers.
using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::cosh, std::exp,
    std::log, std::max, std::min, std::pow, std::rint, std::sin, std::sinh, std::sqrt, std::tan,
    std::tanh;

// Functions, by name.
inline constexpr Rule kFunctions[] = {
    {"sin", 1, [](auto x, auto) { return sin(x); }, [](double x, double) { return std::cos(x); },
     kNone},
    {"cos", 1, [](auto x, auto) { return cos(x); }, [](double x, double) { return -std::sin(x); },
     kNone},
    {"tan", 1, [](auto x, auto) { return tan(x); },
     [](double x, double) { return 1 / (std::cos(x) * std::cos(x)); }, kNone},
    {"asin", 1, [](auto x, auto) { return asin(x); },
     [](double x, double) { return 1 / std::sqrt(1 - x * x); }, kNone},
    {"acos", 1, [](auto x, auto) { return acos(x); },
     [](double x, double) { return -1 / std::sqrt(1 - x * x); }, kNone},
    {"atan", 1, [](auto x, auto) { return atan(x); },
     [](double x, double) { return 1 / (1 + x * x); }, kNone},
    {"sinh", 1, [](auto x, auto) { return sinh(x); }, [](double x, double) { return std::cosh(x); },
     kNone},
    {"cosh", 1, [](auto x, auto) { return cosh(x); }, [](double x, double) { return std::sinh(x); },
     kNone},
    {"tanh", 1, [](auto x, auto) { return tanh(x); },
     [](double x, double) { return 1 / (std::cosh(x) * std::cosh(x)); }, kNone},
    {"exp", 1, [](auto x, auto) { return exp(x); }, [](double x, double) { return std::exp(x); },
     kNone},
    {"ln", 1, [](auto x, auto) { return log(x); }, [](double x, double) { return 1 / x; }, kNone},
    {"sqrt", 1, [](auto x, auto) { return sqrt(x); },
     [](double x, double) { return 0.5 / std::sqrt(x); }, kNone},
    {"abs", 1, [](auto x, auto) { return abs(x); }, [](double x, double) { return sign(x); },
     kNone},
    {"sign", 1, [](auto x, auto) { return one_if(x > 0) - one_if(x < 0); }, kNone, kNone},
    {"rint", 1, [](auto x, auto) { return rint(x); }, kNone, kNone},
    {"atan2", 2, [](auto y, auto x) { return atan2(y, x); },
     [](double y, double x) { return x / (x * x + y * y); },
     [](double y, double x) { return -y / (x * x + y * y); }},
    {"min", 2, [](auto x, auto y) { return min(x, y); },
     [](double x, double y) { return double(x <= y); },
     [](double x, double y) { return double(x > y); }},
    {"max", 2, [](auto x, auto y) { return max(x, y); },
     [](double x, double y) { return double(x >= y); },
     [](double x, double y) { return double(x < y); }},
};

// Operators, by muParser's codes.
struct Operator {
  mu::ECmdCode code;
  Rule rule;
};
inline constexpr Operator kOperators[] = {
    {mu::cmADD, {"+", 2, [](auto x, auto y) { return x + y; }, kOne, kOne}},
    {mu::cmSUB,
     {"-", 2, [](auto x, auto y) { return x - y; }, kOne, [](double, double) { return -1.0; }}},
    {mu::cmMUL,
     {"*", 2, [](auto x, auto y) { return x * y; }, [](double, double y) { return y; },
      [](double x, double) { return x; }}},
    {mu::cmDIV,
     {"/", 2, [](auto x, auto y) { return x / y; }, [](double, double y) { return 1 / y; },
      [](double x, double y) { return -x / (y * y); }}},
    {mu::cmPOW,
     {"^", 2, [](auto x, auto y) { return pow(x, y); },
      [](double x, double y) { return y == 0 ? 0 : y * std::pow(x, y - 1); },
      [](double x, double y) { return x == 0 ? 0 : std::pow(x, y) * std::log(x); }}},
    {mu::cmLT, {"<", 2, [](auto x, auto y) { return one_if(x < y); }, kNone, kNone}},
    {mu::cmGT, {">", 2, [](auto x, auto y) { return one_if(x > y); }, kNone, kNone}},
    {mu::cmLE, {"<=", 2, [](auto x, auto y) { return one_if(x <= y); }, kNone, kNone}},
    {mu::cmGE, {">=", 2, [](auto x, auto y) { return one_if(x >= y); }, kNone, kNone}},
    {mu::cmEQ, {"==", 2, [](auto x, auto y) { return one_if(x == y); }, kNone, kNone}},
    {mu::cmNEQ, {"!=", 2, [](auto x, auto y) { return one_if(x != y); }, kNone, kNone}},
    {mu::cmLAND, {"&&", 2, [](auto x, auto y) { return one_if(x != 0 && y != 0); }, kNone, kNone}},
    {mu::cmLOR, {"||", 2, [](auto x, auto y) { return one_if(x != 0 || y != 0); }, kNone, kNone}},
};
inline constexpr Rule kSquare = {"^2", 1, [](auto x, auto) { return x * x; },
                                 [](double x, double) { return 2 * x; }, kNone};
inline constexpr Rule kMinus = {"-", 1, [](auto x, auto) { return -x; },
                                [](double, double) { return -1.0; }, kNone};

inline const Rule* rule_of(mu::ECmdCode code) {
  for (const Operator& o : kOperators) {
    if (o.code == code) return &o.rule;
  }
  return nullptr;
}

}  // namespace rules
}  // namespace hamel
