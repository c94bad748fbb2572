#include <hamel/framework/ensemble/lane_members.hpp>

#include <algorithm>

namespace hamel::ensemble {

LaneMembers::LaneMembers(const Plan& plan, bool lanes, const std::atomic<bool>* stop)
    : plan_(plan), info_(lanes ? plan.lanes : nullptr), stop_(stop) {
  const int count = info_ != nullptr ? info_->lanes : 1;
  for (int i = 0; i < count; ++i) lanes_.push_back(std::make_unique<Lane>(plan, stop));
  setups_.resize(lanes_.size());
}

bool LaneMembers::run(long first, std::span<double> rows, std::vector<MemberFailure>& failures) {
  const size_t width = plan_.kept->width();
  for (size_t done = 0; done < rows.size() / width;) {
    const size_t count = std::min(lanes_.size(), rows.size() / width - done);
    const long member = first + static_cast<long>(done);
    const bool together = info_ != nullptr && count > 1 && begin(member, count);
    if (together && !follow()) return false;
    for (size_t i = 0; i < count; ++i) {
      Lane& lane = *lanes_[i];
      const auto row = rows.subspan((done + i) * width, width);
      const bool there = together && lane.runs && !kernel_->failed(static_cast<int>(i));
      if (there) lane.failure.reason = lane.runner.finish(row);
      else if (!run_alone(lane, member + static_cast<long>(i), row)) return false;
      if (!lane.failure.reason.empty()) failures.push_back(lane.failure);
    }
    done += count;
  }
  return true;
}

bool LaneMembers::run_alone(Lane& lane, long member, std::span<double> row) {
  return lane.runner.run(member, row, lane.failure);
}

// The kernel at the starts of these members; false where none of them has one.
bool LaneMembers::begin(long first, size_t count) {
  size_t good = count;
  for (size_t i = 0; i < count; ++i) {
    Lane& lane = *lanes_[i];
    const KernelSetup* setup = lane.runner.begin(first + static_cast<long>(i), lane.failure);
    lane.runs = setup != nullptr;
    if (!lane.runs) continue;
    setups_[i] = *setup;
    good = i;
  }
  if (good == count) return false;
  for (size_t i = 0; i < lanes_.size(); ++i)  // lanes without a member repeat another
    if (i >= count || !lanes_[i]->runs) setups_[i] = setups_[good];
  for (size_t i = count; i < lanes_.size(); ++i) lanes_[i]->runs = false;
  if (kernel_ != nullptr && !plan_.builds_each()) kernel_->restart(setups_);
  else kernel_ = info_->make(setups_);
  if (kernel_ == nullptr) info_ = nullptr;  // not for these options
  return kernel_ != nullptr;
}

// visit(lane), with these parts of its state_. That of a lane that has failed is of no use: its
// member begins again, alone.
template <class Visit>
void LaneMembers::each_running(const StateParts& parts, const Visit& visit) {
  for (size_t i = 0; i < lanes_.size(); ++i) {
    if (!lanes_[i]->runs) continue;
    kernel_->state(static_cast<int>(i), state_, parts);
    visit(*lanes_[i]);
  }
}

// To the end; false: stopped on the way.
bool LaneMembers::follow() {
  constexpr long kMost = 4096;  // steps between two looks at the flag that stops a run
  const bool peaks = plan_.kept->wants_peaks();
  const long total = plan_.resolved.steps(), every = plan_.base.every;
  if (peaks || plan_.kept->wants_start()) {
    each_running(plan_.kept->start_parts(), [&](Lane& lane) {
      lane.runner.kept().start(state_);
      if (peaks) lane.runner.kept().peak(state_);
    });
  }
  for (long done = 0; done < total;) {
    if (stop_ != nullptr && stop_->load()) return false;
    const long count = std::min({total - done, kMost, peaks ? every - done % every : kMost});
    kernel_->advance(count);
    done += count;
    if (peaks && done % every == 0)
      each_running(plan_.kept->peak_parts(), [&](Lane& lane) { lane.runner.kept().peak(state_); });
  }
  each_running(plan_.kept->parts(), [&](Lane& lane) {
    lane.failure.time = state_.time;
    if (peaks) lane.runner.kept().peak(state_);
    lane.runner.kept().end(state_, {});
  });
  return true;
}

}  // namespace hamel::ensemble
