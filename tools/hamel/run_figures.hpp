// The figures of one run: what moved, the physics, how accurate it is.
#pragma once

#include "run_page.hpp"

namespace hamel::tools {

/// Forces or moving constraints do.
bool does_work(const Result& result);

/// Bodies that move, the path in the plane (with that of a contact), the body's axes on the sphere;
/// those that there are.
void add_motion(Page& page, const Result& result);

/// The inputs that drove it, by unit; nothing where all inputs are constant.
void add_inputs(Page& page, const Result& result, const std::vector<Mark>& marks);

/// Body velocity and shape by unit, reactions with the sign of contacts, the energy balance where
/// work is done, body momentum. A component has one colour in all of them. `marks` are drawn in
/// each.
void add_physics(Page& page, const Result& result, const std::vector<Mark>& marks);

/// Errors, energy, constraints and group, each with the floor of round-off.
void add_accuracy(Page& page, const Result& result);

}  // namespace hamel::tools
