#include <hamel/framework/ensemble/member_physics.hpp>

#include <utility>

#include <hamel/framework/run/run/driver.hpp>

namespace hamel::ensemble {

void MemberPhysics::begin(Run& run) {
  if (!any()) return;
  waiting_.clear();
  contacts_ = run.driver().plan().contacts;
  met_.reset();
  run.driver().follow(wants_nodes() || contacts_ != nullptr ? this : nullptr);
  if (wanted_.reactions) of_rows_ = run.driver().plan().reactions;
  if (wanted_.accelerations) motion_ = run.driver().plan().motion;
  if (wanted_.paths) paths_ = run.driver().paths();
  if (!wanted_.balance) return;
  balance_ = std::make_unique<EnergyBalance>(run.driver().balance());
  if (!balance_->active()) balance_.reset();
}

void MemberPhysics::node(const Snapshot& state) {
  if (balance_ != nullptr) balance_->node(state);
  if (paths_.active()) paths_.node(state);
  settle();
}

void MemberPhysics::step(double begin, const Snapshot& end, const Within& motion_within) {
  take_impact();
  if (balance_ != nullptr) balance_->step(begin, end, motion_within);
  if (paths_.active()) paths_.step(begin, end, motion_within);
  settle();
}

// Behind the states within the step, which are looked at first.
void MemberPhysics::impact(const Snapshot& before, const Snapshot& after) {
  take_impact();
  met_.emplace(before, after);
}

void MemberPhysics::take_impact() {
  if (!met_) return;
  if (balance_ != nullptr) balance_->impact(met_->first, met_->second);
  if (paths_.active()) paths_.impact(met_->second);
  met_.reset();
  settle();
}

void MemberPhysics::look_within(bool within) {
  if (contacts_ != nullptr && met_) contacts_->look_back(within);
  if (!within) take_impact();
}

void MemberPhysics::give(const Snapshot& state, Use use) {
  std::span<const double> reactions, acceleration;
  const auto span = [](const Eigen::VectorXd& x) {
    return std::span<const double>(x.data(), static_cast<size_t>(x.size()));
  };
  if (of_rows_ != nullptr) reactions = span(of_rows_->at(state));
  if (motion_ != nullptr) acceleration = span(motion_->acceleration(state));
  std::vector<double> modes;
  if (contacts_ != nullptr) modes = contacts_->mode_numbers();
  if (!follows())
    return use(state, {.reactions = reactions, .acceleration = acceleration, .modes = modes});
  waiting_.push_back({state,
                      {reactions.begin(), reactions.end()},
                      {acceleration.begin(), acceleration.end()},
                      std::move(modes),
                      std::move(use)});
  if (balance_ != nullptr) balance_->row(state);
  if (paths_.active()) paths_.row(state);
  settle();
}

void MemberPhysics::finish() {
  if (balance_ != nullptr) balance_->finish();
  if (paths_.active()) paths_.finish();
  settle();
}

// The rows of which all is known by now: balance and paths wait for the same nodes.
void MemberPhysics::settle() {
  if (!follows()) return;
  settled_.clear();
  lengths_.clear();
  if (balance_ != nullptr) balance_->settled(settled_);
  if (paths_.active()) paths_.settled(lengths_);
  const size_t count = paths_.count(),
               rows = balance_ != nullptr ? settled_.size() : lengths_.size() / count;
  for (size_t i = 0; i < rows; ++i) {
    Waiting one = std::move(waiting_.front());
    waiting_.pop_front();
    StateExtras extras{
        .reactions = one.reactions, .acceleration = one.acceleration, .modes = one.modes};
    if (paths_.active()) extras.paths = std::span(lengths_).subspan(i * count, count);
    if (balance_ != nullptr) {
      extras.work = settled_[i].work;
      extras.balance_error = settled_[i].defect / settled_[i].scale;
    }
    one.use(one.state, extras);
  }
}

}  // namespace hamel::ensemble
