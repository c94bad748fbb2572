// The functions and operators of a formula, each with its derivatives. Not installed.
#pragma once

#include <algorithm>
#include <cmath>

#include <muParser.h>

#include <hamel/framework/io/expression.hpp>

namespace hamel {

struct Expression::Rule {
  using Function = double (*)(double x, double y);
  const char* name;
  int arguments;
  Function value, by_first, by_second;
};

namespace rules {

using Rule = Expression::Rule;
inline constexpr Rule::Function kNone = [](double, double) { return 0.0; };
inline constexpr Rule::Function kOne = [](double, double) { return 1.0; };

inline double sign(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

// Functions, by name.
inline constexpr Rule kFunctions[] = {
    {"sin", 1, [](double x, double) { return std::sin(x); },
     [](double x, double) { return std::cos(x); }, kNone},
    {"cos", 1, [](double x, double) { return std::cos(x); },
     [](double x, double) { return -std::sin(x); }, kNone},
    {"tan", 1, [](double x, double) { return std::tan(x); },
     [](double x, double) { return 1 / (std::cos(x) * std::cos(x)); }, kNone},
    {"asin", 1, [](double x, double) { return std::asin(x); },
     [](double x, double) { return 1 / std::sqrt(1 - x * x); }, kNone},
    {"acos", 1, [](double x, double) { return std::acos(x); },
     [](double x, double) { return -1 / std::sqrt(1 - x * x); }, kNone},
    {"atan", 1, [](double x, double) { return std::atan(x); },
     [](double x, double) { return 1 / (1 + x * x); }, kNone},
    {"sinh", 1, [](double x, double) { return std::sinh(x); },
     [](double x, double) { return std::cosh(x); }, kNone},
    {"cosh", 1, [](double x, double) { return std::cosh(x); },
     [](double x, double) { return std::sinh(x); }, kNone},
    {"tanh", 1, [](double x, double) { return std::tanh(x); },
     [](double x, double) { return 1 / (std::cosh(x) * std::cosh(x)); }, kNone},
    {"exp", 1, [](double x, double) { return std::exp(x); },
     [](double x, double) { return std::exp(x); }, kNone},
    {"ln", 1, [](double x, double) { return std::log(x); }, [](double x, double) { return 1 / x; },
     kNone},
    {"sqrt", 1, [](double x, double) { return std::sqrt(x); },
     [](double x, double) { return 0.5 / std::sqrt(x); }, kNone},
    {"abs", 1, [](double x, double) { return std::abs(x); },
     [](double x, double) { return sign(x); }, kNone},
    {"sign", 1, [](double x, double) { return sign(x); }, kNone, kNone},
    {"rint", 1, [](double x, double) { return std::rint(x); }, kNone, kNone},
    {"atan2", 2, [](double y, double x) { return std::atan2(y, x); },
     [](double y, double x) { return x / (x * x + y * y); },
     [](double y, double x) { return -y / (x * x + y * y); }},
    {"min", 2, [](double x, double y) { return std::min(x, y); },
     [](double x, double y) { return double(x <= y); },
     [](double x, double y) { return double(x > y); }},
    {"max", 2, [](double x, double y) { return std::max(x, y); },
     [](double x, double y) { return double(x >= y); },
     [](double x, double y) { return double(x < y); }},
};

// Operators, by muParser's codes.
struct Operator {
  mu::ECmdCode code;
  Rule rule;
};
inline constexpr Operator kOperators[] = {
    {mu::cmADD, {"+", 2, [](double x, double y) { return x + y; }, kOne, kOne}},
    {mu::cmSUB,
     {"-", 2, [](double x, double y) { return x - y; }, kOne, [](double, double) { return -1.0; }}},
    {mu::cmMUL,
     {"*", 2, [](double x, double y) { return x * y; }, [](double, double y) { return y; },
      [](double x, double) { return x; }}},
    {mu::cmDIV,
     {"/", 2, [](double x, double y) { return x / y; }, [](double, double y) { return 1 / y; },
      [](double x, double y) { return -x / (y * y); }}},
    {mu::cmPOW,
     {"^", 2, [](double x, double y) { return std::pow(x, y); },
      [](double x, double y) { return y == 0 ? 0 : y * std::pow(x, y - 1); },
      [](double x, double y) { return x == 0 ? 0 : std::pow(x, y) * std::log(x); }}},
    {mu::cmLT, {"<", 2, [](double x, double y) { return double(x < y); }, kNone, kNone}},
    {mu::cmGT, {">", 2, [](double x, double y) { return double(x > y); }, kNone, kNone}},
    {mu::cmLE, {"<=", 2, [](double x, double y) { return double(x <= y); }, kNone, kNone}},
    {mu::cmGE, {">=", 2, [](double x, double y) { return double(x >= y); }, kNone, kNone}},
    {mu::cmEQ, {"==", 2, [](double x, double y) { return double(x == y); }, kNone, kNone}},
    {mu::cmNEQ, {"!=", 2, [](double x, double y) { return double(x != y); }, kNone, kNone}},
    {mu::cmLAND,
     {"&&", 2, [](double x, double y) { return double(x != 0 && y != 0); }, kNone, kNone}},
    {mu::cmLOR,
     {"||", 2, [](double x, double y) { return double(x != 0 || y != 0); }, kNone, kNone}},
};
inline constexpr Rule kSquare = {"^2", 1, [](double x, double) { return x * x; },
                                 [](double x, double) { return 2 * x; }, kNone};
inline constexpr Rule kMinus = {"-", 1, [](double x, double) { return -x; },
                                [](double, double) { return -1.0; }, kNone};

inline const Rule* rule_of(mu::ECmdCode code) {
  for (const Operator& o : kOperators) {
    if (o.code == code) return &o.rule;
  }
  return nullptr;
}

}  // namespace rules
}  // namespace hamel
