// The one interface between a scheme's equation F(x) = 0 and an implicit-equation solver.
//
// Newton is compiled into the kernels (solvers/newton.hpp). Every other solver, a user's own too,
// crosses these two small classes; all are judged by the same residual |F(x)| / scale.
#pragma once

#include <span>

#include <hamel/framework/loop/status.hpp>

namespace hamel {

/// F: R^size -> R^size with its Jacobian (column-major, size x size).
class Equation {
 public:
  virtual ~Equation() = default;
  virtual int size() const = 0;
  /// The size of the terms that F balances: a residual is reported relative to it.
  virtual double scale() const = 0;
  /// F(x); and dF/dx when jacobian is not empty.
  virtual void evaluate(std::span<const double> x, std::span<double> f,
                        std::span<double> jacobian) const = 0;
  /// How often F is evaluated for F with its Jacobian: more than once where that is made of
  /// differences.
  virtual int jacobian_cost() const { return 1; }
};

/// Improves x until |F(x)| <= tolerance * scale. Judged by the residual at the x it leaves behind.
class Solver {
 public:
  virtual ~Solver() = default;
  virtual SolveReport solve(const Equation& equation, std::span<double> x, double tolerance) = 0;
};

}  // namespace hamel
