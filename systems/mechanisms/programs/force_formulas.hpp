// The forces of a mechanism beside weight (forces.hpp), recorded.
#pragma once

#include <span>
#include <vector>

#include <hamel/systems/mechanisms/forces.hpp>
#include <hamel/systems/mechanisms/programs/body_formulas.hpp>

namespace hamel::mechanisms {

/// Numbers that forces take from outside of the formulas: the coordinates of joints with springs,
/// then the efforts of motors, then three components of each force at a point.
size_t count_signals(const Forces& forces);
/// Their values; the coordinates alone.
void find_coordinates(const Forces& forces, const Tree& tree, const double* g, double* out);
void find_signals(const Forces& forces, const Tree& tree, const double* g, const SignalInput& now,
                  double* out);
/// out += -dV of the springs; out += the efforts of dampers, motors and forces at points.
void add_springs(const Forces& forces, const BodyFormulas& bodies, std::span<const Number> signals,
                 std::vector<Number>& out);
void add_given(const Forces& forces, const BodyFormulas& bodies, std::span<const Number> xi,
               std::span<const Number> signals, std::vector<Number>& out);
Number potential_of_springs(const Forces& forces, const BodyFormulas& bodies,
                            std::span<const Number> signals);

}  // namespace hamel::mechanisms
