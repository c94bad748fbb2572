#include <hamel/framework/run/run/rows/energy_balance.hpp>

#include <algorithm>
#include <cmath>

namespace hamel {

EnergyBalance::EnergyBalance(std::shared_ptr<const Geometry> geometry,
                             const std::shared_ptr<const Mechanics>& mechanics,
                             std::shared_ptr<const Inputs> inputs,
                             std::shared_ptr<Reactions> reactions, std::function<bool()> idle,
                             std::shared_ptr<RunContacts> contacts)
    : geometry_(std::move(geometry)),
      mechanics_(mechanics),
      active_(geometry_ != nullptr && (mechanics->has_force() || mechanics->has_drift())),
      idle_(std::move(idle)),
      work_(inputs),
      contacts_(std::move(contacts)) {
  if (!active_) return;
  for (int i = 0; contacts_ != nullptr && i < contacts_->dynamics()->count(); ++i)
    if (!contacts_->dynamics()->law(i).tangential.empty())
      friction_.push_back({i, RunIntegral(inputs)});
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
  for (Friction& one : friction_) one.power = contacts_->friction_power(one.contact);
  looked_at_ = &state;
  if (reactions_ != nullptr) {
    mechanics_->constraints(state.time, g_.data(), a_, b_);
    out += reactions_->at(state).dot(b_);
  }
  return out;
}

void EnergyBalance::node(const Snapshot& state, bool idle) {
  if (!idle || !work_.rests()) {
    integrate([&state](RunIntegral& one, const auto& rate) { one.node(state, rate); });
  } else if (!waiting_.empty()) {
    for (Friction& one : friction_) one.work.rests();  // as its parts do
  }
  if (!started_) energy_start_ = state.energy;
  started_ = true;
  update_max_abs(energy_max_, state.energy);
  settle();
}

void EnergyBalance::row(const Snapshot& state) {
  waiting_.push_back({state.time, state.energy});
  work_.row(state.time);
  for (Friction& one : friction_) one.work.row(state.time);
  settle();
}

void EnergyBalance::settle() {
  if (waiting_.empty()) return;
  work_.settled(works_);
  for (size_t i = 0; i < works_.size(); ++i) {
    work_done_ = works_[i];
    const double defect = waiting_[i].energy - energy_start_ - work_done_;
    update_max_abs(defect_max_, defect);
    settled_.push_back({work_done_, defect, scale()});
  }
  const std::size_t first = friction_works_.size(), count = friction_.size(),
                    settled = works_.size();
  friction_works_.resize(first + settled * count);
  for (std::size_t part = 0; part < count; ++part) {
    friction_[part].work.settled(works_);  // for the same nodes
    for (std::size_t i = 0; i < settled; ++i) friction_works_[first + i * count + part] = works_[i];
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(settled));
}

void EnergyBalance::impact(const Snapshot& before, const Snapshot& after) {
  integrate([&after](RunIntegral& one, const auto& rate) { one.impact(after, rate); });
  settle();
  energy_start_ += after.energy - before.energy;
  update_max_abs(energy_max_, after.energy);
}

void EnergyBalance::settled(std::vector<BalancedState>& out) {
  out.clear();
  out.swap(settled_);
  friction_given_.clear();
  friction_given_.swap(friction_works_);
}

}  // namespace hamel
