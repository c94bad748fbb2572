// The equations of steady motions of one system, and Newton's method on them. For steady*.cpp, not
// installed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/analysis/reduced_flow.hpp>
#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel::reduced {

/// Residual of a steady motion, in own units.
constexpr double kGood = 1e-9;
/// Bound of the round-off of F, in own units, where Newton's method ends.
constexpr double kNoise = 2e-14;
/// Relative to the largest singular value: below it are directions along which steady motions lie.
constexpr double kNull = 1e-11;

/// The point (g, xi), and the generator (zeta, eta) of the symmetry that carries it.
struct SteadyPoint {
  Vector g, xi, generator;
  double residual = 0;
};

/// Units of a system's own: of (delta, nu), and of F; state_units.hpp.
struct StateUnits {
  Vector columns, rows;
};

/// The linearisation about a steady motion, without the symmetries: z = (delta, nu) = basis y, y =
/// dual z, y' = flow y.
struct ReducedLinearisation {
  Matrix basis, dual, flow;  // dual basis = 1; columns are orthonormal in units of `sizes`
  Matrix error;              // of the entries of flow
  Matrix orbit;              // the directions divided out
  double rate = 1;           // 1/s, of the fastest change
  Vector sizes;              // of the 2n numbers: lengths and rates of the system itself
};

/// Least-norm solution of a x = b: what is `least` of the largest column, or of 1, is zero.
Vector least_norm(const Matrix& a, const Vector& b, double least = 1e-10);

/// The start of a run as a guess: at a speed without the push that a system's file has.
Start guess_of(const Simulation& run, const Run& built);

/// Names of the velocities, and of the displacements that are coordinates of the shape; else "".
struct ModeNames {
  std::vector<std::string> velocities, coordinates;
  explicit ModeNames(const SystemModel& model);
};

/// Steps in which the equations are differentiated near a point.
struct Reach {
  Vector extents;   // of the inertia and the rows, by displacement
  Vector steps;     // of the 2n numbers: what the equations are smooth over
  double rate = 1;  // 1/s, of the fastest change
};

class SteadyEquations {
 public:
  /// Throws ConfigError when the system depends on time. neighbour: along a parameter; its reach is
  /// taken, which saves finding it.
  SteadyEquations(const Registry& registry, const SystemModel& model, const Start& guess,
                  const SteadyEquations* neighbour = nullptr);

  int dim() const { return flow_.dim(); }
  const Flow& flow() const { return flow_; }
  const Geometry& geometry() const { return *geometry_; }

  /// The direction in which momentum may be held: that of the guess, or another.
  const Vector& along() const { return along_; }
  double guess_momentum() const { return flow_.momentum(guess_g_, guess_xi_).norm(); }
  void hold_along(Vector along) { along_ = std::move(along); }

  /// The directions (delta, nu) of the symmetries there: orthonormal columns.
  Matrix orbit(const SteadyPoint& at) const;
  /// Own units: those about the guess, or others.
  const StateUnits& scales() const;
  void set_scales(StateUnits scales) { scales_ = std::move(scales); }

  /// With the best generator there.
  SteadyPoint at(Vector g, Vector xi) const;
  SteadyPoint guess() const { return at(guess_g_, guess_xi_); }
  /// The guess without its residual.
  SteadyPoint carried_guess() const { return carried(guess_g_, guess_xi_); }
  /// F = (W, phi, A xi - b); and, held, the momentum along the guess less that of the guess.
  Vector values(const SteadyPoint& at, bool held) const;
  /// F at (g tau(delta), xi + nu), for (delta, nu) = step, with another generator: changed by
  /// `carrier`.
  Vector displaced(const SteadyPoint& at, bool held, const Vector& step,
                   const Vector& carrier) const;
  /// Generators whose directions are the columns of orbit(at).
  Matrix carriers(const SteadyPoint& at) const;
  /// dF by (delta, nu), and by the carrier: 2n columns, and one for each direction of the orbit.
  Matrix slope(const SteadyPoint& at, bool held) const;
  /// dF by (delta, nu) in own units, with the rows along the carriers left out: whatever they are.
  Matrix slope_across(const SteadyPoint& at, bool held) const;
  /// Newton's method with least-norm steps, halved where the residual does not fall. Returns the
  /// sum of the steps (delta, nu).
  Vector find(SteadyPoint& at, bool held, int steps = 60) const;
  /// Near the guess, with its momentum where that can be held; sets held.
  SteadyPoint find_near_guess(bool& held) const;
  /// The singular values of slope(), least first, and the right singular vectors, as columns
  /// (delta, nu).
  struct Singular {
    Vector values;
    Matrix right;
    double size = 0;  // the largest value
  };
  Singular singular(const SteadyPoint& at, bool held) const;
  /// The first of these vectors without their part along the symmetries: orthonormal columns
  /// (delta, nu).
  Matrix beside(const SteadyPoint& at, const Singular& singular, Eigen::Index count) const;

  ReducedLinearisation linearise(const SteadyPoint& at) const;
  /// family: how many zeros of the family there are; -1: those that are zero to their errors.
  SteadyMotion motion(const SteadyPoint& at, int family) const;

 private:
  const Matrix& symmetries() const;
  SteadyPoint carried(Vector g, Vector xi) const;
  void measure_by_itself(SteadyPoint& at) const;
  // In own units.
  Vector newton_step(const SteadyPoint& at, bool held) const;
  Vector field(const Vector& g, const Vector& xi, const Reach& reach) const;
  Vector equations(const Vector& generator, const Vector& g, const Vector& xi,
                   const Reach& reach) const;
  Vector units() const;
  void find_reach();
  CentralDifferences differences(const SteadyPoint& at, int number, const Reach& reach,
                                 const Vector& noise) const;
  // Where all numbers change, a place beside a point, in steps that the equations are smooth over.
  SteadyPoint point_beside(const SteadyPoint& at, const Reach& reach, double e) const;
  // dF by (delta, nu), the generator held: of formulas, or by differences.
  Matrix derivative(const SteadyPoint& at) const;
  Matrix derivative_by_differences(const SteadyPoint& at) const;
  // The same, with errors.
  struct Slope {
    Matrix value, error;
  };
  Slope slope_with_error(const SteadyPoint& at) const;

  std::shared_ptr<const Geometry> geometry_;
  Vector guess_g_;
  Flow flow_;
  Vector guess_xi_, along_;
  ModeNames names_;
  Reach reach_;                // of the guess
  mutable Matrix symmetries_;  // computed on first use
  mutable bool has_symmetries_ = false;
  mutable StateUnits scales_;  // the same
};

}  // namespace hamel::reduced
