// Operations of expression graphs and of programs.
//
// Numbers are doubles. Conditions are results of comparisons, operands of and, or, not and select
// only. Operations round as IEEE 754 does, in the order in which they are written; none is fused.
#pragma once

#include <cstdint>

namespace hamel::graph {

enum class Op : std::uint8_t {
  constant,
  input,
  // a op b
  add,
  subtract,
  multiply,
  divide,
  min,  // b < a ? b : a, as std::min
  max,  // a < b ? b : a, as std::max
  // op a
  negate,
  abs,
  sqrt,
  round,  // to the nearest integer, ties to even
  // conditions
  less,        // a < b
  less_equal,  // a <= b
  equal,       // a == b
  both,        // a && b
  either,      // a || b
  opposite,    // !a
  select,      // a ? b : c
  // functions of the C library, lane by lane
  exp,
  log,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  atan2,  // of y = a, x = b
  pow,    // a^b
  // recorded; a program has their polynomials, and the functions of the C library beyond
  // kLargestAngle
  sin,
  cos,
  // of programs: |b| <= kLargestAngle ? a : sin(b), cos(b)
  sin_beyond,
  cos_beyond,
};

/// Largest |x| in rad whose sine and cosine are polynomials of the reduced angle.
inline constexpr double kLargestAngle = 1e5;

/// Is it a function of the C library?
constexpr bool is_call(Op op) { return op >= Op::exp && op <= Op::pow; }
constexpr bool is_beyond(Op op) { return op == Op::sin_beyond || op == Op::cos_beyond; }
/// Is its result a condition?
constexpr bool is_condition(Op op) { return op >= Op::less && op <= Op::opposite; }

/// Number of operands, 0 to 3.
constexpr int operand_count(Op op) {
  if (op == Op::constant || op == Op::input) return 0;
  if (op == Op::select) return 3;
  if (op <= Op::max || (op >= Op::less && op <= Op::either)) return 2;
  return op == Op::atan2 || op == Op::pow || is_beyond(op) ? 2 : 1;
}

/// Value of an operation of numbers that gives a number, at doubles; not of select.
double evaluate(Op op, double a, double b);

}  // namespace hamel::graph
