#include <hamel/framework/graph/derivatives.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace hamel::graph {
namespace {

// Operation of a recording with its operands as numbers.
struct Operation {
  explicit Operation(int node)
      : result(Recording::current().number(node)),
        code(Recording::current().nodes()[static_cast<size_t>(node)]) {
    if (code.op == Op::constant || code.op == Op::input || is_condition(code.op)) return;
    if (code.op == Op::select) {
      first = Recording::current().number(code.b);
      second = Recording::current().number(code.c);
      return;
    }
    first = Recording::current().number(code.a);
    if (code.b >= 0) second = Recording::current().number(code.b);
  }
  bool is_selection() const {
    return code.op == Op::select || code.op == Op::min || code.op == Op::max || code.op == Op::abs;
  }
  /// of_first where the result is the first operand, of_second where it is the second; of |x|:
  /// of_first times sign x.
  Number chosen(const Number& of_first, const Number& of_second) const {
    switch (code.op) {
      case Op::select: return select(Recording::current().condition(code.a), of_first, of_second);
      case Op::min: return select(second < first, of_second, of_first);
      case Op::max: return select(first < second, of_second, of_first);
      default: return select(first > 0, of_first, select(first < 0, -of_first, 0));
    }
  }
  Number slope_of_first() const;
  Number slope_of_second() const;

  Number result, first, second;
  Node code;
};

Number Operation::slope_of_first() const {
  const Number &x = first, &y = second;
  switch (code.op) {
    case Op::add:
    case Op::subtract: return 1;
    case Op::multiply: return y;
    case Op::divide: return 1 / y;
    case Op::negate: return -1;
    case Op::sqrt: return 0.5 / result;
    case Op::exp: return result;
    case Op::log: return 1 / x;
    case Op::asin: return 1 / sqrt(1 - x * x);
    case Op::acos: return -1 / sqrt(1 - x * x);
    case Op::atan: return 1 / (1 + x * x);
    case Op::sinh: return cosh(x);
    case Op::cosh: return sinh(x);
    case Op::tanh: return 1 - result * result;
    case Op::atan2: return y / (x * x + y * y);
    case Op::pow: return select(y == 0, 0, y * pow(x, y - 1));
    case Op::sin: return cos(x);
    case Op::cos: return -sin(x);
    default: return 0;  // rint
  }
}

Number Operation::slope_of_second() const {
  const Number &x = first, &y = second;
  switch (code.op) {
    case Op::add: return 1;
    case Op::subtract: return -1;
    case Op::multiply: return x;
    case Op::divide: return -result / y;
    case Op::atan2: return -x / (x * x + y * y);
    case Op::pow: return select(x == 0, 0, result * log(x));
    default: return 0;
  }
}

void require(bool fits, const char* what) {
  if (!fits) throw std::invalid_argument(what);
}

size_t nodes_below(const std::vector<Number>& outputs) {
  int last = -1;
  for (const Number& y : outputs) last = std::max(last, y.node());
  return static_cast<size_t>(last + 1);
}

// Node, and those whose rates pass into its own; -1: none.
struct Passage {
  int node, first, second;
};

// Nodes between inputs and outputs, in their order.
std::vector<Passage> passages(const std::vector<Number>& outputs,
                              const std::vector<bool>& is_input) {
  const std::vector<Node>& nodes = Recording::current().nodes();
  std::vector<char> needed(is_input.size(), 0);
  for (const Number& y : outputs)
    if (!y.constant()) needed[static_cast<size_t>(y.node())] = 1;
  std::vector<Passage> out;
  for (size_t i = needed.size(); i-- > 0;) {
    if (!needed[i] || is_input[i]) continue;
    const Node& node = nodes[i];
    if (node.op == Op::constant || node.op == Op::input || is_condition(node.op)) continue;
    const bool selects = node.op == Op::select;
    const Passage step{static_cast<int>(i), selects ? node.b : node.a, selects ? node.c : node.b};
    for (const int operand : {step.first, step.second})
      if (operand >= 0) needed[static_cast<size_t>(operand)] = 1;
    out.push_back(step);
  }
  std::ranges::reverse(out);
  return out;
}

// Derivatives backwards.
class Backwards {
 public:
  Backwards(size_t nodes, const std::vector<Number>& inputs)
      : weights_(nodes),
        is_input_(nodes, false),
        depends_(nodes, false),
        may_be_unselected_(nodes, false) {
    for (const Number& x : inputs) {
      if (!x.constant() && static_cast<size_t>(x.node()) < nodes) {
        is_input_[static_cast<size_t>(x.node())] = depends_[static_cast<size_t>(x.node())] = true;
      }
    }
    find_dependent();
    find_branches();
  }
  void add(const Number& x, const Number& weight) {
    if (!x.constant() && depends_[static_cast<size_t>(x.node())]) at(x) += weight;
  }
  void run() {
    for (size_t i = weights_.size(); i-- > 0;) {
      if (depends_[i] && !is_input_[i] && !weights_[i].is(0)) pass(i);
    }
  }
  Number weight(const Number& x) {
    return x.constant() || static_cast<size_t>(x.node()) >= weights_.size() ? Number() : at(x);
  }

