// The formulas of a system, wherever it keeps them: in itself, by its type, or in its constant
// matrices. Not installed.
#pragma once

#include <functional>
#include <span>

#include <hamel/framework/graph/motion_terms.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// Formulas in the current recording, of variables in the order of graph::HasSystemFormulas.
using RecordedFormulas = std::function<graph::SystemFormulas(std::span<const graph::Number>)>;

/// Empty where the system has none. g: any element. mechanics outlives it.
RecordedFormulas recorded_formulas(const SystemModel& model, const Mechanics& mechanics,
                                   const double* g);

std::vector<graph::FactorShape> factor_shapes(const GroupInfo& group);

}  // namespace hamel
