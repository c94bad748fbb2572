// Optimisation problems over a chain of stages, as the stage solver sees them.
//
//   least    sum_k l_k(z_k, u_k)
//   subject  z_{k+1} = S_k(z_k, u_k),   k = 0 ... N-1
//            c_k(z_k, u_k) >= 0,   low_k <= u_k <= high_k,   goal(z_N) = 0
//            z_0 fixed but for the increments J w, w free (start_directions)
//
// A state is any list of numbers (matrices of a group, say); increments are numbers of its tangent
// space, and retract() applies them: z (+) e. All derivatives are by increments. Numbers that are
// the same at all stages (a step h, parameters) are components of the state with S = identity, free
// at the start; bounds on them are path rows of stage 0.
//
// A step may solve an implicit equation R(x; z, u) = 0: it is part of S, whose derivatives follow
// from the implicit function theorem ((12) of the design: F = S_z - S_x R_x^-1 R_z).
#pragma once

#include <vector>

#include <Eigen/Core>

namespace hamel {

struct StageSizes {
  int state = 0;   // increments of z_k
  int inputs = 0;  // u_k; of the last stage 0
  int path = 0;    // rows c_k >= 0
};

/// Values at one stage. Vectors come with their sizes.
struct StageValues {
  Eigen::VectorXd defect;  // d: z_{k+1} (+) d = S(z_k, u_k); of the last stage empty
  double cost = 0;         // l
  Eigen::VectorXd path;    // c
};

/// Derivatives by (increment of z_k, u_k), n + m of them. Matrices come with their sizes, as zero.
struct StageDerivatives {
  Eigen::MatrixXd F, B;           // of S, as increments at z_{k+1}: by z_k, by u_k
  Eigen::VectorXd cost_gradient;  // n + m
  /// Of l + lambda . S - y . c, symmetric, (n + m) x (n + m); Gauss-Newton: J^T J of the cost
  /// alone.
  Eigen::MatrixXd hessian;
  Eigen::MatrixXd path_jacobian;  // rows x (n + m)
};

struct StageProblem {
  virtual ~StageProblem() = default;
  /// N: states z_0 ... z_N, inputs u_0 ... u_{N-1}.
  virtual int stages() const = 0;
  virtual StageSizes sizes(int k) const = 0;

  /// out = state (+) increment. Usual: addition.
  virtual void retract(int /*k*/, const Eigen::VectorXd& state, const Eigen::VectorXd& increment,
                       Eigen::VectorXd& out) const {
    out = state + increment;
  }
  /// Bounds of u_k, filled with -inf and inf; low < high.
  virtual void bounds(int /*k*/, Eigen::VectorXd& /*low*/, Eigen::VectorXd& /*high*/) const {}

  /// False where the step has no solution (a search along a line then takes a shorter one). next:
  /// z_{k+1}; null of the last stage.
  virtual bool values(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                      const Eigen::VectorXd* next, StageValues& out) = 0;
  /// lambda: multipliers of z_{k+1} = S, a covector on its increments (empty of the last stage); y:
  /// those of the path rows, >= 0. Called where values() was true.
  virtual bool derivatives(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                           const Eigen::VectorXd* next, const Eigen::VectorXd& lambda,
                           const Eigen::VectorXd& y, StageDerivatives& out) = 0;

  /// Rows of goal(z_N) = 0; they may depend on each other.
  virtual int goals() const { return 0; }
  virtual void goal(const Eigen::VectorXd& /*last*/, Eigen::VectorXd& /*value*/) {}
  /// jacobian: goals x n. hessian: of nu . goal, n x n, comes as zero.
  virtual void goal_derivatives(const Eigen::VectorXd& /*last*/, const Eigen::VectorXd& /*nu*/,
                                Eigen::MatrixXd& /*jacobian*/, Eigen::MatrixXd& /*hessian*/) {}

  /// J, n_0 x (free directions); without columns the start is fixed.
  virtual Eigen::MatrixXd start_directions() const {
    return Eigen::MatrixXd::Zero(sizes(0).state, 0);
  }
};

/// States and inputs of all stages: a guess, or a solution.
struct StagePoint {
  std::vector<Eigen::VectorXd> states;  // N + 1
  std::vector<Eigen::VectorXd> inputs;  // N + 1, the last one empty
};

}  // namespace hamel
