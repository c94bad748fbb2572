// F/scale as solvers see it: every evaluation counted, the best point kept, and the certificate
// made once.
//
// The report of a library ("converged", "round-off limited") is ignored. A solve is judged by
// the residual |F(x)|/scale that was evaluated at the x it leaves. Its target is that of Newton
// (solvers/newton.hpp): two digits below the tolerance, and at least one point other than the
// guess, whose extrapolation error, always of one sign, would else stay in every step.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <hamel/framework/loop/solver.hpp>

namespace hamel {

class ScaledEquation final : public Equation {
 public:
  static constexpr double round_off = 64 * std::numeric_limits<double>::epsilon();

  // No other object may need the vtable (tools/cmake/localise).
  ScaledEquation();
  ~ScaledEquation() override;

  /// Begins a solve. patience: evaluations without a residual half as large, after which a point
  /// within the tolerance is good enough.
  void start(const Equation& equation, std::span<const double> guess, double tolerance,
             int patience = 3);

  int size() const override { return size_; }
  double scale() const override { return 1; }
  /// F/scale, and its Jacobian when jacobian is not empty.
  void evaluate(std::span<const double> x, std::span<double> f,
                std::span<double> jacobian) const override;

  /// Nothing more is to be gained: a library that can be stopped should be.
  bool reached() const;
  bool finite() const { return finite_; }  // the last value
  double target() const { return target_; }
  int evaluations() const { return evaluations_; }
  /// |F|/scale at the best point so far, and that point.
  double residual() const { return std::sqrt(best_); }
  std::span<const double> best() const { return best_x_; }

  /// Leaves the best point in x. otherwise: the reason when its residual is above the tolerance.
  SolveReport finish(std::span<double> x, int iterations,
                     Reason otherwise = Reason::stagnated) const;

 private:
  const Equation* equation_ = nullptr;
  int size_ = 0, patience_ = 0;
  double inverse_scale_ = 1, tolerance_ = 0, target_ = 0, target_square_ = 0;
  std::vector<double> guess_;
  // Results of the evaluations; residuals as squares.
  mutable std::vector<double> best_x_;
  mutable double best_ = 0, halved_ = 0;
  mutable int evaluations_ = 0, calls_ = 0, halved_at_ = 0;
  mutable bool moved_ = false, finite_ = true;
};

}  // namespace hamel
