#include <hamel/framework/graph/substitute.hpp>

#include <stdexcept>

namespace hamel::graph {
namespace {

Number repeated(Op op, const Number& a, const Number& b) {
  switch (op) {
    case Op::add: return a + b;
    case Op::subtract: return a - b;
    case Op::multiply: return a * b;
    case Op::divide: return a / b;
    case Op::min: return min(a, b);
    case Op::max: return max(a, b);
    case Op::negate: return -a;
    case Op::abs: return abs(a);
    case Op::sqrt: return sqrt(a);
    case Op::round: return rint(a);
    case Op::exp: return exp(a);
    case Op::log: return log(a);
    case Op::asin: return asin(a);
    case Op::acos: return acos(a);
    case Op::atan: return atan(a);
    case Op::sinh: return sinh(a);
    case Op::cosh: return cosh(a);
    case Op::tanh: return tanh(a);
    case Op::atan2: return atan2(a, b);
    case Op::pow: return pow(a, b);
    case Op::sin: return sin(a);
    case Op::cos: return cos(a);
    default: throw std::logic_error("graph::substituted: no operation of a recording");
  }
}

// Nodes so far, of which each is a number or a condition.
struct Repeated {
  std::vector<Number> numbers;
  std::vector<Condition> conditions;

  const Number& number(int node) const {
    static const Number none = 0;
    return node < 0 ? none : numbers[static_cast<size_t>(node)];
  }
  const Condition& condition(int node) const { return conditions[static_cast<size_t>(node)]; }
};

Condition repeated_condition(const Node& node, const Repeated& so_far) {
  switch (node.op) {
    case Op::less: return so_far.number(node.a) < so_far.number(node.b);
    case Op::less_equal: return so_far.number(node.a) <= so_far.number(node.b);
    case Op::equal: return so_far.number(node.a) == so_far.number(node.b);
    case Op::both: return so_far.condition(node.a) && so_far.condition(node.b);
    case Op::either: return so_far.condition(node.a) || so_far.condition(node.b);
    default: return !so_far.condition(node.a);
  }
}

}  // namespace

std::vector<Number> substituted(const Recording& from, const std::vector<Number>& values,
                                const std::vector<Number>& inputs) {
  if (inputs.size() != from.inputs().size())
    throw std::invalid_argument("graph::substituted: expected a number for each input");
  const size_t count = from.nodes().size();  // the current recording may be the same one
  Repeated so_far;
  for (size_t i = 0; i < count; ++i) {
    const Node node = from.nodes()[i];
    Number number = 0;
    Condition condition = false;
    if (node.op == Op::constant) number = node.value;
    else if (node.op == Op::input) number = inputs[static_cast<size_t>(node.a)];
    else if (node.op == Op::select)
      number = select(so_far.condition(node.a), so_far.number(node.b), so_far.number(node.c));
    else if (is_condition(node.op)) condition = repeated_condition(node, so_far);
    else number = repeated(node.op, so_far.number(node.a), so_far.number(node.b));
    so_far.numbers.push_back(number);
    so_far.conditions.push_back(condition);
  }
  std::vector<Number> out;
  for (const Number& x : values) out.push_back(x.constant() ? x : so_far.number(x.node()));
  return out;
}

}  // namespace hamel::graph
