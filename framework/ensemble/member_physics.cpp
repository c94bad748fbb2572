#include <hamel/framework/ensemble/member_physics.hpp>

#include <utility>

#include <hamel/framework/run/run/driver.hpp>

namespace hamel::ensemble {

void MemberPhysics::begin(const Run& run, bool same) {
  if (!any()) return;
  const RunPlan& plan = run.driver().plan();
  const auto& mechanics = plan.setup.mechanics;
  geometry_ = plan.geometry;
  waiting_.clear();
  if (reactions_ && (motion_ == nullptr || !same)) {
    motion_ =
        std::make_unique<EquationsOfMotion<DynamicProblem>>(DynamicProblem(geometry_, mechanics));
    g_.resize(geometry_->size());
  }
  if (!balanced_) return;
  const auto acting = run.driver().acting();
  balance_ = std::make_unique<EnergyBalance>(geometry_, acting, plan.setup.inputs);
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
  StateExtras extras;
  if (motion_ != nullptr) react(state, extras.reactions);
  if (balance_ == nullptr) return use(state, extras);
  waiting_.push_back({state, std::move(extras), std::move(use)});
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
    one.extras.balanced = true;
    one.extras.work = known.work;
    one.extras.energy_error = known.defect / known.scale;
    one.use(one.state, one.extras);
  }
}

void MemberPhysics::react(const Snapshot& state, std::vector<double>& out) {
  geometry_->from_coordinates(state.coordinates, g_.data());
  xi_ = Eigen::Map<const Eigen::VectorXd>(state.velocity.data(),
                                          static_cast<Eigen::Index>(state.velocity.size()));
  motion_->solve(state.time, g_, xi_);
  const Eigen::VectorXd& lambda = motion_->reaction();
  out.assign(lambda.begin(), lambda.end());
}

}  // namespace hamel::ensemble
