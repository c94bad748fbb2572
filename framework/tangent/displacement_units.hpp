// Units of displacements along a motion, so that no difference depends on those of the user. Not
// installed.
//
//   1 for angles, the radius of gyration for lengths beside them (mechanics/natural_units.hpp). Of
// components without such a unit (lengths of a system without angles, what a file calls by no unit)
//   s_i = L / sqrt(I_ii),  L = T |xi| + T^2 |xi'| / 2,  |x|^2 = x^T I x
// the way of the motion in T, the time of so many steps or that of the run: a change of units D of
// one component, xi_i D_i, changes I_ii by D_i^-2 and s_i by D_i.
#pragma once

#include <Eigen/Core>

#include <hamel/framework/tangent/step_map.hpp>

namespace hamel {

/// At the start of a motion whose first step is h; 1 for what does not move at all.
Eigen::VectorXd displacement_units(StepMap& map, const MotionState& start, double h);

}  // namespace hamel
