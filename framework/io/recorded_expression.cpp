// Formulas of files as nodes of a graph.
#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>

#include <hamel/framework/graph/number.hpp>
#include <hamel/framework/io/expression.hpp>
#include <hamel/framework/io/expression_rules.hpp>

namespace hamel {

namespace {

using graph::Condition, graph::Number;

// Functions and operators with numbers as values; the name and count of arguments are those of the
// rule.
struct RecordedRule {
  std::string_view name;
  Number (*value)(const Number& x, const Number& y);
};
constexpr RecordedRule kRecordedRules[] = {
    {"sin", [](const Number& x, const Number&) { return sin(x); }},
    {"cos", [](const Number& x, const Number&) { return cos(x); }},
    {"tan", [](const Number& x, const Number&) { return tan(x); }},
    {"asin", [](const Number& x, const Number&) { return asin(x); }},
    {"acos", [](const Number& x, const Number&) { return acos(x); }},
    {"atan", [](const Number& x, const Number&) { return atan(x); }},
    {"sinh", [](const Number& x, const Number&) { return sinh(x); }},
    {"cosh", [](const Number& x, const Number&) { return cosh(x); }},
    {"tanh", [](const Number& x, const Number&) { return tanh(x); }},
    {"exp", [](const Number& x, const Number&) { return exp(x); }},
    {"ln", [](const Number& x, const Number&) { return log(x); }},
    {"sqrt", [](const Number& x, const Number&) { return sqrt(x); }},
    {"abs", [](const Number& x, const Number&) { return abs(x); }},
    {"sign", [](const Number& x, const Number&) { return select(x > 0, 1, select(x < 0, -1, 0)); }},
    {"rint", [](const Number& x, const Number&) { return rint(x); }},
    {"atan2", [](const Number& y, const Number& x) { return atan2(y, x); }},
    {"min", [](const Number& x, const Number& y) { return min(x, y); }},
    {"max", [](const Number& x, const Number& y) { return max(x, y); }},
    {"/", [](const Number& x, const Number& y) { return x / y; }},
    {"^", [](const Number& x, const Number& y) { return pow(x, y); }},
    {"-", [](const Number& x, const Number&) { return -x; }},  // of one argument
};

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

template <class Table>
auto* find_rule(const Table& table, std::string_view name) {
  const auto it = std::ranges::find(table, name, [](const auto& rule) { return rule.name; });
  return it == std::end(table) ? nullptr : &*it;
}

// A value; of comparisons also the condition, of which it is 1 or 0.
struct RecordedValue {
  RecordedValue() = default;
  RecordedValue(const Number& x) : number(x) {}                                 // NOLINT: implicit
  RecordedValue(const Condition& c) : number(select(c, 1, 0)), condition(c) {}  // NOLINT: implicit
  Condition holds() const { return condition ? *condition : number != 0; }

  Number number;
  std::optional<Condition> condition;
};

RecordedValue value_of_rule(std::string_view name, const RecordedValue& x, const RecordedValue& y) {
  if (name == "&&") return x.holds() && y.holds();
  if (name == "||") return x.holds() || y.holds();
  if (const RecordedComparison* c = find_rule(kRecordedComparisons, name))
    return c->value(x.number, y.number);
  return find_rule(kRecordedRules, name)->value(x.number, y.number);
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
      case Op::rule: slots[i.to] = value_of_rule(i.rule->name, x, y); break;
      case Op::choose: slots[i.to] = select(x.holds(), y.number, slots[i.c].number); break;
    }
  }
  return slots[result_].number;
}

}  // namespace hamel
