// rk4_projected: classical RK4 in the coordinates of the trajectory file, projected. What a user writes by hand.
//
// With q the columns of the element, q' = dq/de (g tau(e xi)) and xi' = a(t, g, xi) (motion.hpp); the stages
// are evaluated at the elements nearest to them, and after the step q goes to the nearest element, xi onto
// A xi = b. Order 4. Weakness: no structure but what the projections put back; energy and holonomic rows drift.
// Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, IV.4 (projection methods).
#include <algorithm>

#include <hamel/framework/general/baselines.hpp>
#include <hamel/framework/general/motion.hpp>

namespace hamel {
namespace {

class Step final : public GeneralStep {
 public:
  explicit Step(const GeneralSetup& setup)
      : geometry_(setup.geometry),
        system_(setup.mechanics),
        motion_(geometry_, system_),
        place_(*system_),
        element_(geometry_->size()),
        moved_(element_) {
    for (auto* v : {&xi_, &xi_sum_, &mu_, &step_}) v->resize(system_->dim());
    for (auto* v : {&q0_, &q_, &rate_, &q_sum_, &plus_}) v->resize(geometry_->columns());
  }
  int size() const override { return 0; }
  void begin(const Node& node, double h) override {
    start_ = node;
    h_ = h;
  }
  void guess(Unknown& /*x*/) const override {}
  double scale_squared() const override { return 1; }
  void residual(const Unknown& /*x*/, Unknown& /*f*/) const override {}

  bool finish(const Unknown& /*x*/, Node& next) const override {
    constexpr double at[] = {0, 0.5, 0.5, 1}, weight[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
    geometry_->coordinates(start_.g.data(), q0_.data());
    q_sum_.setZero();
    xi_sum_.setZero();
    for (int i = 0; i < 4; ++i) {
      q_ = q0_;
      xi_ = start_.xi;
      if (i > 0) {
        q_ += (at[i] * h_) * rate_;
        xi_ += (at[i] * h_) * motion_.acceleration();
      }
      if (!q_.allFinite()) return false;
      geometry_->nearest({q_.data(), static_cast<size_t>(q_.size())}, element_.data());
      set_rate();
      motion_(start_.t + at[i] * h_, element_.data(), xi_);
      q_sum_ += weight[i] * rate_;
      xi_sum_ += weight[i] * motion_.acceleration();
    }
    q_ = q0_ + h_ * q_sum_;
    if (!q_.allFinite() || !xi_sum_.allFinite()) return false;
    next.t = start_.t + h_;
    next.g.resize(start_.g.size());
    geometry_->nearest({q_.data(), static_cast<size_t>(q_.size())}, next.g.data());
    place_.set(*system_, next.t, next.g.data());
    xi_ = start_.xi + h_ * xi_sum_;
    mu_.noalias() = place_.inertia * xi_;
    place_.admissible(mu_, xi_);
    next.xi = xi_;
    return true;
  }

 private:
  // The coordinates' rate along xi, by sixth-order differences (1e-12).
  void set_rate() const {
    constexpr double weights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
    const double unit = 2e-3 / std::max(1.0, xi_.norm());
    rate_.setZero();
    for (int k = 1; k <= 3; ++k) {
      for (const double sign : {1.0, -1.0}) {
        step_ = (sign * k * unit) * xi_;
        geometry_->tau(step_.data(), moved_.data());
        geometry_->compose(element_.data(), moved_.data(), moved_.data());
        geometry_->coordinates(moved_.data(), plus_.data());
        rate_ += (sign * weights[k - 1] / unit) * plus_;
      }
    }
  }

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> system_;
  mutable Motion motion_;
  mutable Place<> place_;
  Node start_;
  double h_ = 0;
  mutable Eigen::VectorXd element_, moved_, xi_, xi_sum_, mu_, step_, q0_, q_, rate_, q_sum_, plus_;
};

}  // namespace

std::unique_ptr<GeneralStep> Rk4Projected::general(const GeneralSetup& setup) {
  return std::make_unique<Step>(setup);
}

}  // namespace hamel
