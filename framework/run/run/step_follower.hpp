// Follower of a run, step by step, beside its rows. Not installed.
#pragma once

#include <functional>

#include <hamel/framework/loop/snapshot.hpp>

namespace hamel {

class StepFollower {
 public:
  /// Kernel::motion_within of the step.
  using Within = std::function<bool(double t, Snapshot& out)>;
  virtual ~StepFollower() = default;
  /// A step from `begin`, whole or up to an event or a switch of contacts within it.
  virtual void step(double begin, const Snapshot& end, const Within& motion_within) = 0;
  /// An event, or a switch of contacts, there.
  virtual void impact(const Snapshot& before, const Snapshot& after) = 0;
};

}  // namespace hamel
