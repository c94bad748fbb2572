// Slopes of columns and of inputs about a steady motion, with their errors. For linearisation.cpp,
// not installed.
#pragma once

#include <memory>

#include <hamel/framework/analysis/steady_equations.hpp>
#include <hamel/framework/mechanics/coordinate_rates.hpp>

namespace hamel::reduced {

struct Slopes {
  Matrix value, error;
};

/// Slopes along directions (delta, nu): of coordinates by the rates that their group states, or by
/// differences where it states none; then of velocities.
Slopes column_slopes(const SteadyEquations& equations, const CoordinateRates& rates,
                     const SteadyPoint& at, const Matrix& directions, const Vector& sizes);

/// Slopes of the acceleration, then of A xi - b, by each input: exact, with their round-off, of a
/// system with formulas.
Slopes exact_input_slopes(const SteadyEquations& equations, const SteadyPoint& at,
                          const Vector& sizes);
/// Slopes by differences.
Slopes differenced_input_slopes(const SteadyEquations& equations,
                                const std::shared_ptr<const Geometry>& geometry,
                                const SystemModel& model, const SteadyPoint& at);

}  // namespace hamel::reduced
