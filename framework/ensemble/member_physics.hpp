// Numbers that a member's states do not carry themselves: reactions, accelerations, the energy
// balance and paths, for which every node is needed. As a run's rows have them
// (run_recorder.hpp). Not installed.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <hamel/framework/ensemble/kept.hpp>
#include <hamel/framework/run/run/rows/energy_balance.hpp>
#include <hamel/framework/run/run/rows/path_lengths.hpp>
#include <hamel/framework/run/run/run.hpp>
#include <hamel/framework/run/run/step_follower.hpp>

namespace hamel::ensemble {

class MemberPhysics final : public StepFollower {
 public:
  /// Where nothing of this is wanted it costs nothing.
  explicit MemberPhysics(const WantedPhysics& wanted) : wanted_(wanted) {}
  bool any() const { return wanted_.any(); }
  bool wants_nodes() const { return wanted_.nodes(); }

  /// A member at its start, whose steps are followed from here on where nodes are wanted.
  void begin(Run& run);
  /// The first node.
  void node(const Snapshot& state);
  void step(double begin, const Snapshot& end, const Within& motion_within) override;
  void impact(const Snapshot& before, const Snapshot& after) override;
  /// States within the last step are looked at, and no longer: in the modes of its contacts.
  void look_within(bool within);
  /// Calls use(state, extras) as soon as the extras are known, in the order of these calls: at
  /// once, or, where the balance needs further nodes, after some of them.
  using Use = std::function<void(const Snapshot&, const StateExtras&)>;
  void give(const Snapshot& state, Use use);
  /// After the last node: none waits.
  void finish();

 private:
  struct Waiting {
    Snapshot state;
    std::vector<double> reactions, acceleration, modes;
    Use use;
  };
  void take_impact();
  bool follows() const { return balance_ != nullptr || paths_.active(); }
  void settle();

  WantedPhysics wanted_;
  std::shared_ptr<Reactions> of_rows_, motion_;
  std::shared_ptr<RunContacts> contacts_;             // null without
  std::optional<std::pair<Snapshot, Snapshot>> met_;  // an impact at the end of the last step
  std::unique_ptr<EnergyBalance> balance_;
  PathLengths paths_;
  std::deque<Waiting> waiting_;
  std::vector<BalancedState> settled_;
  std::vector<double> lengths_;
};

}  // namespace hamel::ensemble
