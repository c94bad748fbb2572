// Derivatives of recorded formulas, as further formulas of the same recording.
//
// Forwards along a direction, backwards for gradients; both give exact derivatives of the formula,
// not differences. |x| has the slope 0 at 0, rint(x) everywhere, min(x, x) and max(x, x) the slope
// of their first argument; a selection has that of the value selected. What is not selected counts
// nothing, also where its slope is infinite.
#pragma once

#include <vector>

#include <hamel/framework/graph/number.hpp>

namespace hamel::graph {

/// Rates of outputs where the inputs change at these rates: J r. Inputs: any values of the current
/// recording, held to be independent. Throws std::invalid_argument unless there is a rate for each
/// input.
std::vector<Number> along(const std::vector<Number>& outputs, const std::vector<Number>& inputs,
                          const std::vector<Number>& rates);

/// Derivatives of sum w_k y_k by the inputs: J^T w. Throws std::invalid_argument unless there is a
/// weight for each output.
std::vector<Number> gradient(const std::vector<Number>& outputs, const std::vector<Number>& weights,
                             const std::vector<Number>& inputs);

/// Second derivatives of sum w_k y_k by the inputs, n x n, symmetric up to round-off: row i is the
/// derivative of the gradient along input i.
std::vector<std::vector<Number>> hessian(const std::vector<Number>& outputs,
                                         const std::vector<Number>& weights,
                                         const std::vector<Number>& inputs);

}  // namespace hamel::graph
