// Solver of problems over stages: Newton's method on the conditions of first order, one Riccati
// sweep a step, an interior point for inequalities, multipliers with a proximal term for goals.
//
//   StageSolution plan = solve_stages(problem, guess);
//   if (plan.status == StageStatus::ok) use(plan.point.inputs);
//
// Sources: Bertsekas, Dynamic Programming and Optimal Control I, 4.1 (the sweep); Waechter and
// Biegler, Math. Program. 106 (2006) (barrier, fraction to the boundary, correction of inertia);
// Vanroye and others, FATROP, IROS 2023 (both on stages).
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/stages/stage_problem.hpp>

namespace hamel {

enum class StageStatus {
  ok,
  out_of_reach,  // goals or path rows cannot be met: the point misses them least
  failed
};

struct StageProgress {
  int iteration = 0;
  double objective = 0, kkt = 0, defect = 0, barrier = 0, step = 0;
};

struct StageOptions {
  double tolerance = 1e-10;  // of stationarity (relative to the multipliers), defects, rows
  int iterations = 300;      // at most
  double barrier = 0.1;      // the first one
  std::function<void(const StageProgress&)> progress = {};
  const std::atomic<bool>* stop = nullptr;  // ends as failed, with the point so far
};

struct StageSolution {
  StageStatus status = StageStatus::failed;
  std::string reason;  // unless ok
  StagePoint point;
  double objective = 0;   // sum of l
  double kkt = 0;         // largest derivative of the Lagrangian
  double defect = 0;      // largest of all defects, goals, violations of rows
  double complement = 0;  // largest product of a row and its multiplier
  int iterations = 0, sweeps = 0;

  /// lambda_k, a covector on increments of z_k: the derivative of the least cost by them, the
  /// discrete adjoint. lambda_0: of the start.
  std::vector<Eigen::VectorXd> multipliers;
  Eigen::VectorXd goal_multipliers;  // nu: lambda_N = l_N' + C^T nu - ...
  /// Of c_k >= 0, of u_k >= low, of u_k <= high: >= 0.
  std::vector<Eigen::VectorXd> path_multipliers, low_multipliers, high_multipliers;
  Eigen::VectorXd missed;  // goal(z_N)
  double path_missed = 0;  // largest violation of a path row
  int path_missed_at = -1, path_missed_row = -1;

  /// Hessian of the least cost by w: of a fit the information matrix, its inverse the covariance.
  Eigen::MatrixXd start_information;
  /// u = u_k + K_k dz: the linear feedback of second order along the solution.
  std::vector<Eigen::MatrixXd> gains;
};

/// The guess need not satisfy anything; inputs are moved inside their bounds. Throws
/// std::invalid_argument where its sizes do not fit the problem.
StageSolution solve_stages(StageProblem& problem, const StagePoint& guess,
                           const StageOptions& options = {});

}  // namespace hamel
