// Steady motions and their stability: relative equilibria of a system (`hamel steady`).
//
// A motion is steady when a symmetry carries it along: Z = X_s of reduced_flow.hpp for some
// symmetry s, with phi = 0 and A xi = b. It is found by Newton's method (least-norm steps) near a
// guess. Seen from the frame that goes with s the field W = Z - X_s vanishes there, and its
// linearisation in (delta, nu), g exp(e delta), xi + e nu, is
//   delta' = nu + ad_delta Ad_g^-1 zeta,   nu' = da(g, xi)(delta, nu) + ad_eta nu,
// on the perturbations that keep phi = 0 and A xi = b. Perturbations along the symmetries are
// divided out: what is left are the eigenvalues. As many of them vanish as the steady motions form
// a family (of all speeds, of all circles). Along a parameter a branch of steady motions is
// followed from neighbour to neighbour, by a predictor along its tangent (steady_branch.hpp).
// Source: Meijaard, Papadopoulos, Ruina, Schwab, Linearized dynamics equations for the balance and
// steer of a bicycle, Proc. R. Soc. A 463 (2007); Zenkov, Bloch, Marsden, The energy-momentum
// method for the stability of nonholonomic systems, Dynamics and Stability of Systems 13 (1998);
// Govaerts, Numerical Methods for Bifurcations of Dynamical Equilibria (2000).
#pragma once

#include <complex>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

class Registry;

/// How much a velocity, or a coordinate of the shape, takes part in a mode, beside its largest
/// velocity.
struct ModePart {
  std::string name;
  double size;
};

struct HAMEL_API SteadyMotion {
  std::vector<double> element, velocity;  // coordinates and xi
  bool found = false;                     // else no eigenvalues
  double residual = 0;                    // of Z = X_s, phi and A xi = b
  std::vector<std::complex<double>>
      eigenvalues;  // 1/s, by real part, largest first; without the neutral ones
  /// Errors: how far each moves when the linearisation changes by its own error. A pair that
  /// coincides with another is ill-conditioned.
  std::vector<double> round_off;
  /// True of an eigenvalue whose real part is exactly 0: at rest, where time may run backwards.
  std::vector<bool> on_axis;
  std::vector<std::vector<ModePart>> modes;  // what moves in each
  int neutral = 0;                           // directions of symmetry, and zeros of the family
  int family = 0;                            // of them, zeros of the family
  /// How many eigenvalues have a positive real part, beyond their errors.
  int growing() const;
  /// The same, where no error covers a sign; empty: not decided.
  std::optional<int> decided_growing() const;
  /// No mode grows faster, in 1/s.
  double largest_growth() const;
};

/// The steady motion near a start, its rates named by components_of(model). Throws ConfigError when
/// the system depends on time.
HAMEL_API SteadyMotion steady_motion(const Registry& registry, const SystemModel& model,
                                     const Start& guess);
/// Steady motion near the start of a run: also `speed(5)`, of systems that define such a motion.
HAMEL_API SteadyMotion steady_motion(const Registry& registry, const Simulation& run);

/// Changes of the steady motions where their stability changes, or where a branch ends.
enum class Bifurcation {
  pitchfork,         // another branch crosses this one, on one side of the value, as two halves
  transcritical,     // another branch crosses this one
  fold,              // this branch turns back
  family,            // at this very value steady motions form a family
  hopf,              // a pair of complex eigenvalues crosses the imaginary axis
  hamiltonian_hopf,  // two pairs on the axis collide and leave it
  none,              // real eigenvalues pass zero, and no other branch was found
  undecided,         // errors cover the coefficients by which kinds differ
  unknown,           // a branch was lost, without a fold
};
/// "pitchfork", "hamiltonian_hopf".
HAMEL_API std::string name_of(Bifurcation kind);

/// A steady motion at a value of the parameter.
struct SteadyPlace {
  double value = 0;
  std::vector<double> element, velocity;
};

struct SteadyCrossing {
  double value = 0;
  double round_off = 0;  // of the value
  bool pair = false;     // of complex eigenvalues; else a real one
  Bifurcation kind = Bifurcation::unknown;
  /// True of a pitchfork whose other branch is where this one is unstable.
  std::optional<bool> supercritical;
  std::optional<SteadyPlace> other;  // on the branch that crosses this one, beside the crossing
};

/// An end of a branch between the values: it turns back (fold), joins another one there as one of
/// its halves (pitchfork), or was lost. other: on the branch that continues.
struct SteadyEnd {
  double value = 0, round_off = 0;
  bool towards_last = true;  // of the values; else towards the first
  Bifurcation kind = Bifurcation::unknown;
  std::optional<SteadyPlace> other;
};

/// A branch of steady motions along a parameter.
struct SteadySweep {
  std::vector<double> values;
  std::vector<SteadyMotion> motions;      // found = false where the branch is not
  std::vector<SteadyCrossing> crossings;  // where the number of unstable eigenvalues changes
  std::vector<SteadyEnd> ends;            // two at most; a branch without one leaves the range
  std::optional<SteadyPlace> start;   // of a branch that crosses another one: where it was entered
  std::vector<SteadySweep> branches;  // the others that were met and followed, none of them twice
  std::string parameter = "", unit = "";  // by name, for figures: whoever varies it knows them
};
/// The branch through the steady motion near the start of at(values[0]), or of the first value that
/// has one. Where steady motions form a family, it is that of the momentum along the start of
/// at(value). others: the branches that cross it are followed too, and those that cross them.
HAMEL_API SteadySweep sweep_steady(const Registry& registry, const std::vector<double>& values,
                                   const std::function<Simulation(double value)>& at,
                                   bool others = false);

/// Which eigenvalue of each motion continues as which of the next: entry i of a curve is the place
/// of the eigenvalue in motions[i], or -1 where the curve is not.
HAMEL_API std::vector<std::vector<int>> eigenvalue_curves(const std::vector<SteadyMotion>& motions);

/// A number rounded to the decimals that are known of it.
HAMEL_API double round_to_known(double x, double round_off);
/// How many decimals these are, 15 at most.
HAMEL_API int known_decimals(double round_off);

}  // namespace hamel
