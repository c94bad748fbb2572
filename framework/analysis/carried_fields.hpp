// Brackets of many fields without differences of differences: fields carried back along paths. For
// growth.cpp only, not installed.
//
// In the coordinates x of g tau(x), along a path of constant controls u in pieces of random
// lengths, all scaled with e, the field X_b at the end, carried back to the start, is
//   V_b(e) = sum_j e^j/j! (sum over the pieces of ad_{u_1} ... ad_{u_j} X_b),
// so that the Taylor coefficients up to order j of random paths span all brackets of at most j + 1
// fields, those with factors that vanish at g among them. Paths are integrated by extrapolated
// midpoint rules of order 8, tangents carried by sixth-order differences of the flow, coefficients
// fitted on Chebyshev nodes, each for several radii. Source: Sussmann, Orbits of families of vector
// fields, Trans. AMS 180 (1973).
#pragma once

#include <vector>

#include <Eigen/Core>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/mechanics.hpp>

namespace hamel::carried {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Relative to the size of the fields: smaller generations are taken for zero.
constexpr double kNothing = 1e-6;

/// The fields X_0 (where there is one) and X_a at x, t, as columns; the coordinates are x or (x,
/// t), in units of `units`. X_a is a vector of the frame at g, constant in the body, less what the
/// rows forbid of it; X_0 is the least velocity that they require, both in the metric of the
/// inertia at g.
class Fields {
 public:
  Fields(const Geometry& geometry, const Mechanics& mechanics, const Vector& g, const Vector& units,
         bool with_drift);
  Eigen::Index coordinates() const { return n_ + drift_; }
  Eigen::Index count() const { return frame_.cols() + drift_; }
  bool with_drift() const { return drift_ == 1; }

  Matrix operator()(const Vector& x);
  /// The element at x.
  const Vector& element(const Vector& x);

 private:
  const Geometry& geometry_;
  const Mechanics& mechanics_;
  // A and b in these units, with rows of size 1 in them.
  void set_rows(double t);

  Vector g_, at_, units_;
  Eigen::Index n_, drift_;
  Matrix a_, frame_;
  Vector b_;
  Matrix metric_;  // the inverse inertia
  Matrix raised_, lambda_;
};

/// A generation of brackets, those of j + 1 fields: the coefficients of order j of all paths,
/// |(e/r)^j| = 1 at the radius
// where they are best known, and how well that is.
struct Generation {
  Matrix brackets;
  double size = 0, error = 0;
  Vector errors;  // the largest of each coordinate
};
/// The length over which the fields are smooth there, 1 at most: radii and steps are parts of it.
double own_length(Fields& fields, const Vector& from);
/// The fields carried back along random paths, which span the directions of the orbit through
/// `from`: those of all brackets, if the fields are analytic (Sussmann 1973, Nagano 1966).
Generation orbit(Fields& fields, const Vector& from);
/// From a place `from`, entry j the brackets of j + 1 fields.
std::vector<Generation> generations(Fields& fields, const Vector& from, int depth);

}  // namespace hamel::carried
