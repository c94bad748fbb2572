// Members one by one, or as many at once as a kernel has lanes: where that is compiled for the
// system, and all that is kept is of nodes. Both give the same bytes. Not installed.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <hamel/framework/ensemble/member.hpp>
#include <hamel/framework/loop/lane_kernel.hpp>

namespace hamel::ensemble {

class LaneMembers {
 public:
  /// plan: outlives it. lanes: false: one by one in any case.
  LaneMembers(const Plan& plan, bool lanes, const std::atomic<bool>* stop);

  /// The members from first on, as many as rows has rows, and the failures among them; false:
  /// stopped on the way.
  bool run(long first, std::span<double> rows, std::vector<MemberFailure>& failures);

 private:
  /// Member of a lane.
  struct Lane {
    explicit Lane(const Plan& plan, const std::atomic<bool>* stop) : runner(plan, stop) {}
    MemberRunner runner;
    MemberFailure failure;
    bool runs = false;
  };
  bool run_alone(Lane& lane, long member, std::span<double> row);
  bool begin(long first, size_t count);
  bool follow();
  template <class Visit>
  void each_running(const StateParts& parts, const Visit& visit);

  const Plan& plan_;
  const LaneInfo* info_;
  const std::atomic<bool>* stop_;
  std::vector<std::unique_ptr<Lane>> lanes_;
  std::vector<KernelSetup> setups_;
  std::unique_ptr<LaneKernel> kernel_;
  Snapshot state_;
};

}  // namespace hamel::ensemble
