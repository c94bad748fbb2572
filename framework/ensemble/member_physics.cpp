#include <hamel/framework/ensemble/member_physics.hpp>

#include <utility>

#include <hamel/framework/run/run/driver.hpp>

namespace hamel::ensemble {

void MemberPhysics::begin(const Run& run) {
  if (!any()) return;
  waiting_.clear();
  if (reactions_) of_rows_ = run.driver().plan().reactions;
  if (!balanced_) return;
  balance_ = std::make_unique<EnergyBalance>(run.driver().balance());
  if (!balance_->active()) balance_.reset();
}

void MemberPhysics::node(const Snapshot& state) {
  if (balance_ == nullptr) return;
  balance_->node(state);
  settle();
}

void MemberPhysics::step(const Run& run, double before, const Snapshot& state) {
  if (balance_ == nullptr) return;
  balance_->step(before, state,
                 [&run](double t, Snapshot& out) { return run.driver().motion_within(t, out); });
  settle();
}

void MemberPhysics::give(const Snapshot& state, Use use) {
  std::span<const double> reactions;
  if (of_rows_ != nullptr) {
    const Eigen::VectorXd& lambda = of_rows_->at(state);
    reactions = {lambda.data(), static_cast<size_t>(lambda.size())};
  }
  if (balance_ == nullptr) return use(state, {.reactions = reactions});
  waiting_.push_back({state, {reactions.begin(), reactions.end()}, std::move(use)});
  balance_->row(state);
  settle();
}

void MemberPhysics::finish() {
  if (balance_ == nullptr) return;
  balance_->finish();
  settle();
}

// The rows of which the balance is known by now.
void MemberPhysics::settle() {
  balance_->settled(settled_);
  for (const BalancedState& known : settled_) {
    Waiting one = std::move(waiting_.front());
    waiting_.pop_front();
    one.use(one.state, {.reactions = one.reactions,
                        .work = known.work,
                        .balance_error = known.defect / known.scale});
  }
}

}  // namespace hamel::ensemble
