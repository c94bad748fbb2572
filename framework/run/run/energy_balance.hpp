// The energy balance of a run: the energy less what forces and moving constraints have done, (M47)
// (M48) (M49). Not installed.
#pragma once

#include <memory>
#include <vector>

#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/run/record/measures.hpp>
#include <hamel/framework/run/run/reactions.hpp>
#include <hamel/framework/run/run/run_integral.hpp>

namespace hamel {

class EnergyBalance {
 public:
  /// geometry: null for a group that is not registered; then, and where the energy is kept, it is
  /// not active. inputs: those of the run, null without. reactions: null without rows.
  EnergyBalance(std::shared_ptr<const Geometry> geometry,
                const std::shared_ptr<const Mechanics>& mechanics,
                std::shared_ptr<const Inputs> inputs, std::shared_ptr<Reactions> reactions);
  bool active() const { return active_; }

  /// Takes each node, from the start on: its step, time, coordinates, velocity and energy.
  void node(const Snapshot& state);
  /// Takes the end of a step from the time `begin`. The explicit pairs take long steps with
  /// a dense output: the power is asked for within them too, since the work is not known from their
  /// ends alone. motion_within(t, Snapshot&) -> bool, as Kernel::motion_within.
  template <class Within>
  void step(double begin, const Snapshot& end, const Within& motion_within) {
    for (const double part : {0.25, 0.5, 0.75}) {
      if (!motion_within(begin + part * (end.time - begin), within_)) break;
      work_.within(within_, [this](const Snapshot& state) { return power(state); });
      settle();
    }
    node(end);
  }
  /// A recorded state, between the last two nodes or one of them.
  void row(const Snapshot& state);

  /// An event changed the state at the last node: its energy is followed from there on.
  void impact(const Snapshot& before, const Snapshot& after);

  /// The recorded states that are complete by now and were not taken before, in their order:
  /// one waits for the first nodes of the quadrature.
  void settled(std::vector<BalancedState>& out);
  /// After the last node: none waits.
  void finish() {
    work_.finish();
    settle();
  }
  /// Over the recorded states that are settled, relative to the largest energy.
  double error_max() const { return defect_max_ / scale(); }
  /// The largest energy at the nodes so far.
  double scale() const { return energy_max_ == 0 ? 1 : energy_max_; }
  /// At the last recorded state.
  double work() const { return work_done_; }

  template <class Archive>
  void serialize(Archive& archive) {
    archive(work_, started_, energy_start_, energy_max_, defect_max_, work_done_, waiting_,
            settled_);
  }

 private:
  // <f, xi> + lambda . b.
  double power(const Snapshot& state);
  // The work at the recorded states that wait.
  void settle();

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> mechanics_;
  std::shared_ptr<Reactions> reactions_;  // null without a drift
  bool active_;
  Snapshot within_;   // a step, place and velocity
  RunIntegral work_;  // of the power
  bool started_ = false;
  double energy_start_ = 0, energy_max_ = 0;
  double defect_max_ = 0, work_done_ = 0;
  struct Recorded {
    double time = 0, energy = 0;
    template <class Archive>
    void serialize(Archive& archive) {
      archive(time, energy);
    }
  };
  std::vector<Recorded> waiting_;
  std::vector<BalancedState> settled_;
  std::vector<double> works_;
  Eigen::VectorXd g_, xi_, b_;
  Eigen::MatrixXd a_;
};

}  // namespace hamel
