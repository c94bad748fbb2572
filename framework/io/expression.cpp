#include <hamel/framework/io/expression.hpp>

#include <algorithm>
#include <cmath>

#include <hamel/framework/io/expression_rules.hpp>

namespace hamel {

using namespace rules;

double Expression::operator()(std::span<const double> values) const {
  for (const auto& [slot, variable] : inputs_) slots_[slot] = values[variable];
  for (const Instruction& i : instructions_) slots_[i.to] = value_of(i);
  return slots_[result_];
}

double Expression::value_of(const Instruction& i) const {
  const double x = slots_[i.a], y = slots_[i.b];
  switch (i.op) {
    case Op::add: return x + y;
    case Op::subtract: return x - y;
    case Op::multiply: return x * y;
    case Op::square: return x * x;
    case Op::rule: return i.rule->value(x, y);
    case Op::choose: return x != 0 ? y : slots_[i.c];
  }
  return 0;
}

void Expression::pass_slope(const Instruction& i) const {
  const double x = slots_[i.a], y = slots_[i.b], slope = slopes_[i.to];
  double &by_first = slopes_[i.a], &by_second = slopes_[i.b];
  switch (i.op) {
    case Op::add: by_first += slope, by_second += slope; return;
    case Op::subtract: by_first += slope, by_second -= slope; return;
    case Op::multiply: by_first += slope * y, by_second += slope * x; return;
    case Op::square: by_first += 2 * slope * x; return;
    case Op::choose: (x != 0 ? by_second : slopes_[i.c]) += slope; return;
    case Op::rule: break;
  }
  if (!fixed_[i.a]) by_first += slope * i.rule->by_first(x, y);
  if (i.rule->arguments == 2 && !fixed_[i.b]) by_second += slope * i.rule->by_second(x, y);
}

double Expression::differentiate(std::span<const double> values, double factor,
                                 std::span<double> out) const {
  const double value = (*this)(values);
  std::fill(slopes_.begin(), slopes_.end(), 0.0);
  slopes_[result_] = factor;
  for (size_t k = instructions_.size(); k-- > 0;) {
    if (slopes_[instructions_[k].to] != 0) pass_slope(instructions_[k]);
  }
  for (const auto& [slot, variable] : inputs_) out[variable] += slopes_[slot];
  return value;
}

double Expression::rate_of(const Instruction& i) const {
  const double x = slots_[i.a], y = slots_[i.b], of_x = slopes_[i.a], of_y = slopes_[i.b];
  switch (i.op) {
    case Op::add: return of_x + of_y;
    case Op::subtract: return of_x - of_y;
    case Op::multiply: return of_x * y + x * of_y;
    case Op::square: return 2 * x * of_x;
    case Op::choose: return x != 0 ? of_y : slopes_[i.c];
    case Op::rule: break;
  }
  // No slope of a constant argument, which may be infinite there.
  const double by_first = of_x == 0 ? 0 : of_x * i.rule->by_first(x, y);
  return i.rule->arguments == 1 || of_y == 0 ? by_first : by_first + of_y * i.rule->by_second(x, y);
}

double Expression::rate(std::span<const double> values, std::span<const double> rates) const {
  std::fill(slopes_.begin(), slopes_.end(), 0.0);
  for (const auto& [slot, variable] : inputs_) {
    slots_[slot] = values[variable];
    slopes_[slot] = rates[variable];
  }
  for (const Instruction& i : instructions_) {
    slots_[i.to] = value_of(i);
    slopes_[i.to] = rate_of(i);
  }
  return slopes_[result_];
}

std::vector<size_t> Expression::used() const {
  std::vector<size_t> out;
  for (const auto& [slot, variable] : inputs_) out.push_back(variable);
  return out;
}

bool Expression::linear() const {
  std::vector<int> degrees(slots_.size(), 0);  // 2: any that is not 0 or 1
  for (const auto& [slot, variable] : inputs_) degrees[slot] = 1;
  for (const Instruction& i : instructions_) {
    const int a = degrees[i.a], b = degrees[i.b];
    const bool divides = i.rule == rule_of(mu::cmDIV);
    int degree = 2;
    if (i.op == Op::add || i.op == Op::subtract || i.rule == &kMinus) degree = std::max(a, b);
    else if (i.op == Op::multiply || (divides && b == 0)) degree = a + b;
    degrees[i.to] = std::min(degree, 2);
  }
  return degrees[result_] < 2;
}

bool Expression::may_jump() const {
  return std::ranges::any_of(instructions_, [](const Instruction& i) {
    return i.op == Op::choose || (i.rule->by_first == kNone && i.rule->by_second == kNone);
  });
}

Expression::Dependence Expression::dependence(size_t first, size_t count) const {
  Dependence out = Dependence::linear;
  for (int seed = 1; seed <= 3; ++seed) {
    std::vector<double> at(count), slopes(count, 0.0);
    for (size_t i = 0; i < count; ++i)
      at[i] = std::sin(12.9898 * (static_cast<double>(i) + 1) + 78.233 * seed);
    const auto along = [&](double factor) {
      std::vector<double> values = at;
      for (size_t i = first; i < count; ++i) values[i] *= factor;
      return (*this)(values);
    };
    const double none = along(0), one = along(1) - none, three = along(3) - none;
    if (!std::isfinite(none + one + three)) continue;
    if (none != 0) out = Dependence::affine;
    differentiate(at, 1, slopes);
    double linear = 0, size = std::abs(one) + std::abs(none);
    for (size_t i = first; i < count; ++i) {
      linear += slopes[i] * at[i];
      size += std::abs(slopes[i] * at[i]);
    }
    if (std::abs(one - linear) > 1e-12 * size || std::abs(three - 3 * one) > 1e-12 * size)
      return Dependence::nonlinear;
  }
  return out;
}

}  // namespace hamel
