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
      work_(std::move(inputs)) {
  if (!active_) return;
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

void EnergyBalance::node(const Snapshot& state) {
  work_.node(state, [this](const Snapshot& now) { return power(now); });
  if (!started_) energy_start_ = state.energy;
  started_ = true;
  update_max_abs(energy_max_, state.energy);
  settle();
}

void EnergyBalance::row(const Snapshot& state) {
  waiting_.push_back({state.time, state.energy});
  work_.row(state.time);
  settle();
}

void EnergyBalance::settle() {
  work_.settled(works_);
  for (size_t i = 0; i < works_.size(); ++i) {
    work_done_ = works_[i];
    const double defect = waiting_[i].energy - energy_start_ - work_done_;
    update_max_abs(defect_max_, defect);
    settled_.push_back({work_done_, defect, scale()});
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(works_.size()));
}

void EnergyBalance::impact(const Snapshot& before, const Snapshot& after) {
  work_.impact(after, [this](const Snapshot& now) { return power(now); });
  settle();
  energy_start_ += after.energy - before.energy;
  update_max_abs(energy_max_, after.energy);
}

void EnergyBalance::settled(std::vector<BalancedState>& out) {
  out.clear();
  out.swap(settled_);
}

}  // namespace hamel
