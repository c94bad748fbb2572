// Languages in which formulas are written (formula_text.hpp), their functions and constants.
#pragma once

#include <string>

#include <hamel/framework/graph/operation.hpp>

namespace hamel::graph {

enum class Notation { latex, c, numpy, sympy };

/// Name of the function of an operation; "" where it has none.
std::string function_text(Op op, Notation notation);

/// Number to 6 digits in LaTeX, else with all of its digits.
std::string constant_text(double x, Notation notation);

}  // namespace hamel::graph
