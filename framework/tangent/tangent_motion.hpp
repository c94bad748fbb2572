// A motion with its derivatives by variables: a product of the tangents of its steps. Not
// installed.
//
//   (eta, dxi)_{k+1} = D_z Psi (eta, dxi)_k + D_p Psi,     z_{k+1} = Psi(z_k; p, h_k)
// dg = g eta^, left-trivialised; Psi is the map of an accepted step, h_k frozen. D_z Psi is exact
// where the equation of the step is recorded (recorded_lift.hpp). Other derivatives are differences
// of this map (step_differences.hpp), never of the run: a finite displacement does not grow along
// the motion. Psi is defined beside the constraints of p too, where a kernel begins
// with the admissible part of a velocity; a kernel that does not is given the state projected onto
// them, Psi_p(Pi_p z), by z and by p alike.
//   An event gamma = 0 that changes the state by z+ = D(z; p) happens earlier or later beside the
// motion, dt = -(gamma_z Z + gamma_p)/gamma', Z the columns before it, f the rates of the state:
//   Z+ = D_z (Z + f- dt) + D_p + D_t dt - f+ dt,    gamma' = gamma_t + gamma_z f-
// and one that ends the run ends it at another time, Z+ = Z + f- dt. Source: Leine, Nijmeijer,
// Dynamics and Bifurcations of Non-Smooth Mechanical Systems (2004), chapter 7.
//   The error is measured: a second set of columns is carried with coarser differences, also where
// the first is exact. Where ten digits will do, differences are plain.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <hamel/framework/tangent/moved_motion.hpp>
#include <hamel/framework/tangent/recorded_lift.hpp>

namespace hamel {

/// The motion at other values of one variable: at value + size parts[i], and -.
struct MovedPair {
  std::unique_ptr<MovedMotion> plus, minus;
};
struct MovedVariable {
  double size = 0;
  std::array<MovedPair, 3> pairs;  // of ThreeDifferences::parts; empty: the start alone moves, or
                                   // this part is not needed
  bool moves_system() const { return pairs.back().plus != nullptr; }
};

/// A state and the columns (eta; dxi) by each variable.
struct TangentState {
  MotionState state;
  Eigen::MatrixXd columns;  // 2n x q
  Eigen::MatrixXd coarse;   // the second set; empty where no errors are measured
  Eigen::RowVectorXd time;  // of the state, where an event ended the run; else empty
};

class TangentMotion {
 public:
  /// The motion alone, with its columns, about ten digits of them or all, or with both sets.
  enum class Carries { values, ten_digits, columns, errors };
  /// ConfigError where a motion of these values cannot be made.
  TangentMotion(const std::string& what, const MotionVariables& variables,
                const Eigen::VectorXd& values, Carries carries);

  /// Steps to t, beyond the last one: chosen steps end there, of others a shorter one, from which
  /// the next do not go on.
  Status advance_to(double t);
  /// Has an event ended the run before that?
  bool over() const { return run_.over(); }
  /// At the last t, or where the run ended.
  const TangentState& now() const { return side_ ? shown_ : node_; }
  /// Values of a state, and their derivative along each variable, rows x q. f(motion, state, out):
  /// a function of the state, and of the parameters of the motion.
  using Function = std::function<void(MovedMotion&, const MotionState&, Eigen::VectorXd&)>;
  bool derivative(const TangentState& at, const Function& f, Eigen::VectorXd& here,
                  Eigen::MatrixXd& out);

  MovedMotion& motion() { return motion_; }
  /// Natural changes of the variables: a parameter's own size, a start's by displacement_units().
  const Eigen::VectorXd& sizes() const { return sizes_; }
  /// A displacement (eta; dxi) of a state in natural units.
  double natural_length(const MotionState& at, const Eigen::VectorXd& column) const {
    return length_of(at, column, run_.driver().next_step());
  }
  int steps() const { return steps_; }

  /// Columns that are not those of the variables: of a state, one for each.
  void begin_with(const Eigen::MatrixXd& columns);

 private:
  // The largest displacement of a difference, in natural units, and the weights of its parts.
  double largest() const;
  const std::array<double, 3>& weights() const;
  double length_of(const MotionState& at, const Eigen::VectorXd& column, double h) const;
  double size_of(const MotionState& at, const Eigen::VectorXd& column, double h) const;
  double natural_change(const MotionVariable& one, const Eigen::VectorXd& direction) const;
  double change_of_zero(const std::string& what, const MotionVariables& variables,
                        Eigen::VectorXd values, Eigen::Index at);
  void move_variable(const std::string& what, const MotionVariables& variables,
                     const Eigen::VectorXd& values, size_t i);
  void begin(const MotionVariables& variables, const Eigen::VectorXd& values);
  Status step(const TangentState& from, double t, TangentState& to, const MotionState* known,
              bool by_dense_output = false);
  // A step of a motion as a displacement from `to`.
  bool step_beside(MovedMotion& motion, const MotionState& from, const MotionState& to,
                   Eigen::VectorXd& by);
  // Finds D_z Psi of a step by its equation; false where it has none, or another root.
  bool solve_equation(const MotionState& from, const MotionState& to);
  // The last step of the run, and the event that ended it or changed its state there.
  Status follow();
  Status cross(const EventMet& met, TangentState& there, const MotionState* behind);
  bool cross_columns(const EventMet& met, TangentState& there, const MotionState* behind,
                     const Eigen::VectorXd& rate_before, const Eigen::VectorXd& rate_behind,
                     Eigen::MatrixXd& columns);
  bool rate_at(const MotionState& state, Eigen::VectorXd& out);
  bool misses_event(double t);
  bool push(const TangentState& from, const MotionState& to, const std::array<double, 3>& weights,
            bool exact, const Eigen::MatrixXd& columns, Eigen::MatrixXd& out);

  MovedMotion motion_;
  std::vector<MovedVariable> moved_;
  Run run_;              // itself: it chooses the steps and meets events
  std::size_t met_ = 0;  // of its events
  long impacts_ = 0;
  std::unique_ptr<RecordedLift> equation_;
  RecordedLift::Unknowns unknowns_;
  Eigen::VectorXd units_;  // of displacements
  Eigen::VectorXd sizes_;  // of the variables
  TangentState node_, shown_;
  std::string failure_;  // of a step beside the motion
  bool side_ = false, measure_, plain_, projects_ = false;
  int steps_ = 0;
};

}  // namespace hamel
