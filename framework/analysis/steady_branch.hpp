// A branch of steady motions along a parameter, followed by a predictor along its tangent and
// Newton's method. For steady_sweep.cpp, steady_crossings.cpp; not installed.
//
// Unknowns z = (delta, nu), in the system's own units (state_units.hpp), and q = value / scale. On
// the branch F(z, q) = 0, and its tangent (z', q') solves F_z z' + F_q q' = 0 (least norm, the
// symmetries divided out); F_q by differences of systems beside the value. At a given value
// Newton's method starts from z + z' dq. The step is halved until the trapezium rule holds on it:
// what Newton's method corrects is dq/2 times the change of the tangent, up to a quarter. A
// correction onto another branch has none of that. Along a family of steady motions, where Newton's
// method has its choice, only the size of the correction is held. At a fold q' = 0; past it the
// branch is followed by its length, in a metric in which z and q change equally where the fold came
// into view: Newton's method across the tangent (steady_turn.cpp).
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>

#include <hamel/framework/analysis/steady_equations.hpp>

namespace hamel::reduced {

struct BranchNode {
  double value = 0;
  SteadyPoint point;
  Vector tangent;         // (z', q') in the metric, of length 1
  Eigen::Index rank = 0;  // of (F_z, F_q)
};

class Branch {
 public:
  using System = std::function<Simulation(double value)>;
  /// Between two values, which may be any way round.
  Branch(const Registry& registry, System at, double first, double last);

  std::shared_ptr<const SteadyEquations> equations(double value);
  bool held() const { return held_; }
  double scale() const { return scale_; }
  const StateUnits& scales() const { return scales_; }

  /// Near the start of at(value).
  std::optional<BranchNode> start(double value);
  /// The node at another value, by as many steps as it needs; here: the last node reached.
  std::optional<BranchNode> advance(const BranchNode& from, double value, BranchNode& here);
  std::optional<BranchNode> advance(const BranchNode& from, double value);
  /// The point where the branch turns back, between a node that advance() could not leave and a
  /// value, and nodes before and behind it; or, where it does not turn, a node past the value.
  struct Turn {
    bool turns;
    BranchNode before, at, behind;
    double round_off = 0;
    double place_error = 0;  // of `at` along the branch, relative to the distance of the nodes
  };
  std::optional<Turn> turn(const BranchNode& from, double value);
  /// The node of this point, with its tangent.
  BranchNode node(double value, SteadyPoint point);
  /// The eigenvalues there, with the error of the motion itself in theirs.
  SteadyMotion motion(const BranchNode& at, int family);

 private:
  // Units of z and of q in which lengths are measured.
  struct Metric {
    Vector z;
    double q;
  };
  Metric own_metric() const { return {scales_.columns, scale_}; }
  Metric metric_at(const BranchNode& node) const;
  // (F_z, F_q) beside the carriers, over one row for a step, in a metric.
  Matrix slope(double value, const SteadyPoint& point, const Metric& metric, const Vector& across);
  BranchNode node(double value, SteadyPoint point, const Vector& sense, const Metric& metric);
  std::optional<BranchNode> beside(const BranchNode& from, const Vector& step,
                                   const Metric& metric);
  std::vector<BranchNode> nodes_over(const BranchNode& here, double length, const Metric& metric);
  struct Stationary {
    double place, value;
  };
  Stationary stationary(const std::vector<BranchNode>& nodes, double guess,
                        const Vector& places) const;
  std::optional<Turn> turn_at(const BranchNode& here, double length, const Metric& metric);
  // F_q there, q = value / scale.
  Vector by_value(double value, const SteadyPoint& point);
  std::optional<BranchNode> step_to(const BranchNode& from, double value);

  const Registry& registry_;
  System at_;
  double scale_;
  bool held_ = false;
  Vector along_;  // the direction in which momentum is held, the same at all values
  StateUnits scales_;
  std::map<double, std::shared_ptr<const SteadyEquations>> known_;
  std::shared_ptr<const SteadyEquations> neighbour_;  // the last one made
};

}  // namespace hamel::reduced
