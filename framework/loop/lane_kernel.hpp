// Interface of the run-time layer to time loops of several bodies at once, one in each lane of a
// SIMD register. The loops themselves: framework/lanes.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include <hamel/framework/loop/kernel.hpp>

namespace hamel {

/// Bodies of one kind in step with each other: steps of one size, without inputs, solved by Newton.
class LaneKernel {
 public:
  LaneKernel() = default;
  LaneKernel(const LaneKernel&) = delete;
  LaneKernel& operator=(const LaneKernel&) = delete;
  virtual ~LaneKernel() = default;
  virtual void advance(long count) = 0;
  /// Has a step of this lane failed? Its state is then of no use, and its motion the scalar
  /// kernel's.
  virtual bool failed(int lane) const = 0;
  /// The state of a lane, as Kernel::state has it, but for the solver's part.
  virtual void state(int lane, Snapshot& out, const StateParts& parts) const = 0;
  /// Other starts, at the time of the first ones: configuration and velocity of each lane.
  virtual void restart(std::span<const KernelSetup> setups) = 0;
};

/// A time loop in lanes, compiled for a problem, a retraction and a scheme.
struct LaneInfo {
  int lanes = 1;
  std::string instructions = {};  // the set that this machine offers: "avx2"
  /// setups: one for each lane; they differ in mechanics, configuration and velocity alone.
  std::function<std::unique_ptr<LaneKernel>(std::span<const KernelSetup> setups)> make = {};
};

}  // namespace hamel
