// Crossings: values where the number of unstable eigenvalues changes along a branch, and the
// branches that cross it there. For steady_sweep.cpp, not installed.
//
// A crossing is the zero of a smooth function of the value: of the real part that changes its sign;
// where eigenvalues l and -l* of a system without damping collide on the axis, reached like a
// root, of (l + l*)^2/4 or l^2, -w^2 on the other side. At a crossing of a real eigenvalue F_z has
// one kernel vector v more than beside it, or no branch crosses it. On another branch, at z + e v +
// ..., q is q0 + a e + b e^2: transcritical where its sign changes with that of e, else a
// pitchfork.
#pragma once

#include <vector>

#include <hamel/framework/analysis/steady_branch.hpp>

namespace hamel::reduced {

/// A node with its motion.
struct BranchMotion {
  BranchNode node;
  SteadyMotion motion;
};

class Crossings {
 public:
  Crossings(Branch& branch, int family) : branch_(branch), family_(family) {}
  /// The crossings between two neighbours, in order.
  std::vector<SteadyCrossing> between(const BranchMotion& left, const BranchMotion& right);

 private:
  void look(const BranchMotion& a, const BranchMotion& b);
  std::optional<BranchMotion> on_branch(double value);
  double measure(const SteadyMotion& motion) const;
  double error_at(const SteadyMotion& motion) const;
  void locate(const BranchMotion& a, const BranchMotion& b);
  void classify(SteadyCrossing& crossing, const BranchMotion& at);

  Branch& branch_;
  int family_;
  std::vector<BranchMotion> known_;  // between the two, by value
  std::vector<SteadyCrossing> out_;
  // The one being located: the place of the eigenvalue that grows, a pair, mirrored at the axis.
  size_t index_ = 0;
  bool pair_ = false, mirrored_ = false;
};

/// A motion at a value, as a place.
SteadyPlace place_of(Branch& branch, const BranchNode& node);

}  // namespace hamel::reduced
