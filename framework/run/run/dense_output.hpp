// The state of a run at any time within its last step, and shortly after it.
//
// The explicit pairs have their own dense output. Of any other scheme the state at t is where
// a step of the same scheme, of size t - t_k, leads from the node t_k before: it has the order of
// the scheme, lies on the group and in the constraints, and runs into the next node.
#pragma once

#include <memory>

#include <hamel/framework/run/names/registry.hpp>

namespace hamel {

class DenseOutput {
 public:
  DenseOutput(Kernel& kernel, KernelFactory factory, KernelSetup setup);
  /// The state at t, measured. Not ok where the step to it fails.
  Status at(double t, Snapshot& out);
  /// Appends the state to a log, where the kernel itself has none there.
  Status log(double t, StateLog& log);

 private:
  Status step_to(double t, bool ahead);
  Kernel& kernel_;
  KernelFactory factory_;
  KernelSetup setup_;              // with steps of one size
  std::unique_ptr<Kernel> other_;  // takes the steps to t
  Snapshot begin_, now_;
};

}  // namespace hamel
