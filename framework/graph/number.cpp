#include <hamel/framework/graph/number.hpp>

#include <bit>
#include <cmath>
#include <cstdint>

namespace hamel::graph {
namespace {

const Node* made_by(const Number& x, Op op) {
  if (x.constant()) return nullptr;
  const Node& node = Recording::current().nodes()[static_cast<size_t>(x.node())];
  return node.op == op ? &node : nullptr;
}

Number operand(int node) { return Recording::current().number(node); }

// x = -y: y.
bool is_negated(const Number& x, Number& y) {
  const Node* node = made_by(x, Op::negate);
  if (node) y = operand(node->a);
  return node != nullptr;
}

// x = k y with a constant k; constants are first operands.
bool is_multiple(const Number& x, double& k, Number& y) {
  const Node* node = made_by(x, Op::multiply);
  if (!node) return false;
  const Number first = operand(node->a);
  if (!first.constant()) return false;
  k = first.value();
  y = operand(node->b);
  return true;
}

// a = k y, b = l y.
bool are_multiples_of_one(const Number& a, const Number& b, double& k, double& l, Number& y) {
  Number x = a, z = b;
  k = l = 1;
  if (!is_multiple(a, k, x) && is_negated(a, x)) k = -1;
  if (!is_multiple(b, l, z) && is_negated(b, z)) l = -1;
  y = x;
  return x.node() == z.node();
}

// Products of constants that neither over- nor underflow.
bool is_safe(double product) { return std::isnormal(product); }

Number multiply_by_constant(double k, const Number& x) {
  if (k == 0) return 0;
  if (k == 1) return x;
  if (k == -1) return -x;
  double l;
  Number y;
  if (is_negated(x, y)) return Number(-k) * y;
  if (is_multiple(x, l, y) && is_safe(k * l)) return Number(k * l) * y;
  return Recording::current().make(Op::multiply, k, x);
}

Number function(Op op, const Number& x) {
  if (x.constant()) return evaluate(op, x.value(), 0);
  return Recording::current().make(op, x);
}

Number function(Op op, const Number& a, const Number& b) {
  if (a.constant() && b.constant()) return evaluate(op, a.value(), b.value());
  return Recording::current().make(op, a, b);
}

// Operands in the order of their nodes, constants first: for operations with a op b = b op a.
Number symmetric(Op op, const Number& a, const Number& b) {
  const bool ordered = a.node() <= b.node();
  return Recording::current().make(op, ordered ? a : b, ordered ? b : a);
}

}  // namespace

// ---- folding ----

Number operator+(const Number& a, const Number& b) {
  if (a.constant() && b.constant()) return a.value() + b.value();
  if (a.is(0)) return b;
  if (b.is(0)) return a;
  double k, l;
  Number y;
  if (are_multiples_of_one(a, b, k, l, y) && std::isfinite(k + l)) return Number(k + l) * y;
  if (is_negated(b, y)) return a - y;
  if (is_negated(a, y)) return b - y;
  if (is_multiple(b, k, y) && k < 0) return a - Number(-k) * y;
  if (is_multiple(a, k, y) && k < 0) return b - Number(-k) * y;
  return symmetric(Op::add, a, b);
}

Number operator-(const Number& a, const Number& b) {
  if (a.constant() && b.constant()) return a.value() - b.value();
  if (a.is(0)) return -b;
  if (b.is(0)) return a;
  double k, l;
  Number y;
  if (are_multiples_of_one(a, b, k, l, y) && std::isfinite(k - l)) return Number(k - l) * y;
  if (is_negated(b, y)) return a + y;
  if (is_multiple(b, k, y) && k < 0) return a + Number(-k) * y;
  return Recording::current().make(Op::subtract, a, b);
}

Number operator-(const Number& a) {
  if (a.constant()) return -a.value();
  double k;
  Number y;
  if (is_negated(a, y)) return y;
  if (is_multiple(a, k, y)) return Number(-k) * y;
  return Recording::current().make(Op::negate, a);
}

Number operator*(const Number& a, const Number& b) {
  if (a.constant() && b.constant()) return a.value() * b.value();
  if (a.constant()) return multiply_by_constant(a.value(), b);
  if (b.constant()) return multiply_by_constant(b.value(), a);
  Number y;
  if (is_negated(a, y)) return -(y * b);
  if (is_negated(b, y)) return -(a * y);
  return symmetric(Op::multiply, a, b);
}

Number operator/(const Number& a, const Number& b) {
  if (a.constant() && b.constant()) return a.value() / b.value();
  if (a.is(0)) return 0;
  if (b.constant()) {
    int exponent;
    const double reciprocal = 1 / b.value();  // exact of a power of two
    if (std::abs(std::frexp(b.value(), &exponent)) == 0.5 && is_safe(reciprocal)) {
      return Number(reciprocal) * a;
    }
  }
  Number y;
  if (is_negated(a, y)) return -(y / b);
  if (is_negated(b, y)) return -(a / y);
  return Recording::current().make(Op::divide, a, b);
}

Number abs(const Number& x) {
  Number y;
  if (is_negated(x, y)) return abs(y);
  if (made_by(x, Op::abs)) return x;
  return function(Op::abs, x);
}

Number sqrt(const Number& x) { return function(Op::sqrt, x); }
Number rint(const Number& x) { return function(Op::round, x); }
Number sin(const Number& x) {
  Number y;
  return is_negated(x, y) ? -sin(y) : function(Op::sin, x);
}
Number cos(const Number& x) {
  Number y;
  return is_negated(x, y) ? cos(y) : function(Op::cos, x);
}
Number tan(const Number& x) { return x.constant() ? Number(std::tan(x.value())) : sin(x) / cos(x); }
Number exp(const Number& x) { return function(Op::exp, x); }
Number log(const Number& x) { return function(Op::log, x); }
Number asin(const Number& x) { return function(Op::asin, x); }
Number acos(const Number& x) { return function(Op::acos, x); }
Number atan(const Number& x) { return function(Op::atan, x); }
Number sinh(const Number& x) { return function(Op::sinh, x); }
Number cosh(const Number& x) { return function(Op::cosh, x); }
Number tanh(const Number& x) { return function(Op::tanh, x); }
Number atan2(const Number& y, const Number& x) { return function(Op::atan2, y, x); }
Number min(const Number& a, const Number& b) { return function(Op::min, a, b); }
Number max(const Number& a, const Number& b) { return function(Op::max, a, b); }

Number pow(const Number& x, const Number& y) {
  if (x.constant() && y.constant()) return std::pow(x.value(), y.value());
  if (y.is(0)) return 1;
  if (y.is(1)) return x;
  if (y.is(-1)) return 1 / x;
  if (y.is(2)) return x * x;
  if (y.is(3)) return x * x * x;
  if (y.is(4)) return (x * x) * (x * x);
  return function(Op::pow, x, y);
}

// ---- conditions ----

Condition operator<(const Number& a, const Number& b) {
  if (a.constant() && b.constant()) return a.value() < b.value();
  return Recording::current().compare(Op::less, a, b);
}

Condition operator<=(const Number& a, const Number& b) {
  if (a.constant() && b.constant()) return a.value() <= b.value();
  return Recording::current().compare(Op::less_equal, a, b);
}

Condition operator==(const Number& a, const Number& b) {
  if (a.constant() && b.constant()) return a.value() == b.value();
  return Recording::current().compare(Op::equal, a, b);
}

Condition operator&&(const Condition& a, const Condition& b) {
  if (a.constant()) return a.value() ? b : a;
  if (b.constant()) return b.value() ? a : b;
  return Recording::current().combine(Op::both, a, b);
}

Condition operator||(const Condition& a, const Condition& b) {
  if (a.constant()) return a.value() ? a : b;
  if (b.constant()) return b.value() ? b : a;
  return Recording::current().combine(Op::either, a, b);
}

Condition operator!(const Condition& a) {
  if (a.constant()) return !a.value();
  const Recording& recording = Recording::current();
  const Node& node = recording.nodes()[static_cast<size_t>(a.node())];
  if (node.op == Op::opposite) return recording.condition(node.a);
  return Recording::current().combine(Op::opposite, a, false);
}

Number select(const Condition& c, const Number& a, const Number& b) {
  if (c.constant()) return c.value() ? a : b;
  const bool same =
      a.node() == b.node() && (!a.constant() || std::bit_cast<std::uint64_t>(a.value()) ==
                                                    std::bit_cast<std::uint64_t>(b.value()));
  return same ? a : Recording::current().make_select(c, a, b);
}

}  // namespace hamel::graph
