// Groups whose steps are differentiated as recorded formulas. Not installed.
#pragma once

namespace hamel {

/// Adds exp and cayley of the groups of bodies to framework/tangent/recorded_geometry.hpp.
void add_recorded_groups();

}  // namespace hamel
