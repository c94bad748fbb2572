// Formulas of one recording, repeated in another with other inputs.
#pragma once

#include <vector>

#include <hamel/framework/graph/number.hpp>

namespace hamel::graph {

/// Values of `from`, repeated in the thread's current recording with these numbers in place of its
/// inputs, in their order; constants fold anew. `from` is complete, or is the current one.
std::vector<Number> substituted(const Recording& from, const std::vector<Number>& values,
                                const std::vector<Number>& inputs);

}  // namespace hamel::graph
