// A step of lift (framework/schemes/lift.hpp) with s = 1/2, Cayley's map and forces at the nodes,
// as recorded programs.
//
// A node carries what the next step needs of the place, in a frame E of the admissible velocities:
// the moving entries of E, E^T mu = E^T I xi, E^T f of the forces that do not depend on the
// velocity. At the middle of a step, which depends on some velocities alone (turning joints, a free
// root's turning), the rows A v = b are eliminated with pivots among the other velocities, so that
// v is explicit in x, the velocities without a pivot:
//   E(g0)^T (mu0 - h/2 f0) = E^T I xi,   rows without a pivot,   phi(g1) = 0
// mu0 and mu1 of p = I v, nu = h d(v^T I v)/2, as in cotangent_lift.hpp. The end of the step is
// another program: g1, E there, E^T (mu1 + h/2 f1) and the admissible velocity xi of that.
// Forces take the velocity v of the middle at both ends: f = f(t, g, 0) + that of dampers.
//
// Pivots are outputs: where one has lost nine tenths of what it was, others are recorded at that
// place, of the same number of unknowns.
// Not covered, left to the scheme for any problem: other s, tau or solvers, forces at the base,
// chosen steps; motors and forces by a user's function; ground that moves; agreements of contacts;
// planar and free joints between bodies; more than kMostUnknowns, programs of over kLongProgram
// instructions.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <hamel/framework/graph/code.hpp>
#include <hamel/framework/graph/elimination.hpp>
#include <hamel/systems/mechanisms/programs/lift_layout.hpp>

namespace hamel::mechanisms {

using graph::Eliminated;
using graph::Frame;
using graph::free_frame;
using graph::Pivot;
using graph::Sample;

/// Counts of the numbers in the programs' inputs and outputs, in their order.
struct LiftSizes {
  size_t element, turning, velocities, independent, motors, rates, held, moving;
  size_t unknowns, rows, holonomic;  // residuals: momenta, rows, phi
  size_t middle_pivots, node_pivots;

  /// Numbers that a node carries behind xi.
  size_t carried() const { return 2 * independent + 2 + moving; }
  // Inputs of the residual from the element on, and of the end, which begins with what the residual
  // gives.
  size_t given() const { return 2 * turning + 2 * velocities; }
  size_t residual_inputs() const {
    return element + 1 + motors + rates + moving + independent + rates + held + velocities;
  }
};

class LiftPrograms {
 public:
  static constexpr size_t kMostUnknowns = 16;

  /// Recorded near a state. unknowns: that it must have; 0: as few as it can. Null where it is not
  /// covered, or the rows depend on each other there.
  static std::shared_ptr<const LiftPrograms> record(const MechanismParts& parts,
                                                    std::shared_ptr<const LiftLayout> layout,
                                                    std::span<const double> state,
                                                    size_t unknowns = 0);

  const LiftLayout& layout() const { return *layout_; }
  const LiftSizes& sizes() const { return sizes_; }
  /// The velocities that are unknowns.
  const std::vector<int>& unknowns() const { return unknowns_; }

  /// Pivots where they were recorded.
  const std::vector<double>& node_pivots() const { return node_pivots_; }
  const std::vector<double>& middle_pivots() const { return middle_pivots_; }

  /// element, xi, motors, rates -> carried; diagonal of E^T I E; pivots.
  const graph::Code& start() const { return *start_; }
  /// element, h, motors, rates at the end, moving entries of E, target, rates at the middle,
  /// coordinates held, v -> residuals; pivots; c, s of turning joints at the end, mu1, v.
  const graph::Code& residual() const { return *residual_; }
  /// Residuals of kLanes states at once.
  const graph::Code& lanes() const { return *lanes_; }
  static constexpr int kLanes = 8;
  /// c, s at the end, mu1, v; element, h, motors, rates -> element, xi, carried; pivots.
  const graph::Code& end() const { return *end_; }

 private:
  friend class LiftRecorder;
  std::shared_ptr<const LiftLayout> layout_;
  LiftSizes sizes_ = {};
  std::vector<int> unknowns_;
  std::vector<double> node_pivots_, middle_pivots_;
  std::shared_ptr<const graph::Code> start_, residual_, lanes_, end_;
};

/// Does it cover these parts, but for joints?
bool has_lift_programs(const MechanismParts& parts, size_t drivers);

}  // namespace hamel::mechanisms
