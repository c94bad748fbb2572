// The kind of a crossing and of the end of a branch, by the coefficients of its bifurcation
// equation (steady_bifurcation.hpp). For steady_sweep.cpp, not installed.
#pragma once

#include <functional>
#include <optional>

#include <hamel/framework/analysis/steady_bifurcation.hpp>

namespace hamel::reduced {

/// The place of a motion, at its value.
SteadyPlace place_of(Branch& branch, const BranchNode& node);

/// A crossing of a real eigenvalue on a branch, which is there from `first` to `last`.
struct RealCrossing {
  BranchNode near;
  double first, last;
  bool unstable_above;  // growth at greater values
  std::function<std::optional<BranchNode>(double value)> on_branch;
};
/// Sets the kind of the crossing, where another branch is, and to which side it bends.
void classify(Branch& branch, const RealCrossing& real, SteadyCrossing& crossing);

/// fold, pitchfork (the branch is one half of another one) or undecided.
Bifurcation kind_of_turn(Branch& branch, const Branch::Turn& turn);

}  // namespace hamel::reduced
