#include <hamel/framework/ensemble/member_physics.hpp>

#include <utility>

#include <hamel/framework/run/run/driver.hpp>

namespace hamel::ensemble {

void MemberPhysics::begin(const Run& run) {
  if (!any()) return;
  waiting_.clear();
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

void MemberPhysics::step(const Run& run, double before, const Snapshot& state) {
  const auto within = [&run](double t, Snapshot& out) {
    return run.driver().motion_within(t, out);
  };
  if (balance_ != nullptr) balance_->step(before, state, within);
  if (paths_.active()) paths_.step(before, state, within);
  settle();
}

void MemberPhysics::give(const Snapshot& state, Use use) {
  std::span<const double> reactions, acceleration;
  const auto span = [](const Eigen::VectorXd& x) {
    return std::span<const double>(x.data(), static_cast<size_t>(x.size()));
  };
  if (of_rows_ != nullptr) reactions = span(of_rows_->at(state));
  if (motion_ != nullptr) acceleration = span(motion_->acceleration(state));
  if (!follows()) return use(state, {.reactions = reactions, .acceleration = acceleration});
  waiting_.push_back({state,
                      {reactions.begin(), reactions.end()},
                      {acceleration.begin(), acceleration.end()},
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
    StateExtras extras{.reactions = one.reactions, .acceleration = one.acceleration};
    if (paths_.active()) extras.paths = std::span(lengths_).subspan(i * count, count);
    if (balance_ != nullptr) {
      extras.work = settled_[i].work;
      extras.balance_error = settled_[i].defect / settled_[i].scale;
    }
    one.use(one.state, extras);
  }
}

}  // namespace hamel::ensemble
