#include <hamel/framework/schemes/general_lift.hpp>

#include <limits>

#include <hamel/framework/schemes/lift.hpp>

namespace hamel {
namespace {
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();  // evaluated so far
}

template <int N, int K>
GeneralLift<N, K>::GeneralLift(const GeneralSetup& setup)
    : geometry_(setup.geometry),
      system_(setup.mechanics),
      n_(system_->dim()),
      s_(setup.s),
      mirrored_(s_ == 0.5 && geometry_->symmetric()),
      g0_(geometry_->size()),
      xi0_(n_),
      target_(n_),
      place_(*system_),
      place_g_(g0_),
      place_time_(kNothing),
      f0_(g0_),
      f1_(g0_),
      base_(g0_),
      g1_(g0_),
      v_(n_),
      z_(n_),
      step_(n_),
      p_(n_),
      nu_(n_),
      m_(n_),
      mu_(n_),
      r_(n_),
      inertia_(n_, n_),
      a_(system_->rows(), n_),
      b_(system_->rows()),
      rows_(system_->rows()),
      phi_(system_->holonomic_rows()) {}

template <int N, int K>
void GeneralLift<N, K>::begin(const Node& node, double h) {
  t_ = node.t;
  h_ = h;
  v_.setConstant(kNothing);
  g0_ = node.g;
  xi0_ = node.xi;
  if (!(place_time_ == t_ && place_g_ == g0_)) {  // else it is where the last step ended
    place_.set(*system_, t_, g0_.data());
    place_time_ = t_;
    place_g_ = g0_;
  }
  inertia_ = place_.inertia;
  target_ = inertia_.lazyProduct(xi0_);
  system_->force(t_, g0_.data(), xi0_, nu_);
  // |mu0| + |I xi/h| + |h force| in the units of (*); at rest without force those of unit velocities.
  const double size = 2 * place_.size(target_) + std::abs(h) * place_.size(nu_);
  scale_squared_ = size > 0 ? size * size : n_;
}

template <int N, int K>
void GeneralLift<N, K>::evaluate(const Unknown& x) const {
  v_ = x;
  step_ = h_ * v_;
  z_ = (1 - s_) * step_;
  geometry_->tau(z_.data(), f1_.data());
  if (s_ == 0) {
    base_ = g0_;
  } else if (mirrored_) {
    geometry_->inverse(f1_.data(), f0_.data());
    geometry_->compose(g0_.data(), f1_.data(), base_.data());
  } else {
    z_ = -s_ * step_;
    geometry_->tau(z_.data(), f0_.data());
    geometry_->inverse(f0_.data(), base_.data());
    geometry_->compose(g0_.data(), base_.data(), base_.data());
  }
  geometry_->compose(base_.data(), f1_.data(), g1_.data());

  const double t = t_ + s_ * h_;
  if (!system_->constant_inertia()) system_->inertia(base_.data(), inertia_);
  p_ = inertia_.lazyProduct(v_);
  system_->force(t, base_.data(), v_, nu_);
  nu_ *= h_;
  geometry_->base_momentum(s_, step_.data(), p_.data(), nu_.data(), m_.data());
  if (s_ == 0) mu_ = m_;
  else geometry_->Ad_transpose(f0_.data(), m_.data(), mu_.data());
  // mu_ is mu0, m_ is m0.
  r_ = mu_ - target_;
  if (rows_.size() > 0) {
    system_->constraints(t, base_.data(), a_, b_);
    rows_ = a_.lazyProduct(v_);
    rows_ -= b_;
    if (phi_.size() > 0) {  // in metres: a velocity error would show as h times itself
      system_->holonomic(g1_.data(), phi_);
      rows_.tail(phi_.size()) = phi_;
    }
  }
}

template <int N, int K>
void GeneralLift<N, K>::residual(const Unknown& x, Unknown& f) const {
  evaluate(x);
  place_.join(r_, rows_);
  f = r_;
}

template <int N, int K>
bool GeneralLift<N, K>::finish(const Unknown& x, Node& next) const {
  if ((v_.array() != x.array()).any()) evaluate(x);
  if (!geometry_->in_domain(step_.data())) return false;
  m_ += nu_;
  geometry_->Ad_transpose(f1_.data(), m_.data(), mu_.data());
  next.t = t_ + h_;
  next.g = g1_;
  geometry_->normalise(next.g.data());
  place_.set(*system_, next.t, next.g.data());
  place_time_ = next.t;
  place_g_ = next.g;
  place_.admissible(mu_, p_);
  next.xi = p_;
  return true;
}

std::unique_ptr<GeneralStep> Lift::general(const GeneralSetup& setup) {
  return make_sized<GeneralLift>(setup);
}

}  // namespace hamel
