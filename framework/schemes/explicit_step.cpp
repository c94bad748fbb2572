#include <hamel/framework/schemes/explicit_step.hpp>

namespace hamel {

ExplicitStep::ExplicitStep(const GeneralSetup& setup, int coordinates)
    : geometry_(setup.geometry),
      system_(setup.mechanics),
      motion_(geometry_, system_),
      place_(*system_),
      q0_(coordinates),
      g_(geometry_->size()),
      q_(q0_),
      rate_(q0_),
      q_sum_(q0_),
      xi_(system_->dim()),
      xi_sum_(xi_),
      mu_(xi_) {}

void ExplicitStep::begin(const Node& node, double h) {
  t_ = node.t;
  h_ = h;
  xi0_ = node.xi;
  start(node.g, q0_);
}

bool ExplicitStep::finish(const Unknown& /*x*/, Node& next) const {
  constexpr double at[] = {0, 0.5, 0.5, 1}, weight[] = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  q_sum_.setZero();
  xi_sum_.setZero();
  for (int i = 0; i < 4; ++i) {
    q_ = q0_;
    xi_ = xi0_;
    if (i > 0) {
      q_ += (at[i] * h_) * rate_;
      xi_ += (at[i] * h_) * motion_.acceleration();
    }
    if (!element(q_, g_)) return false;
    rate(q_, g_, xi_, rate_);
    motion_(t_ + at[i] * h_, g_.data(), xi_);
    q_sum_ += weight[i] * rate_;
    xi_sum_ += weight[i] * motion_.acceleration();
  }
  q_ = q0_ + h_ * q_sum_;
  if (!element(q_, g_)) return false;
  geometry_->normalise(g_.data());
  next.t = t_ + h_;
  next.g = g_;
  place_.set(*system_, next.t, g_.data());
  xi_ = xi0_ + h_ * xi_sum_;
  mu_.noalias() = place_.inertia * xi_;
  place_.admissible(mu_, xi_);
  next.xi = xi_;
  return xi_.allFinite();
}

}  // namespace hamel
