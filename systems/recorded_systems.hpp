// The formulas of registered systems that are types, recorded (graph/motion_terms.hpp).
#pragma once

namespace hamel {

/// Adds the systems whose inertia, rows and potential are templates on the element.
void add_recorded_systems();

}  // namespace hamel
