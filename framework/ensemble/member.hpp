// Members one after the other, in one thread: the run is built once where only starts and inputs
// differ, and restarted. Not installed.
#pragma once

#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/ensemble/ensemble_plan.hpp>
#include <hamel/framework/ensemble/member_physics.hpp>
#include <hamel/framework/loop/kernel.hpp>
#include <hamel/framework/run/run/run.hpp>

namespace hamel::ensemble {

/// The admissible velocities next to one, with some components given: offset + gain values.
struct GivenComponents {
  Eigen::VectorXd offset;
  Eigen::MatrixXd gain;
};

class MemberRunner {
 public:
  /// plan: outlives it.
  explicit MemberRunner(const Plan& plan, const std::atomic<bool>* stop = nullptr);
  ~MemberRunner();
  MemberRunner(const MemberRunner&) = delete;
  MemberRunner& operator=(const MemberRunner&) = delete;

  /// Fills in the columns, or the failure's reason; false: stopped on the way.
  bool run(long member, std::span<double> out, MemberFailure& failure);
  /// The setup of a member whose steps another kernel takes; null, and the failure's reason, where
  /// it has no start. Then kept() is given its states.
  const KernelSetup* begin(long member, MemberFailure& failure);
  KeptFormulas& kept() { return kept_; }
  /// The columns of that member, or the reason why there are none.
  std::string finish(std::span<double> out);
  /// Configuration of the same run.
  Config config(long member);

 private:
  Config parameters_of(long member) const;
  void prepare(long member);
  Start start_of(long member, Start start);
  void give_components(long member, Start& start);
  void put_on_energy(long member, Start& start);
  GivenComponents given_components(const Start& start) const;
  void matrices(const Start& start) const;
  bool follow(MemberFailure& failure);
  void look(double now);
  template <class Use>
  void give(const Snapshot& state, const Use& use);
  void peak(const Snapshot& state);
  long steps_to_next(long done, long total) const;
  double act_by_state(double now);

  const Plan& plan_;
  const std::atomic<bool>* stop_;
  KeptFormulas kept_;
  FeedbackFormulas feedback_;
  MemberPhysics physics_;
  std::optional<Run> run_;
  std::optional<GivenComponents> components_;  // where they are the same for all
  std::vector<size_t> given_;                  // variations of a velocity's component
  Start common_;                               // the start that all have in common
  size_t time_ = 0, row_ = 0;                  // the next ones
  long acted_ = 0;                             // the next multiple of the feedback's period
  // Work space of a start.
  mutable Eigen::VectorXd g_, drift_;
  mutable Eigen::MatrixXd inertia_, rows_;
};

}  // namespace hamel::ensemble