 private:
  Number& at(const Number& x) { return weights_[static_cast<size_t>(x.node())]; }

  void find_dependent() {
    for (size_t i = 0; i < depends_.size(); ++i) {
      const Operation o(static_cast<int>(i));
      for (const Number& x : {o.first, o.second}) {
        if (!x.constant() && depends_[static_cast<size_t>(x.node())]) depends_[i] = true;
      }
    }
  }
  void find_branches() {
    for (size_t i = may_be_unselected_.size(); i-- > 0;) {
      const Operation o(static_cast<int>(i));
      if (!may_be_unselected_[i] && !o.is_selection()) continue;
      for (const Number& x : {o.first, o.second}) {
        if (!x.constant()) may_be_unselected_[static_cast<size_t>(x.node())] = true;
      }
    }
  }
  void pass(size_t i) {
    const Operation o(static_cast<int>(i));
    const Number w = weights_[i];
    if (o.code.op == Op::abs) return add(o.first, o.chosen(w, 0));
    if (o.is_selection()) {
      add(o.first, o.chosen(w, 0));
      return add(o.second, o.chosen(0, w));
    }
    // An infinite slope below a weight of 0: 0 x infinity would be no number.
    const auto product = [&](const Number& slope) {
      const bool finite =
          !may_be_unselected_[i] || (slope.constant() && std::isfinite(slope.value()));
      return finite ? w * slope : select(w == 0, 0, w * slope);
    };
    if (is_dependent(o.first)) add(o.first, product(o.slope_of_first()));
    if (is_dependent(o.second)) add(o.second, product(o.slope_of_second()));
  }
  bool is_dependent(const Number& x) const {
    return !x.constant() && depends_[static_cast<size_t>(x.node())];
  }

  std::vector<Number> weights_;  // of nodes
  std::vector<bool> is_input_, depends_, may_be_unselected_;
};

}  // namespace

std::vector<Number> along(const std::vector<Number>& outputs, const std::vector<Number>& inputs,
                          const std::vector<Number>& rates) {
  require(rates.size() == inputs.size(), "graph::along: a rate for each input");
  std::vector<Number> rate(nodes_below(outputs));
  std::vector<bool> is_input(rate.size(), false);
  for (size_t k = 0; k < inputs.size(); ++k) {
    if (inputs[k].constant() || static_cast<size_t>(inputs[k].node()) >= rate.size()) continue;
    rate[static_cast<size_t>(inputs[k].node())] = rates[k];
    is_input[static_cast<size_t>(inputs[k].node())] = true;
  }
  std::vector<char> moves(rate.size(), 0);
  for (size_t i = 0; i < rate.size(); ++i) moves[i] = !rate[i].is(0);
  const auto rate_of = [&](const Number& x) {
    return x.constant() ? Number() : rate[static_cast<size_t>(x.node())];
  };
  const auto does_move = [&](int node) {
    return node >= 0 && moves[static_cast<size_t>(node)] != 0;
  };
  for (const Passage& step : passages(outputs, is_input)) {
    if (!does_move(step.first) && !does_move(step.second)) continue;
    const auto i = static_cast<size_t>(step.node);
    const Operation o(step.node);
    const Number a = rate_of(o.first), b = rate_of(o.second);
    if (o.is_selection()) {
      rate[i] = o.chosen(a, b);
    } else {
      if (!a.is(0)) rate[i] = o.slope_of_first() * a;
      if (!b.is(0)) rate[i] += o.slope_of_second() * b;
    }
    moves[i] = !rate[i].is(0);
  }
  std::vector<Number> out;
  for (const Number& y : outputs) out.push_back(rate_of(y));
  return out;
}

std::vector<Number> gradient(const std::vector<Number>& outputs, const std::vector<Number>& weights,
                             const std::vector<Number>& inputs) {
  require(weights.size() == outputs.size(), "graph::gradient: a weight for each output");
  Backwards backwards(nodes_below(outputs), inputs);
  for (size_t k = 0; k < outputs.size(); ++k) backwards.add(outputs[k], weights[k]);
  backwards.run();
  std::vector<Number> out;
  for (const Number& x : inputs) out.push_back(backwards.weight(x));
  return out;
}

std::vector<std::vector<Number>> hessian(const std::vector<Number>& outputs,
                                         const std::vector<Number>& weights,
                                         const std::vector<Number>& inputs) {
  const std::vector<Number> slopes = gradient(outputs, weights, inputs);
  std::vector<std::vector<Number>> out(inputs.size(), std::vector<Number>(inputs.size()));
  for (size_t i = 0; i < inputs.size(); ++i) {  // rows below are symmetric
    std::vector<Number> direction(inputs.size());
    direction[i] = 1;
    const std::vector<Number> row = along(
        {slopes.begin(), slopes.begin() + static_cast<std::ptrdiff_t>(i + 1)}, inputs, direction);
    for (size_t j = 0; j <= i; ++j) out[i][j] = out[j][i] = row[j];
  }
  return out;
}

}  // namespace hamel::graph
