// The energy balance of a run: the energy less what forces and moving constraints have done, (M47) (M48) (M49).
// Not installed.
#pragma once

#include <memory>
#include <vector>

#include <hamel/framework/mechanics/equations_of_motion.hpp>
#include <hamel/framework/run/measures.hpp>
#include <hamel/framework/run/nodal_quadrature.hpp>
#include <hamel/framework/schemes/erased.hpp>

namespace hamel {

class EnergyBalance {
 public:
  /// geometry: null for a group that is not registered; then, and where the energy is kept, it is not active. inputs:
  /// those of the run, null without.
  EnergyBalance(std::shared_ptr<const Geometry> geometry,
                const std::shared_ptr<const Mechanics>& mechanics,
                std::shared_ptr<const Inputs> inputs);
  bool active() const { return active_; }

  /// Of each node, from the start on: its step, time, coordinates, velocity and energy.
  void node(const Snapshot& state);
  /// A recorded state, between the last two nodes or one of them.
  void row(const Snapshot& state);

  /// After the last node: one for each recorded state.
  std::vector<BalancedState> rows();

 private:
  // <f, xi> + lambda . b.
  double power(const Snapshot& state);

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> mechanics_;
  std::unique_ptr<EquationsOfMotion<Erased>> motion_;  // null without a drift
  bool active_;
  // The work at the recorded states that wait for the first nodes.
  void settle();
  // The quadrature begins anew at the last node: an input jumps or has a kink there, and so has the power.
  void break_off();

  std::shared_ptr<const Inputs> inputs_;
  long changes_ = 0;      // of the inputs, seen
  Snapshot last_;         // node, where there are inputs
  NodalQuadrature work_;  // since the quadrature began, when done_ was done
  double done_ = 0;
  bool started_ = false;
  double energy_start_ = 0, energy_max_ = 0;
  struct Recorded {
    double time, energy, work;
  };
  std::size_t settled_ = 0;
  std::vector<Recorded> recorded_;
  Eigen::VectorXd g_, xi_, b_;
  Eigen::MatrixXd a_;
};

}  // namespace hamel
