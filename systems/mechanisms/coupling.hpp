// A coupling of joints: an equation of their coordinates, or an equation linear in velocities.
//
//   of coordinates   phi(q) = 0, with the row (dphi/dq) q' = 0: gears, belts, mimicking joints,
//                    joint = ratio * to + offset; steering linkages, cams
//   of rates         sum c_i(q) xi_i = 0: differentials
//   of a state       z' - (sum c_i(q, z) xi_i + c(q, z)) = 0: its multiplier is 0, since z has no
//                    inertia and no force
// q are the coordinates of joints with one velocity, which is the rate of the coordinate.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <hamel/framework/io/expression.hpp>
#include <hamel/systems/mechanisms/contact.hpp>

namespace hamel::mechanisms {

struct Coupling {
  std::string name;
  Expression formula;           // of the coordinates, then of the velocities
  std::vector<int> links;       // whose joints have the coordinates
  std::vector<int> velocities;  // of xi; empty: an equation of coordinates
  bool affine = false;          // of a state: with a term c without velocities
  mutable std::vector<double> work = {};
  bool slips = false;  // dry friction; or a stop or wall, where phi is not negative

  bool of_rates() const { return !velocities.empty(); }
  /// phi at the elements of a tree, as it lays them out; 0 of an equation of velocities.
  double beyond(const Tree& tree, const double* g) const;
  /// Its row, with phi, at the same.
  void row(const Tree& tree, const double* g, Row& out) const;

 private:
  std::span<const double> variables(const Tree& tree, const double* g) const;
};

/// "" where the formula is linear in the velocities, affine where it may be, else how it is not;
/// tried at scattered values.
std::string not_linear(const Coupling& coupling);

}  // namespace hamel::mechanisms
