#include <hamel/framework/general/lift.hpp>

#include <limits>
#include <utility>

#include <hamel/framework/schemes/lift.hpp>

namespace hamel {
namespace {
constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
}

template <int N>
GeneralLift<N>::GeneralLift(const GeneralSetup& setup)
    : geometry_(setup.geometry),
      system_(setup.mechanics),
      n_(system_->dim()),
      s_(setup.s),
      g0_(geometry_->size()),
      xi0_(n_),
      target_(n_),
      start_(*system_),
      end_(*system_),
      end_g_(g0_),
      f0_(g0_),
      f1_(g0_),
      base_(g0_),
      g1_(g0_),
      v_(n_),
      z0_(n_),
      z1_(n_),
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

template <int N>
void GeneralLift<N>::begin(const Node& node, double h) {
  t_ = node.t;
  h_ = h;
  g0_ = node.g;
  xi0_ = node.xi;
  if (end_time_ == t_ && end_g_ == g0_) std::swap(start_, end_);  // where the last step ended
  else start_.set(*system_, t_, g0_.data());
  end_time_ = kNever;
  if (system_->constant_inertia()) inertia_ = start_.inertia;
  target_ = start_.inertia.lazyProduct(xi0_);
  system_->force(t_, g0_.data(), xi0_, nu_);
  // |mu| + |I xi/h| + |nu|; at rest without force the inertia itself.
  const double size = 2 * target_.norm() + std::abs(h) * nu_.norm();
  scale_squared_ = size > 0 ? size * size : start_.inertia.squaredNorm();
}

template <int N>
void GeneralLift<N>::evaluate(const Unknown& x) const {
  v_ = x;
  z1_ = ((1 - s_) * h_) * v_;
  geometry_->tau(z1_.data(), f1_.data());
  if (s_ == 0) {
    base_ = g0_;
  } else {
    z0_ = (-s_ * h_) * v_;
    geometry_->tau(z0_.data(), f0_.data());
    geometry_->inverse(f0_.data(), base_.data());
    geometry_->compose(g0_.data(), base_.data(), base_.data());
  }
  geometry_->compose(base_.data(), f1_.data(), g1_.data());

  const double t = t_ + s_ * h_;
  if (!system_->constant_inertia()) system_->inertia(base_.data(), inertia_);
  p_ = inertia_.lazyProduct(v_);
  system_->force(t, base_.data(), v_, nu_);
  nu_ *= h_;
  step_ = h_ * v_;
  geometry_->base_momentum(s_, step_.data(), p_.data(), nu_.data(), m_.data());
  if (s_ == 0) mu_ = m_;
  else geometry_->Ad_transpose(f0_.data(), m_.data(), mu_.data());
  // mu_ is mu0, m_ is m0.
  r_ = mu_ - target_;
  if (rows_.size() > 0) {
    system_->constraints(t, base_.data(), a_, b_);
    rows_ = a_.lazyProduct(v_);
    rows_ -= b_;
    if (phi_.size() > 0) {  // in metres per second: a velocity error would show as h times itself
      system_->holonomic(g1_.data(), phi_);
      rows_.tail(phi_.size()) = phi_;
    }
  }
}

template <int N>
void GeneralLift<N>::residual(const Unknown& x, Unknown& f) const {
  evaluate(x);
  start_.join(r_, rows_);
  f = r_;
}

template <int N>
bool GeneralLift<N>::finish(const Unknown& x, Node& next) const {
  if ((v_.array() != x.array()).any()) evaluate(x);
  if (!geometry_->in_domain(step_.data())) return false;
  m_ += nu_;
  geometry_->Ad_transpose(f1_.data(), m_.data(), mu_.data());
  next.t = t_ + h_;
  next.g = g1_;
  geometry_->normalise(next.g.data());
  end_.set(*system_, next.t, next.g.data());
  end_time_ = next.t;
  end_g_ = next.g;
  end_.admissible(mu_, p_);
  next.xi = p_;
  return true;
}

std::unique_ptr<GeneralStep> Lift::general(const GeneralSetup& setup) {
  return make_sized<GeneralLift>(setup);
}

}  // namespace hamel
