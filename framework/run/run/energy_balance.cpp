#include <hamel/framework/run/run/energy_balance.hpp>

#include <algorithm>
#include <cmath>

namespace hamel {

EnergyBalance::EnergyBalance(std::shared_ptr<const Geometry> geometry,
                             const std::shared_ptr<const Mechanics>& mechanics,
                             std::shared_ptr<const Inputs> inputs,
                             std::shared_ptr<Reactions> reactions)
    : geometry_(std::move(geometry)),
      mechanics_(mechanics),
      active_(geometry_ != nullptr && (mechanics->has_force() || mechanics->has_drift())),
      inputs_(std::move(inputs)) {
  if (!active_) return;
  if (inputs_ != nullptr) changes_ = inputs_->changes();
  g_.resize(geometry_->size());
  if (!mechanics->has_drift()) return;
  reactions_ = std::move(reactions);
  b_.resize(mechanics->constraint_count());
  a_.resize(mechanics->constraint_count(), mechanics->dim());
}

double EnergyBalance::power(const Snapshot& state) {
  load_element(*geometry_, state, g_);
  xi_ = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(),
                                          static_cast<Eigen::Index>(state.velocity.size()));
  double out = mechanics_->power(state.time, g_.data(), xi_);
  if (reactions_ != nullptr) {
    mechanics_->constraints(state.time, g_.data(), a_, b_);
    out += reactions_->at(state).dot(b_);
  }
  return out;
}

void EnergyBalance::add_power(const Snapshot& state) {
  if (inputs_ != nullptr) {
    if (inputs_->changes() != changes_ && started_) break_off(last_);
    changes_ = inputs_->changes();
  }
  const double now = power(state);
  if (started_ && !work_.joins(state.time)) settle();
  work_.add(state.time, now);
}

void EnergyBalance::node(const Snapshot& state) {
  add_power(state);
  if (inputs_ != nullptr) last_ = state;
  if (!started_) energy_start_ = state.energy;
  started_ = true;
  update_max_abs(energy_max_, state.energy);
  if (work_.settled()) settle();
}

void EnergyBalance::row(const Snapshot& state) {
  waiting_.push_back({state.time, state.energy});
  if (work_.settled()) settle();
}

void EnergyBalance::settle() {
  for (const Recorded& r : waiting_) {
    work_done_ = done_ + work_.value(r.time);
    const double defect = r.energy - energy_start_ - work_done_;
    update_max_abs(defect_max_, defect);
    settled_.push_back({work_done_, defect, scale()});
  }
  waiting_.clear();
}

void EnergyBalance::break_off(const Snapshot& at) {
  settle();
  done_ += work_.value(at.time);
  work_ = NodalQuadrature();
  work_.add(at.time, power(at));
}

void EnergyBalance::impact(const Snapshot& before, const Snapshot& after) {
  break_off(after);
  last_ = after;
  energy_start_ += after.energy - before.energy;
  update_max_abs(energy_max_, after.energy);
}

void EnergyBalance::settled(std::vector<BalancedState>& out) {
  out.clear();
  out.swap(settled_);
}

}  // namespace hamel
