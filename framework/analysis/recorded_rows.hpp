// The rows of a system as formulas of numbers that move, wherever it keeps its formulas. Not
// installed.
#pragma once

#include <optional>

#include <hamel/framework/graph/row_fields.hpp>
#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel {

/// Empty where the system has none, or none that give its rows at an element. Model, mechanics and
/// geometry outlive them.
std::optional<graph::RowFields> recorded_rows(const SystemModel& model, const Geometry& geometry,
                                              const double* g);

}  // namespace hamel
