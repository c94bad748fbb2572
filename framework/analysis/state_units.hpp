// Units of a system's own for the state of a steady motion. For steady_equations.cpp,
// steady_branch.cpp; not installed.
//
// A length l_i of each coordinate and one time T: delta_i is measured by l_i, nu_i by l_i/T, their
// rates, the first rows of F, by l_i/T and l_i/T^2; the rows of phi and A xi - b by their norms.
// With a_delta, a_nu the derivatives of the accelerations at some motions, 1/T is the greater of
// |a_delta|^(1/2) and |a_nu|, and the ratios of the l_i balance |a_delta| + |a_nu|/T (Osborne, On
// pre-conditioning of matrices, J. ACM 7, 1960): they go with the units of length, time and mass.
// The common factor of the l_i is the distance at which F stops to be linear, of a linear system
// that of its guess. In these units a step, a residual and a singular value are numbers.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <hamel/framework/analysis/steady_equations.hpp>

namespace hamel::reduced {

/// The factors l with equal sums of row i and column i of m_ij l_j/l_i, without the diagonal; m >=
/// 0.
Vector balanced(const Matrix& m);

/// The distance at which values along a curve differ from their linear part by a third of it;
/// nothing where they never do, or are nowhere linear.
std::optional<double> linear_reach(const std::function<Vector(double)>& values);

/// l_i up to their common factor, and 1/T; of |a_delta| and |a_nu|.
struct BalancedUnits {
  Vector lengths;
  double rate;
};
BalancedUnits balanced_units(const Matrix& by_place, const Matrix& by_velocity);

/// l_i of accelerations at a place: their slope by (delta, nu), and their values at a displaced
/// one.
Vector own_lengths(const Matrix& slope, const Vector& xi,
                   const std::function<Vector(const Vector&)>& acceleration);

/// About the guesses of some systems: 2n columns; rows of F with the momentum held.
StateUnits state_units(const std::vector<const SteadyEquations*>& systems);

}  // namespace hamel::reduced
