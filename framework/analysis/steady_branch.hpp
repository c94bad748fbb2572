// A branch of steady motions along a parameter, followed by a predictor along its tangent and
// Newton's method. For steady_sweep.cpp, steady_crossings.cpp; not installed.
//
// Unknowns z = (delta, nu) and q = value / scale. On the branch F(z, q) = 0, and its tangent (z',
// q') solves F_z z' + F_q q' = 0 (least norm, the symmetries divided out); F_q by differences of
// systems beside the value. At a given value Newton's method starts from z + z' dq. The step is
// halved until the trapezium rule holds on it: what Newton's method corrects is dq/2 times the
// change of the tangent, up to a quarter. A correction onto another branch has none of that. Along
// a family of steady motions, where Newton's method has its choice, only the size of the correction
// is held. At a fold q' = 0; past it the branch is followed by its length: Newton's method across
// the tangent.
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
  Vector tangent;  // (z', q'), of length 1
};

class Branch {
 public:
  using System = std::function<Simulation(double value)>;
  /// Between two values, which may be any way round.
  Branch(const Registry& registry, System at, double first, double last);

  std::shared_ptr<const SteadyEquations> equations(double value);
  bool held() const { return held_; }
  double scale() const { return scale_; }

  /// Near the start of at(value).
  std::optional<BranchNode> start(double value);
  /// The node at another value, by as many steps as it needs; here: the last node reached.
  std::optional<BranchNode> advance(const BranchNode& from, double value, BranchNode& here);
  std::optional<BranchNode> advance(const BranchNode& from, double value);
  /// The point where the branch turns back, between a node that advance() could not leave and a
  /// value, and a node behind it.
  struct Turn {
    BranchNode at, behind;
    double round_off;
  };
  std::optional<Turn> turn(const BranchNode& from, double value);
  /// From a node by v and what Newton's method adds across it; v of 2n + 1 numbers.
  std::optional<BranchNode> beside(const BranchNode& from, const Vector& v);
  /// F_q there.
  Vector by_value(const BranchNode& at);
  /// A node of this point: with its tangent, the least of those that are 1 along a vector.
  BranchNode node(double value, SteadyPoint point, const Vector& sense);

 private:
  std::optional<BranchNode> step_to(const BranchNode& from, double value);
  BranchNode level(const BranchNode& here, double length, double behind);

  const Registry& registry_;
  System at_;
  double scale_;
  bool held_ = false;
  Vector along_;  // the direction in which momentum is held, the same at all values
  std::map<double, std::shared_ptr<const SteadyEquations>> known_;
};

}  // namespace hamel::reduced
