// Newton's method on the conditions of first order of a problem over stages, for hard goals or with
// goals and path rows as costs.
//
//   hard:     goal(z_N) = 0 with multipliers nu; each step solves goal + C dz = rho (nu+ - nu), so
//             that rows which depend on each other do no harm
//   elastic:  w/2 |goal|^2 + w/2 |what path rows lack|^2 in the cost
//
// One step: derivatives at the multipliers so far, condensed rows, the sweep with an inertia that
// is corrected until every Hessian of inputs is positive, a search along the line for the merit
//   cost - mu sum log s + pi (|defects| + |c - s| + |goal|)_1
// that may rise over the last few iterates (Grippo, Lampariello and Lucidi 1986): else a curved
// constraint would cut steps next to the solution.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/stages/interior_rows.hpp>
#include <hamel/framework/stages/linear_stages.hpp>
#include <hamel/framework/stages/stage_problem.hpp>
#include <hamel/framework/stages/stage_solver.hpp>

namespace hamel {

class StageNewton {
 public:
  enum class End { solved, stuck, stopped };

  /// Throws std::invalid_argument where the sizes of the guess do not fit.
  StageNewton(StageProblem& problem, const StageOptions& options, const StagePoint& guess);

  /// weight: w; 0: hard goals. From the point so far, with fresh multipliers of rows.
  End iterate(double weight);
  /// nu to begin hard goals with.
  void goal_multipliers(Eigen::VectorXd nu) { nu_ = std::move(nu); }

  const Eigen::VectorXd& goal() const { return now_.goal; }
  const std::string& reason() const { return reason_; }
  int iterations() const { return iterations_; }
  /// Largest of goals and violations of path rows.
  double missed() const;
  /// Is the point, which is solved, a minimum, not a saddle?
  bool is_least();
  /// Begins anew at another point.
  void restart(const StagePoint& guess);
  void fill(StageSolution& out);

 private:
  struct Values {
    StagePoint point;
    std::vector<StageValues> stages;
    Eigen::VectorXd goal;
    double cost = 0;
  };
  struct Residuals {
    double kkt = 0, defect = 0, complement = 0, scale = 1;
    double worst() const { return std::max({kkt / scale, defect, complement}); }
  };
  struct Merit {
    double cost = 0, infeasible = 0;  // with the barrier; in the 1-norm
  };
  struct StageRows {
    InteriorRows path, bounds;
    Eigen::MatrixXd bound_jacobian;  // rows of bounds by (z, u)
    Eigen::VectorXd bound_offset;    // c = J u + offset
    Eigen::VectorXd bound_values, dx;
    int lows = 0;  // first rows are u - low
  };

  void resize(const StagePoint& guess);
  void set_bounds(int k);
  void start_rows();
  bool evaluate(Values& at);
  bool differentiate();
  Residuals residuals();
  void stage_residual(size_t k, Residuals& out);
  void lower_barrier(const Residuals& r);
  void assemble();
  bool find_direction(double least_delta);
  double longest_primal() const;
  double slope() const;
  Merit merit(const Values& at, double length) const;
  void raise_penalty(double slope, double infeasible);
  bool search(double& length);
  void accept(double length);
  bool step();
  bool stagnates(double defect);
  End give_up(const std::string& reason);
  void report(const Residuals& r, double length) const;
  void bound_values(size_t k, const Eigen::VectorXd& inputs, Eigen::VectorXd& out) const;

  StageProblem& problem_;
  const StageOptions& options_;
  size_t last_;  // N
  std::vector<StageSizes> sizes_;
  Values now_, trial_;
  std::vector<StageRows> rows_;
  std::vector<StageDerivatives> derivatives_;
  Eigen::MatrixXd goal_jacobian_, goal_hessian_;
  LinearStages linear_;
  std::vector<Eigen::VectorXd> lambda_;
  Eigen::VectorXd nu_, next_lambda_, gradient_;
  double weight_ = 0, mu_ = 0, penalty_ = 1, delta_ = 0, unit_delta_ = 1;
  double least_defect_ = 0;
  int since_least_ = 0, iterations_ = 0, sweeps_ = 0;
  bool has_rows_ = false;
  Residuals residuals_;
  std::vector<Merit> history_;
  std::string reason_;
};

}  // namespace hamel
