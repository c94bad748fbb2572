// The equations of a system at any state, as numbers.
//
//   const hamel::Equations bicycle(hamel::simulate("bicycle"));
//   const hamel::Start state = {.configuration = {…}, .velocity = {…}};
//   bicycle.rate(0, state);                                  // xi' [n]
//   bicycle.inertia(state);                                  // I(g), n x n
//   bicycle.rows(state).a;                                   // A(g), k x n
//   bicycle.jacobian("rate", "velocity", state).values;      // d xi'/d xi, n x n
//
//   I(g) xi' = ad*_xi I(g) xi + f(t, g, xi) - (dI/dt) xi + A(g)^T lambda
//   A(g) xi = b(t, g),  A(g) xi' = db/dt - (dA/dt) xi,  phi(g) = 0
// Body velocities xi in the order and units of a run's columns. What is left out of a state is that
// of the run's start. Velocities need not satisfy the rows: xi' is what the equations give for
// them. Standard-library types only.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <hamel/framework/io/export.hpp>
#include <hamel/framework/io/number_matrix.hpp>
#include <hamel/framework/run/run/simulation.hpp>

namespace hamel {

struct MotionFormulas;
struct SystemModel;

/// Constraint rows at a state: A xi = b, and phi = 0 of the holonomic ones.
struct RowsOfState {
  std::vector<std::string> names;  // of their multipliers
  NumberMatrix a;                  // k x n
  std::vector<double> b, holonomic;
};

/// Derivatives of the components of a quantity (rows) along those of an argument (columns).
struct JacobianOfState {
  NumberMatrix values, errors;  // errors: of each, estimated
};

class HAMEL_API Equations {
 public:
  /// Equations of the system of a run, with its inputs. ConfigError as from its build(), and
  /// for a group that is not registered.
  explicit Equations(const Simulation& run);

  const std::string& name() const;
  /// Names of the coordinates of g, and of the n components of xi.
  const std::vector<std::string>& columns() const;
  const std::vector<std::string>& velocities() const;
  /// The admissible state with which the run starts.
  const Start& start() const;

  /// xi', n numbers.
  std::vector<double> rate(double t, const Start& state = {}) const;
  /// I(g), n x n.
  NumberMatrix inertia(const Start& state = {}) const;
  RowsOfState rows(const Start& state = {}, double t = 0) const;
  /// The multipliers lambda of the rows, k numbers.
  std::vector<double> reactions(const Start& state = {}, double t = 0) const;
  /// I(g) xi, n numbers.
  std::vector<double> momentum(const Start& state = {}) const;
  /// Kinetic and potential energy.
  double energy(const Start& state = {}) const;

  /// The equations as formulas of t, coordinates q, velocities xi and inputs u, parameters as
  /// numbers: "latex", "c", "numpy" or "sympy". Code has functions rate(t, q, xi, u), which gives
  /// xi' of admissible velocities as rate() does where inputs are held, and coordinate_rates(q,
  /// xi). ConfigError for another notation, and with the reason where the system has no recorded
  /// formulas.
  std::string formulas(const std::string& notation) const;
  static const std::vector<std::string>& notations();

  /// The quantities that have a jacobian, and what they have it of.
  static const std::vector<std::string>& quantities();
  std::vector<std::string> arguments() const;
  /// quantity: "rate", "momentum", "reactions", "energy"; of: "velocity", "configuration" (along
  /// g tau(e_j x), j = 1 to n), "time", a parameter or an input of the system. Of recorded
  /// formulas (formulas()) rates by all but parameters are exact derivatives, with their round-off;
  /// all others are extrapolated central differences, with their errors. ConfigError names what
  /// there is.
  JacobianOfState jacobian(const std::string& quantity, const std::string& of,
                           const Start& state = {}, double t = 0) const;

 private:
  const SystemModel& system() const;
  MotionFormulas recorded() const;
  std::optional<JacobianOfState> exact_jacobian(const std::string& of, const Start& at,
                                                double t) const;
  std::vector<double> quantity_at(const std::string& quantity, const Start& state, double t) const;
  std::vector<double> round_off_of(const std::string& quantity, const Start& state, double t) const;

  struct Insides;
  std::shared_ptr<Insides> insides_;
};

}  // namespace hamel
