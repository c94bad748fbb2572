// A problem over stages in other units, so that the solver's constants are those of numbers near 1.
//
//   z = z~ (+) D e,   u = U v,   defects D^-1 d,   rows c/R,   goals goal/G,   cost l/J
// D, sizes of the increments, come from whoever knows the problem. All others follow from it at a
// guess, and scale as it does where the units of lengths, masses, times or costs are changed:
//   U_i: so much of an input over a part p of all stages moves the
//     state by 1, p = kUnitTime:                                     1/(p sum_k |D^-1 B_k|_inf)
//   R_i: of the row, and its change by increments of size 1:         max_k (|c_k|, |c_k' D|_inf)
//   G_i: the same change, where no size is given:                    |goal' D|_inf
//   J: of the guess and of inputs of size 1:                         max(|sum l|, 1/2 sum l_uu U^2)
// of the input with the least such cost: one without an effect has a U of round-off. A size that is
// 0 there is 1.
#pragma once

#include <hamel/framework/stages/stage_problem.hpp>
#include <hamel/framework/stages/stage_solver.hpp>

namespace hamel {

/// Unit of time, as a part of all stages: motions from rest to rest turn within them.
constexpr double kUnitTime = 0.2;

struct StageScales {
  Eigen::VectorXd state;   // D, of all stages
  Eigen::VectorXd inputs;  // U
  Eigen::VectorXd path;    // R, of the stage with the most rows
  Eigen::VectorXd goal;    // G
  double cost = 1;         // J
};

/// At some of the stages of a guess. state: D; goal: G, 0 where it is to be found.
StageScales find_scales(StageProblem& problem, const StagePoint& guess,
                        const Eigen::VectorXd& state, const Eigen::VectorXd& goal);

/// The solution in the units of the problem, its residuals (kkt, defect, complement) in those of
/// the scales; the tolerance is of these.
StageSolution solve_scaled(StageProblem& problem, const StageScales& scales,
                           const StagePoint& guess, const StageOptions& options = {});

}  // namespace hamel
