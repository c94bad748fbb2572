// The equation of steady motions near a point where F_z is singular, in one unknown, and the kind
// of the bifurcation by its coefficients. For steady_sweep.cpp, not installed.
//
// v spans the kernel of F_z (without the symmetries and families that are there on both sides of
// it), w that of its transpose. Of F(z, q) = 0 is left
//   beta(s, q) = 0,   s along v:
//   beta_q  = w F_q,
//   beta_ss = w F_zz[v, v] = b,
//   beta_sss = w (F_zzz[v, v, v] + 3 F_zz[v, z2]) = c,   F_z z2 = -F_zz[v, v].
// Where beta_q != 0 and b != 0 the branch turns (fold). Where a branch s = s_b(q) passes, beta =
// (s - s_b) h(s, q): b = 2 h_s, c = 3 h_ss, and with d = d/dq (w F_z v) along that branch the other
// one is
//   s - s_b = -2 d/b (q - q0)            where b != 0 (transcritical),
//   q - q0 = -c/(6 d) s^2                where b = 0, c != 0 (pitchfork): at the values where the
// branch is unstable it is supercritical. Ratios of these numbers and their errors decide: no
// length does. Both zero to their errors, and the motions along v at one value: a family.
// Derivatives along curves s v + s^2/2 z2: central_differences.hpp. At the point itself Newton's
// method does not fix the place along v; it is interpolated from nodes on both sides.
// Sources: Golubitsky, Schaeffer, Singularities and Groups in Bifurcation Theory I (1985), I.3 and
// II; Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria (2000), 6.
#pragma once

#include <cmath>
#include <vector>

#include <hamel/framework/analysis/steady_branch.hpp>

namespace hamel::reduced {

/// A number and a bound of its error.
struct Estimate {
  double value = 0, error = 0;
  bool is_nonzero() const { return std::abs(value) > 10 * error; }
  bool is_zero() const { return std::abs(value) <= error; }
};

/// Vectors of F_z at a point, as a step (delta, nu) and a change of the generator.
struct KernelVector {
  Vector step, carrier;
};

/// The reduced equation at a point of a branch.
class BifurcationEquation {
 public:
  /// At a point of F = 0, with regular points of the branch around it.
  BifurcationEquation(Branch& branch, const BranchNode& at, const std::vector<BranchNode>& around);

  /// How many directions there are in which F_z is singular only here; -1: not decided.
  int kernel() const { return kernel_; }
  const BranchNode& at() const { return at_; }
  /// Moves the point along v to where the branch through nodes of known places passes at its value:
  /// interpolated, from sets of nodes at different distances. value_error: of its value.
  void centre(const std::vector<std::vector<BranchNode>>& sets, double value_error);
  /// Sets the error of the place along v.
  void set_place_error(double error) { place_error_ = error; }

  /// Computes b and c; beside: another node of the branch.
  void expand(const BranchNode& beside);
  Estimate quadratic() const { return quadratic_; }
  Estimate cubic() const { return cubic_; }
  /// True where |b s^2/2| is less than a thousandth of |c s^3/6|, to its error, at the largest step
  /// s at which F is smooth.
  bool quadratic_is_covered() const;
  /// Computes w F_q.
  void expand_by_value();
  Estimate by_value() const { return by_value_; }
  /// w F_z v at a node.
  double slope_at(const BranchNode& node) const;
  /// The place of a node along v.
  double place_of(const BranchNode& node) const;
  /// The point s v + s^2/2 z2 from a node, at another value.
  SteadyPoint displaced(const BranchNode& from, double value, double s) const;

 private:
  struct Scaled;
  Scaled scaled(const BranchNode& node) const;
  void find_vectors(const std::vector<BranchNode>& around);
  Vector solve(const Vector& right) const;
  KernelVector vector_of(const Vector& scaled) const;
  // F at a node displaced by s v + second z2, in own units.
  Vector values(const BranchNode& node, double s, double second) const;

  Branch& branch_;
  BranchNode at_;
  int kernel_ = 0;
  Matrix slope_, carriers_;  // dF there and the generators of its columns, in own units
  Vector v_scaled_, w_;
  KernelVector v_, second_;
  double place_error_ = 0, value_error_ = 0, reach_ = 0;
  double mixed_ = 0;
  Estimate quadratic_, cubic_, by_value_;
};

}  // namespace hamel::reduced
