// The energy balance of a run: the energy less what forces and moving constraints have done, (M47)
// (M48) (M49), and in it the work of friction at each contact. Not installed.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include <hamel/framework/mechanics/inputs.hpp>
#include <hamel/framework/run/record/measures.hpp>
#include <hamel/framework/run/run/rows/reactions.hpp>
#include <hamel/framework/run/run/rows/run_integral.hpp>

namespace hamel {

class EnergyBalance {
 public:
  /// geometry: null for a group that is not registered; then, and where the energy is kept, it is
  /// not active. inputs: those of the run, null without. reactions: null without rows.
  /// idle: has nothing a power in the present step? Then it is not looked at inside. contacts:
  /// those whose friction is in the power of `mechanics`, null without.
  EnergyBalance(std::shared_ptr<const Geometry> geometry,
                const std::shared_ptr<const Mechanics>& mechanics,
                std::shared_ptr<const Inputs> inputs, std::shared_ptr<Reactions> reactions,
                std::function<bool()> idle = {}, std::shared_ptr<RunContacts> contacts = nullptr);
  bool active() const { return active_; }
  /// Contacts with friction.
  std::size_t friction_count() const { return friction_.size(); }

  /// Takes each node, from the start on: its step, time, coordinates, velocity and energy. idle: of
  /// a step without power.
  void node(const Snapshot& state, bool idle = false);
  /// Takes the end of a step from the time `begin`. The explicit pairs take long steps with
  /// a dense output: the power is asked for within them too, since the work is not known from their
  /// ends alone. motion_within(t, Snapshot&) -> bool, as Kernel::motion_within.
  template <class Within>
  void step(double begin, const Snapshot& end, const Within& motion_within) {
    const bool idle = idle_ && idle_();
    for (const double part : {0.25, 0.5, 0.75}) {
      if (idle) break;
      if (!motion_within(begin + part * (end.time - begin), within_)) break;
      integrate([this](RunIntegral& one, const auto& rate) { one.within(within_, rate); });
      settle();
    }
    node(end, idle);
  }
  /// A recorded state, between the last two nodes or one of them.
  void row(const Snapshot& state);

  /// An event changed the state at the last node: its energy is followed from there on.
  void impact(const Snapshot& before, const Snapshot& after);

  /// The recorded states that are complete by now and were not taken before, in their order:
  /// one waits for the first nodes of the quadrature.
  void settled(std::vector<BalancedState>& out);
  /// Behind settled(): the work of friction at these states, friction_count() numbers for each.
  const std::vector<double>& friction_works() const { return friction_given_; }
  /// After the last node: none waits.
  void finish() {
    work_.finish();
    for (Friction& one : friction_) one.work.finish();
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
            settled_, friction_works_);
    for (Friction& one : friction_) archive(one.work);
  }

 private:
  struct Friction {
    int contact = 0;
    RunIntegral work;
    double power = 0;  // at looked_at_
  };
  // take(integral, rate) for the power and its parts, which are looked at together.
  template <class Take>
  void integrate(const Take& take) {
    take(work_, [this](const Snapshot& state) { return power(state); });
    for (Friction& one : friction_)
      take(one.work, [this, &one](const Snapshot& state) {
        if (looked_at_ != &state) power(state);
        return one.power;
      });
    looked_at_ = nullptr;
  }
  // <f, xi> + lambda . b.
  double power(const Snapshot& state);
  // The work at the recorded states that wait.
  void settle();

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> mechanics_;
  std::shared_ptr<Reactions> reactions_;  // null without a drift
  bool active_;
  std::function<bool()> idle_;
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
  std::shared_ptr<RunContacts> contacts_;
  std::vector<Friction> friction_;
  const Snapshot* looked_at_ = nullptr;
  std::vector<double> friction_works_, friction_given_;  // of settled_; of those that were taken
  Eigen::VectorXd g_, xi_, b_;
  Eigen::MatrixXd a_;
};

}  // namespace hamel
