// The equations of motion of a system as text: LaTeX, a function in C, in Python with NumPy, SymPy.
// Not installed.
#pragma once

#include <string>

#include <hamel/framework/analysis/motion_formulas.hpp>
#include <hamel/framework/graph/formula_text.hpp>

namespace hamel {

/// Velocities that rows make 0, or a multiple of one other, are written so: xi' of admissible
/// velocities. title: what the equations are of, for the comment in front.
std::string equations_text(const MotionFormulas& motion, const std::string& name,
                           const std::string& title, graph::Notation notation);

}  // namespace hamel
