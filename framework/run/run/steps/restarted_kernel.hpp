// Rebuilds its kernel from the current node at each checkpoint, so that a resumed run repeats the
// uninterrupted one bit for bit: what follows depends on the node alone, and not on the steps
// before (extrapolation, Jacobians, the error's history, products). Not installed.
#pragma once

#include <memory>
#include <span>

#include <hamel/framework/run/names/registry.hpp>
#include <hamel/framework/run/record/checkpoint.hpp>

namespace hamel {

class RestartedKernel final : public Kernel {
 public:
  RestartedKernel(KernelFactory factory, KernelSetup setup);
  void begin_anew();
  /// As one made of this setup, which differs from its own in the start alone.
  void start_again(const KernelSetup& setup);
  /// Right after begin_anew(), or in its place.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(setup_.from, setup_.configuration, setup_.velocity, setup_.step, limit_, origin_,
            origin_steps_, steps_, whole_, past_);
    if constexpr (std::is_same_v<Archive, CheckpointReader>) make();
  }

  Status advance(long count) override;
  long whole_steps() const override { return whole_ + kernel_->whole_steps(); }
  bool off_grid() const override { return kernel_->off_grid(); }
  using Kernel::state;
  void state(Snapshot& out, const StateParts& parts) const override;
  const SolverStats& stats() const override;
  bool log_to(StateLog* log, bool within) override { return kernel_->log_to(log, within); }
  bool log_state(double t) override { return kernel_->log_state(t); }
  void node(Snapshot& out) const override { kernel_->node(out); }
  void beginning(Snapshot& out) const override { kernel_->beginning(out); }
  double time() const override { return kernel_->time(); }
  double beginning_time() const override { return kernel_->beginning_time(); }
  void set_end_time(double t) override;
  double end_time() const { return limit_; }
  double next_step() const override { return kernel_->next_step(); }
  void turn_back() override { kernel_->turn_back(); }
  void restart(double t, std::span<const double> coordinates, std::span<const double> velocity,
               double step) override;
  void clear_history() override { kernel_->clear_history(); }
  bool interpolate(double t, Snapshot& out) override;
  bool motion_within(double t, Snapshot& out) override { return kernel_->motion_within(t, out); }

 private:
  void make();
  void replace();

  KernelFactory factory_;
  KernelSetup setup_;
  std::unique_ptr<Kernel> kernel_;
  double limit_;
  // Steps of one size are counted from here, so that a new beginning adds no round-off to the
  // times.
  double origin_;
  long origin_steps_ = 0;
  long steps_ = 0, whole_ = 0;  // before this kernel was made
  SolverStats past_;            // of these
  mutable SolverStats all_;
};

}  // namespace hamel
