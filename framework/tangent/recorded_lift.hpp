// The equation of a step of lift as recorded programs: its solution and its derivatives, exact to
// round-off. Not installed.
//
// For systems whose formulas are recorded (run/data/recorded_formulas.hpp) on groups of exp and
// cayley.
// With multipliers in place of a frame, all that a step determines is x = (xi_0, alpha; v, lambda;
// xi_1, kappa) of
//   I(g0) (xi_0 - w) = A(g0)^T alpha,          A(g0) xi_0 = b(t, g0)
//   mu0 - I(g0) xi_0 - h/2 F0 = A(g0)^T lambda,   A(g) v = b(t + s h, g),  phi(g1) = 0
//   I(g1) xi_1 - mu1 - h/2 F1 = A(g1)^T kappa,   A(g1) xi_1 = b(t + h, g1)
// with mu0, mu1, g, g1 and forces as in schemes/lift.hpp, g0 = g tau(eta). R(x; q) = 0, q = (eta,
// w, u, h, t); z+ = S(x; q) = (tau^-1(g_ref^-1 g1), xi_1). With L = lambda . S + rho . R:
//   dx = X dq,  X = -R_x^-1 R_q,   dz+ = (S_q + S_x X) dq
//   rho = -R_x^-T S_x^T lambda,    d^2 (lambda . z+) = [X; 1]^T L'' [X; 1]
// Each pair is of its own unknowns and those of pairs before it: R_x has no blocks above its
// diagonal. The first pair, the velocity's projection onto the rows at g0, is left out where I and
// A are constant and b = 0.
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/run/data/recorded_formulas.hpp>
#include <hamel/framework/tangent/block_factors.hpp>
#include <hamel/framework/tangent/recorded_geometry.hpp>
#include <hamel/framework/tangent/step_map.hpp>

namespace hamel {

class RecordedLift {
 public:
  /// Derivatives that are recorded.
  enum class Order { first, second };
  /// Null where the step of this run is not such an equation.
  static std::unique_ptr<RecordedLift> of(const RunPlan& plan, Order order);

  /// Sizes of displacements, by which solutions are judged; at first natural_units().
  void set_units(const Eigen::VectorXd& units) { units_ = units; }

  /// Unknowns of a step, kept by whoever takes it: the next solution begins at the last one.
  using Unknowns = Eigen::VectorXd;

  /// A step from there with constant inputs; its solution is kept for derivatives. False where it
  /// is not found.
  bool solve(const MotionState& from, const Eigen::VectorXd& inputs, double h, Unknowns& x);
  /// The end of the step solved last; false outside the domain of tau.
  bool end(MotionState& to) const;

  /// Derivatives of the step solved last, as (eta, dxi) at g_ref, by q: 2n x (2n + inputs + 2).
  /// g_ref: coordinates, near the end. False where there are none.
  bool linearise(std::span<const double> reference);
  /// The same of a step that has been solved before, whose solution is x.
  bool linearise(const MotionState& from, const Eigen::VectorXd& inputs, double h, Unknowns& x,
                 std::span<const double> reference);
  const Eigen::MatrixXd& jacobian() const { return jacobian_; }
  /// Second derivatives of lambda . z+ by q, behind linearise(), of a lift of second order.
  const Eigen::MatrixXd& hessian(const Eigen::VectorXd& lambda);
  int parameters() const { return static_cast<int>(2 * n_ + inputs_ + 2); }

 private:
  struct Sparse {  // a matrix of a program's outputs
    struct Entry {
      Eigen::Index row, column;
      std::size_t output;
    };
    std::vector<Entry> entries;
  };
  // Programs of one branch of every formula: the outcome of each comparison is a guard.
  struct Record {
    std::vector<bool> guards;
    std::unique_ptr<graph::Code> equation, first, second;
    Sparse equation_by_x, by_x, by_q, end_by_x, end_by_q, curvature;
  };
  using Which = std::unique_ptr<graph::Code> Record::*;
  friend class LiftRecording;
  RecordedLift() = default;
  bool record();
  void set(const MotionState& from, const Eigen::VectorXd& inputs, double h, const Unknowns& x);
  bool linearise();
  void find_correction();
  bool is_small(double size) const;
  bool holds(std::size_t at, Which which);
  bool evaluate(Which which);
  void clear_matrices();
  double* input(std::size_t at) { return in_.data() + at; }

  const RunPlan* plan_ = nullptr;
  RecordedFormulas formulas_;
  std::shared_ptr<const RecordedGeometry> geometry_;
  std::size_t n_ = 0, k_ = 0, held_ = 0, inputs_ = 0, columns_ = 0, unknowns_ = 0;
  bool projects_ = false, curved_ = false;
  // Where the inputs of the programs begin.
  struct Places {
    std::size_t from, reference, w, u, h, t, eta, zero, x, lambda, rho, all;
  } at_ = {};
  std::vector<std::unique_ptr<const Record>> records_;  // the one in use last
  bool no_more_ = false;                                // records can be made
  std::vector<double> in_, out_, work_;
  BlockFactors factors_;
  Eigen::MatrixXd r_x_, s_x_, way_, slopes_, jacobian_, half_, hessian_;  // way_: X^T
  Eigen::VectorXd step_, rho_, row_, units_;
  mutable Eigen::VectorXd z_, g_, part_;
};

}  // namespace hamel
