// Formulas of files as nodes of a graph.
#include <optional>
#include <string_view>

#include <hamel/framework/graph/number.hpp>
#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/io/expression_rules.hpp>

namespace hamel {

namespace {

using graph::Condition, graph::Number;

// Comparisons that are conditions of what chooses by them, where their rule is 1 or 0.
struct RecordedComparison {
  std::string_view name;
  Condition (*value)(const Number& x, const Number& y);
};
constexpr RecordedComparison kRecordedComparisons[] = {
    {"<", [](const Number& x, const Number& y) { return x < y; }},
    {">", [](const Number& x, const Number& y) { return x > y; }},
    {"<=", [](const Number& x, const Number& y) { return x <= y; }},
    {">=", [](const Number& x, const Number& y) { return x >= y; }},
    {"==", [](const Number& x, const Number& y) { return x == y; }},
    {"!=", [](const Number& x, const Number& y) { return x != y; }},
};

// A value; of comparisons also the condition, of which it is 1 or 0.
struct RecordedValue {
  RecordedValue() = default;
  RecordedValue(const Number& x) : number(x) {}                                 // NOLINT: implicit
  RecordedValue(const Condition& c) : number(select(c, 1, 0)), condition(c) {}  // NOLINT: implicit
  Condition holds() const { return condition ? *condition : number != 0; }

  Number number;
  std::optional<Condition> condition;
};

RecordedValue value_of_rule(const Expression::Rule& rule, const RecordedValue& x,
                            const RecordedValue& y) {
  const std::string_view name = rule.name;
  if (name == "&&") return x.holds() && y.holds();
  if (name == "||") return x.holds() || y.holds();
  for (const RecordedComparison& c : kRecordedComparisons)
    if (c.name == name) return c.value(x.number, y.number);
  return rule.recorded(x.number, y.number);
}

}  // namespace

graph::Number Expression::record(std::span<const graph::Number> variables) const {
  std::vector<RecordedValue> slots;
  for (const double x : slots_) slots.emplace_back(Number(x));  // constants; others are overwritten
  for (const auto& [slot, variable] : inputs_) slots[slot] = variables[variable];
  for (const Instruction& i : instructions_) {
    const RecordedValue &x = slots[i.a], &y = slots[i.b];
    switch (i.op) {
      case Op::add: slots[i.to] = x.number + y.number; break;
      case Op::subtract: slots[i.to] = x.number - y.number; break;
      case Op::multiply: slots[i.to] = x.number * y.number; break;
      case Op::square: slots[i.to] = x.number * x.number; break;
      case Op::rule: slots[i.to] = value_of_rule(*i.rule, x, y); break;
      case Op::choose: slots[i.to] = select(x.holds(), y.number, slots[i.c].number); break;
    }
  }
  return slots[result_].number;
}

}  // namespace hamel
