// The linearisation of a system about a steady motion, for control: x' = A x + B u, y = y0 + C x.
//
// The states x are perturbations (delta, nu) of the steady motion that keep phi = 0 and A xi = b,
// those along its symmetries divided out: g = g0 exp(delta), xi = xi0 + nu, (delta, nu) = embedding
// x. Each state is itself one of these 2n numbers: "steer.angle" or "delta.w1", "steer.rate". The
// speeds along a family of steady motions are among them, positions that do not matter are not.
// Inputs are efforts and forces; the quantities y are the columns of a run that no symmetry
// changes. Between samples a time h apart with u held, x' = exp(A h) x + integral of exp(A t) B dt
// u. Standard-library types only.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/framework/io/export.hpp>
#include <hamel/framework/io/number_matrix.hpp>

namespace hamel {

struct DiscretePair {
  NumberMatrix a, b;
};

struct HAMEL_API Linearisation {
  SteadyMotion motion;
  std::vector<std::string> states, inputs, quantities;
  NumberMatrix a, b, c;                    // x' = a x + b u, y = values + c x
  NumberMatrix a_error, b_error, c_error;  // of each entry
  std::vector<double> values;              // the quantities of the steady motion
  NumberMatrix embedding;                  // 2n rows: (delta, nu) of x
  std::vector<std::string>
      unused;  // inputs that drive rates, not efforts: they change what x may be
  std::vector<int> quantity_columns;  // of each quantity: a coordinate, or n behind them a velocity

  /// x(t + h) = a x + b u, u constant in between; h in seconds.
  DiscretePair sampled(double h) const;
  /// The states of a state of a run, to first order: the least x whose quantities are nearest to
  /// its own. ConfigError where quantities do not determine the states.
  std::vector<double> state(std::span<const double> coordinates,
                            std::span<const double> velocity) const;
};

/// About the steady motion near the start of a run; its inputs are zero. ConfigError where there is
/// none.
HAMEL_API Linearisation linearisation(const Registry& registry, const Simulation& run);

}  // namespace hamel
