// Crossings: values where eigenvalues cross the imaginary axis along a branch. For
// steady_sweep.cpp, not installed.
//
// Eigenvalues are followed by continuity, l_i(q) each with the nearest of the next node that its
// line through the last two predicts, and nodes are added until the middle of every step is close
// to the mean of its ends, or all three are on one side of the axis by more than they are apart
// from it. Each curve whose real part is known to change its sign is a crossing, whatever the
// number of unstable eigenvalues before and behind. Real parts that their errors cover decide
// nothing: a node on the crossing is passed over, and a curve that has no known sign behind it has
// no crossing. In systems without damping, where each l has a mate -l*, eigenvalues collide on the
// axis and leave it: reached like a root, of (l + l*)^2/4 or l^2, -w^2 on the other side. The value
// is the zero of the polynomial through values on both sides, at distances where the motions are
// well conditioned (at the crossing F_z is singular), its error what closer ones change.
#pragma once

#include <vector>

#include <hamel/framework/analysis/crossing_root.hpp>

namespace hamel::reduced {

/// A crossing with the node nearest to it.
struct FoundCrossing {
  SteadyCrossing crossing;
  BranchNode node;
  bool grows;  // behind it, along the nodes
};

class Crossings {
 public:
  Crossings(Branch& branch, int family) : branch_(branch), family_(family) {}
  /// The crossings along neighbouring nodes, in their order.
  std::vector<FoundCrossing> along(const std::vector<BranchMotion>& nodes);
  /// The node at a value, on the branch through the nearest node that is known.
  std::optional<BranchNode> node_at(double value);

 private:
  // A point of the curve of one eigenvalue.
  struct Point {
    size_t node;   // in known_
    size_t place;  // of the eigenvalue
  };
  struct Bracket {
    Point from, to;
    bool mirrored;
  };
  using Curve = std::vector<size_t>;  // the place at each node

  std::optional<BranchMotion> on_branch(double value);
  void refine(const BranchMotion& a, const BranchMotion& b, int depth);
  std::vector<Curve> curves() const;
  void add_brackets(const Curve& curve, std::vector<Bracket>& to) const;
  void locate(const Bracket& bracket);

  Branch& branch_;
  int family_;
  std::vector<BranchMotion> known_;  // in order along the branch
  std::vector<FoundCrossing> out_;
};

}  // namespace hamel::reduced
