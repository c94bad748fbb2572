// Steady motions and their stability: relative equilibria of a system (`hamel steady`).
//
// A motion is steady when a symmetry carries it along: Z = X_s of reduced_flow.hpp for some symmetry s, with phi = 0 and
// A xi = b. It is found by Newton's method (least-norm steps) near a guess. Seen from the frame that goes with s the field
// W = Z - X_s vanishes there, and its linearisation in (delta, nu), g exp(e delta), xi + e nu, is
//   delta' = nu + ad_delta Ad_g^-1 zeta,   nu' = da(g, xi)(delta, nu) + ad_eta nu,
// on the perturbations that keep phi = 0 and A xi = b. Those along the symmetries themselves are divided out: what is
// left are the eigenvalues. As many of them vanish as the steady motions form a family (of all speeds, of all circles).
// Source: Meijaard, Papadopoulos, Ruina, Schwab, Linearized dynamics equations for the balance and steer of a bicycle,
// Proc. R. Soc. A 463 (2007); Zenkov, Bloch, Marsden, The energy-momentum method for the stability of nonholonomic
// systems, Dynamics and Stability of Systems 13 (1998).
#pragma once

#include <complex>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

class Registry;

/// How much a velocity takes part in a mode, 1 the largest.
struct ModePart {
  std::string name;
  double size;
};

struct SteadyMotion {
  std::vector<double> element, velocity;  // coordinates and xi
  bool found = false;                     // else no eigenvalues
  double residual = 0;                    // of Z = X_s, phi and A xi = b
  std::vector<std::complex<double>>
      eigenvalues;                // 1/s, by real part, largest first; without the neutral ones
  std::vector<double> round_off;  // of each: a pair that meets another is known badly
  std::vector<std::vector<ModePart>> modes;  // what moves in each
  int neutral = 0;                           // directions of symmetry, and zeros of the family
  int family = 0;                            // of them, zeros of the family
  /// How many eigenvalues have a positive real part, beyond their round-off.
  int growing() const;
};

/// The steady motion near a start, its rates named by components_of(model). family: how many zeros there are; -1: those that are
/// zero to 1e-7. Throws ConfigError when the system depends on time.
SteadyMotion steady_motion(const Registry& registry, const SystemModel& model, const Start& guess,
                           int family = -1);
/// The same near the start of a run: also `speed(5)`, of systems that know such a motion.
SteadyMotion steady_motion(const Registry& registry, const Simulation& run, int family = -1);

/// Steady motions along a parameter.
struct SteadySweep {
  std::vector<double> values;
  std::vector<SteadyMotion> motions;
  struct Crossing {
    double value;
    bool pair;  // of complex eigenvalues; else a real one
  };
  std::vector<Crossing> crossings;  // where the number of unstable eigenvalues changes, to 1e-10
};
/// at(value, family) is the motion there.
SteadySweep sweep_steady(const std::vector<double>& values,
                         const std::function<SteadyMotion(double value, int family)>& at);

}  // namespace hamel
