#include <hamel/framework/graph/operation.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hamel::graph {

double evaluate(Op op, double a, double b) {
  switch (op) {
    case Op::add: return a + b;
    case Op::subtract: return a - b;
    case Op::multiply: return a * b;
    case Op::divide: return a / b;
    case Op::min: return std::min(a, b);
    case Op::max: return std::max(a, b);
    case Op::negate: return -a;
    case Op::abs: return std::abs(a);
    case Op::sqrt: return std::sqrt(a);
    case Op::round: return std::rint(a);
    case Op::exp: return std::exp(a);
    case Op::log: return std::log(a);
    case Op::asin: return std::asin(a);
    case Op::acos: return std::acos(a);
    case Op::atan: return std::atan(a);
    case Op::sinh: return std::sinh(a);
    case Op::cosh: return std::cosh(a);
    case Op::tanh: return std::tanh(a);
    case Op::atan2: return std::atan2(a, b);
    case Op::pow: return std::pow(a, b);
    case Op::sin: return std::sin(a);
    case Op::cos: return std::cos(a);
    case Op::sin_beyond: return std::abs(b) <= kLargestAngle ? a : std::sin(b);
    case Op::cos_beyond: return std::abs(b) <= kLargestAngle ? a : std::cos(b);
    default: throw std::logic_error("graph::evaluate: an operation of conditions, or none");
  }
}

}  // namespace hamel::graph
