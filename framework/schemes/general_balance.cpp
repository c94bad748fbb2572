#include <hamel/framework/schemes/general_balance.hpp>

#include <limits>

#include <hamel/framework/schemes/baselines.hpp>
#include <hamel/framework/schemes/balance.hpp>

namespace hamel {

template <int N, int K>
GeneralBalance<N, K>::GeneralBalance(const GeneralSetup& setup, bool ends_only)
    : geometry_(setup.geometry),
      system_(setup.mechanics),
      n_(system_->dim()),
      ends_only_(ends_only),
      s_(setup.s),
      g0_(geometry_->size()),
      xi0_(n_),
      mu0_(n_),
      base_place_(*system_),
      f0_(g0_),
      f1_(g0_),
      base_(g0_),
      g1_(g0_),
      v_(n_),
      w_(n_),
      z0_(n_),
      z1_(n_),
      nu_(n_),
      m0_(n_),
      m1_(n_),
      mu_(n_),
      r_(n_),
      u_(n_),
      inertia_(n_, n_),
      right_(n_, n_),
      a_(system_->rows(), n_),
      b_(system_->rows()),
      rows_(system_->rows()),
      end_rows_(system_->rows()),
      phi_(system_->holonomic_rows()) {}

template <int N, int K>
void GeneralBalance<N, K>::begin(const Node& node, double h) {
  t_ = node.t;
  h_ = h;
  v_.setConstant(std::numeric_limits<double>::quiet_NaN());  // nothing is evaluated so far
  g0_ = node.g;
  xi0_ = node.xi;
  base_place_.set(*system_, t_, g0_.data());  // here the frame of the step gets its signs
  inertia_ = base_place_.inertia;
  mu0_ = inertia_.lazyProduct(xi0_);
  system_->force(t_, g0_.data(), xi0_, nu_);
  const double size = 2 * base_place_.size(mu0_) + std::abs(h) * base_place_.size(nu_);
  scale_squared_ = size > 0 ? size * size : n_;
}

template <int N, int K>
void GeneralBalance<N, K>::guess(Unknown& x) const {
  x.resize(2 * n_);
  x.head(n_) = xi0_;
  x.tail(n_) = xi0_;
}

template <int N, int K>
void GeneralBalance<N, K>::evaluate(const Unknown& x) const {
  v_ = x.head(n_);
  w_ = x.tail(n_);
  z0_ = (-s_ * h_) * v_;
  z1_ = ((1 - s_) * h_) * v_;
  geometry_->tau(z0_.data(), f0_.data());
  geometry_->tau(z1_.data(), f1_.data());
  geometry_->inverse(f0_.data(), f0_.data());
  geometry_->compose(g0_.data(), f0_.data(), base_.data());
  geometry_->compose(base_.data(), f1_.data(), g1_.data());
  geometry_->inverse(f1_.data(), f1_.data());

  const double t = t_ + s_ * h_;
  base_place_.set(*system_, t, base_.data(), true);
  if (system_->constant_inertia()) inertia_ = base_place_.inertia;
  else system_->inertia(g1_.data(), inertia_);
  mu_ = inertia_.lazyProduct(w_);
  geometry_->Ad_transpose(f1_.data(), mu_.data(), m1_.data());
  geometry_->Ad_transpose(f0_.data(), mu0_.data(), m0_.data());

  // r: (1) on the base point.
  r_ = -base_place_.inertia.lazyProduct(v_);
  geometry_->dtau_right(z0_.data(), right_.data());
  r_ += s_ * right_.transpose().lazyProduct(m0_);
  geometry_->dtau_right(z1_.data(), right_.data());
  r_ += (1 - s_) * right_.transpose().lazyProduct(m1_);
  // u: (2).
  system_->force(t, base_.data(), v_, nu_);
  u_ = m1_ - m0_ - h_ * nu_;

  if (rows_.size() > 0) {
    rows_ = base_place_.a.lazyProduct(v_);
    rows_ -= base_place_.b;
    if (phi_.size() > 0) {
      system_->holonomic(g1_.data(), phi_);
      rows_.tail(phi_.size()) = phi_;
    }
    system_->constraints(t_ + h_, g1_.data(), a_, b_);
    end_rows_ = a_.lazyProduct(w_);
    end_rows_ -= b_;
  }
  if (ends_only_) base_place_.weigh(r_);
  else base_place_.join(r_, rows_);
  base_place_.join(u_, end_rows_);
}

template <int N, int K>
void GeneralBalance<N, K>::residual(const Unknown& x, Unknown& f) const {
  evaluate(x);
  f.head(n_) = r_;
  f.tail(n_) = u_;
}

template <int N, int K>
bool GeneralBalance<N, K>::finish(const Unknown& x, Node& next) const {
  if ((v_.array() != x.head(n_).array()).any() || (w_.array() != x.tail(n_).array()).any()) {
    evaluate(x);
  }
  z1_ = h_ * v_;
  if (!geometry_->in_domain(z1_.data())) return false;
  next.t = t_ + h_;
  next.g = g1_;
  geometry_->normalise(next.g.data());
  next.xi = w_;
  return true;
}

// reversible: both equations of the cotangent lift at s = 1/2 with nu = h (f + A(g)^T lambda), the multiplier
// at the midpoint, and the constraint enforced at the ends, A(g1) xi_1 = b. It is balance with (1) in full:
// the velocity v of the step is not admissible at the midpoint. Symmetric, order 2. Weakness: the
// configurations satisfy the rows of the step, and holonomic rows, to O(h^2) only; on reversible motions these
// errors and that of the energy stay bounded. Measured: tests/verification/baselines.cpp.
// Source: McLachlan and Perlmutter, Integrators for nonholonomic mechanical systems, J. Nonlinear Sci. 16 (2006).
std::unique_ptr<GeneralStep> Reversible::general(const GeneralSetup& setup) {
  GeneralSetup at_midpoint = setup;
  at_midpoint.s = 0.5;
  return std::make_unique<GeneralBalance<Eigen::Dynamic, Eigen::Dynamic>>(at_midpoint, true);
}

std::unique_ptr<GeneralStep> Balance::general(const GeneralSetup& setup) {
  return make_sized<GeneralBalance>(setup);
}

}  // namespace hamel
