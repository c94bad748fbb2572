// A plan as a problem over stages. Not installed.
//
// State of a stage: (coordinates, xi), and the step h where the end time is free; its increments
// (eta, dy, dh). All derivatives are differences of the step's own map over increments of one
// stage, never of a chain of steps. Where the equation of the step is recorded (recorded_lift.hpp)
// its derivatives are exact. Others are central, of order 6, at distance delta,
//   f' = (45 (f1 - f-1) - 9 (f2 - f-2) + (f3 - f-3))/(60 delta),
// and for Hessians, which only steer Newton's method, of order 2 at 3 delta.
//
// Sizes (state_scales) make the problem one of numbers near 1 in any units of length, mass and
// time (stages/scaled_stages.hpp). T: kUnitTime of the duration, s_i of eta_i: 1 for angles, the
// radius of gyration for lengths (mechanics/natural_units.hpp); dy is a root of an energy, sqrt(e),
// e = max I_ii (s_i/T)^2. Where a system has no angles, e is that of the ways and velocities which
// the plan states, e = max(|eta|_I^2/T^2, |xi_0|_I^2, |xi_N|_I^2), and s_i = T sqrt(e/I_ii).
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/inverse/recorded_path.hpp>
#include <hamel/framework/stages/scaled_stages.hpp>
#include <hamel/framework/stages/stage_problem.hpp>
#include <hamel/framework/tangent/recorded_lift.hpp>
#include <hamel/framework/tangent/step_map.hpp>

namespace hamel {

/// A number of a state at a time.
using StateNumber = std::function<double(double t, std::span<const double> coordinates,
                                         std::span<const double> velocity)>;

/// StateNumber, and as a formula of recorded numbers where it is one.
struct StateFormula {
  StateNumber value;  // may be empty
  RecordedNumber record;
  explicit operator bool() const { return value != nullptr; }
};

struct PlanGoal {
  std::string name;
  int place = 0;  // in the state
  double value = 0;
};

class PlanStages final : public StageProblem {
 public:
  explicit PlanStages(StepMap of_run)
      : map(std::move(of_run)),
        equation_(RecordedLift::of(map.plan(), RecordedLift::Order::second)) {}

  mutable StepMap map;  // retract() uses its work space
  int steps = 0;
  double from = 0, step = 0;  // of a fixed end time
  bool free_time = false;
  double least_step = 0, most_step = 0;
  double time_weight = 0;
  Eigen::VectorXd weights, low, high;   // of inputs
  StateFormula running, terminal;       // may be empty
  std::vector<StateFormula> path;       // >= 0 at all states but the first
  std::vector<std::string> path_names;  // "v1 <= 0.6"
  std::vector<PlanGoal> goal_rows;
  /// The group's columns are more than its dimension, and all are given: goal by tau^-1.
  std::optional<MotionState> goal_place;
  Eigen::VectorXd state_scales;  // of increments
  Eigen::VectorXd input_scales;  // that give the start such a velocity in T

  int stages() const override { return steps; }
  StageSizes sizes(int k) const override;
  void retract(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& increment,
               Eigen::VectorXd& out) const override;
  void bounds(int k, Eigen::VectorXd& low_inputs, Eigen::VectorXd& high_inputs) const override;
  bool values(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
              const Eigen::VectorXd* next, StageValues& out) override;
  bool derivatives(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                   const Eigen::VectorXd* next, const Eigen::VectorXd& lambda,
                   const Eigen::VectorXd& y, StageDerivatives& out) override;
  int goals() const override;
  void goal(const Eigen::VectorXd& last, Eigen::VectorXd& value) override;
  void goal_derivatives(const Eigen::VectorXd& last, const Eigen::VectorXd& nu,
                        Eigen::MatrixXd& jacobian, Eigen::MatrixXd& hessian) override;
  Eigen::MatrixXd start_directions() const override;

  std::string row_name(int row) const;
  double step_of(const Eigen::VectorXd& state) const;
  double time_of(int k, const Eigen::VectorXd& state) const { return from + k * step_of(state); }
  /// Both, by the way to the goal and the velocity there.
  void set_scales(const Eigen::VectorXd& way, const Eigen::VectorXd& last_velocity);
  /// Of velocities, which may be fixed by a row; 0 of coordinates, which increments move.
  Eigen::VectorXd goal_scales() const;
  /// Are the steps of this point those of the run itself?
  bool repeats(const StagePoint& point);
  /// From now on no step is solved by its recorded equation.
  void take_steps_of_run_alone() { equation_.reset(); }
  const SystemModel& system() const { return *map.plan().system; }
  /// The numbers of a motion within a stage's state, and back.
  Eigen::VectorXd numbers(const MotionState& state) const;
  MotionState motion_state(double t, const Eigen::VectorXd& state) const;
  void set_motion_state(double t, const Eigen::VectorXd& state, MotionState& out) const;
  int state_increments() const { return map.increments() + (free_time ? 1 : 0); }

 private:
  void find_input_scales(const MotionState& at, double acceleration);
  int numbers_of_motion() const { return map.coordinate_count() + map.velocities(); }
  int path_rows(int k) const;
  bool take_step(int k, const MotionState& from, double h, MotionState& to);
  // Path and cost of a stage, without its step.
  void state_values(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs, bool last,
                    Eigen::VectorXd& out) const;
  bool has_formulas(int k) const;
  // Of the step, by its equation; false where that has none. Path and cost alone.
  bool step_derivatives(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                        const Eigen::VectorXd& next, const Eigen::VectorXd& lambda,
                        StageDerivatives& out);
  // Derivatives by q of the equation of a step, to those by the increments of a stage.
  void by_increments(int k, const Eigen::MatrixXd& basis, const Eigen::MatrixXd& by_q,
                     Eigen::MatrixXd& out) const;
  bool state_derivatives(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                         bool last, const Eigen::VectorXd& y, StageDerivatives& out);
  // Of path and cost, by their recorded formulas; false where they have none.
  bool formula_derivatives(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                           bool last, const Eigen::VectorXd& y, StageDerivatives& out);
  // All numbers of a stage: defect, path, cost.
  bool all_values(int k, const Eigen::VectorXd& state, const Eigen::VectorXd& inputs,
                  const Eigen::VectorXd* next, Eigen::VectorXd& out);
  bool goal_values(const Eigen::VectorXd& last, Eigen::VectorXd& out);
  // Jacobian and contracted Hessian of values(increment) by differences.
  using Values = std::function<bool(const Eigen::VectorXd& increment, Eigen::VectorXd& out)>;
  static bool differentiate(const Values& values, const Eigen::VectorXd& delta,
                            const Eigen::VectorXd& weights, Eigen::MatrixXd& jacobian,
                            Eigen::MatrixXd& hessian);
  Eigen::VectorXd deltas(const Eigen::VectorXd& state, const Eigen::VectorXd& inputs) const;

  std::unique_ptr<RecordedLift> equation_;        // null where it is not recorded
  std::vector<RecordedLift::Unknowns> unknowns_;  // of each stage
  struct Recorded {                               // path, then the cost's formula
    bool tried = false;
    std::unique_ptr<RecordedPath> formulas;
  };
  Recorded at_stages_, at_last_;
  mutable MotionState here_, moved_;
  MotionState next_, there_;
  Eigen::VectorXd all_, beside_, difference_, pulled_;
  Eigen::MatrixXd slopes_, half_;
};

}  // namespace hamel
