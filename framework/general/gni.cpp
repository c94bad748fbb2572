// gni: reflect the momentum at the node, then take a free variational step.
//
// The momentum p- that arrives at a node leaves it as p+ = 2 p~ - p-, p~ = I xi the part of p- that no
// reaction can carry (place.hpp). Then the unconstrained step of the cotangent lift: mu0(v) = p+, p- = mu1.
// Order 2 (s = 1/2, or V = f = 0 with a symmetric tau). Weakness: |det| of the map is 1, while systems
// such as Suslov's with full inertia contract phase volume; a parasitic mode (-1)^k e^{+A t} grows
// beside the motion and ends long runs. A teaching baseline.
// Source: Ferraro, Iglesias, Martin de Diego, Momentum and energy preserving integrators for nonholonomic
// dynamics, Nonlinearity 21 (2008).
#include <hamel/framework/general/baselines.hpp>
#include <hamel/framework/general/place.hpp>
#include <hamel/framework/general/step.hpp>

namespace hamel {
namespace {

class Step final : public GeneralStep {
 public:
  explicit Step(const GeneralSetup& setup)
      : geometry_(setup.geometry),
        system_(setup.mechanics),
        s_(setup.s),
        place_(*system_),
        leaving_(system_->dim()),
        v_(leaving_),
        z_(leaving_),
        p_(leaving_),
        nu_(leaving_),
        m_(leaving_),
        mu_(leaving_),
        xi_(leaving_),
        f0_(geometry_->size()),
        f1_(f0_),
        base_(f0_),
        inertia_(system_->dim(), system_->dim()) {}
  int size() const override { return system_->dim(); }

  void begin(const Node& node, double h) override {
    t_ = node.t;
    h_ = h;
    g_ = node.g;
    xi0_ = node.xi;
    place_.set(*system_, t_, g_.data());
    leaving_.noalias() = place_.inertia * xi0_;
    if (node.memory.size() > 0) leaving_ = 2 * leaving_ - node.memory;
    inertia_ = place_.inertia;
  }
  void guess(Unknown& x) const override { x = xi0_; }
  double scale_squared() const override {
    const double size = leaving_.squaredNorm();
    return size > 0 ? 4 * size : inertia_.squaredNorm();
  }
  void residual(const Unknown& x, Unknown& f) const override {
    evaluate(x);
    geometry_->Ad_transpose(f0_.data(), m_.data(), mu_.data());
    f = mu_ - leaving_;
  }
  bool finish(const Unknown& x, Node& next) const override {
    evaluate(x);
    z_ = h_ * v_;
    if (!geometry_->in_domain(z_.data())) return false;
    m_ += nu_;
    geometry_->Ad_transpose(f1_.data(), m_.data(), mu_.data());
    next.t = t_ + h_;
    next.g = base_;
    geometry_->compose(next.g.data(), f1_.data(), next.g.data());
    geometry_->normalise(next.g.data());
    next.memory = mu_;
    place_.set(*system_, next.t, next.g.data());
    place_.admissible(mu_, xi_);
    next.xi = xi_;
    return true;
  }

 private:
  // f0, f1, the base point, m0 in m and nu.
  void evaluate(const Unknown& x) const {
    v_ = x;
    z_ = (-s_ * h_) * v_;
    geometry_->tau(z_.data(), f0_.data());
    z_ = ((1 - s_) * h_) * v_;
    geometry_->tau(z_.data(), f1_.data());
    geometry_->inverse(f0_.data(), base_.data());
    geometry_->compose(g_.data(), base_.data(), base_.data());
    if (!system_->constant_inertia()) system_->inertia(base_.data(), inertia_);
    p_.noalias() = inertia_ * v_;
    system_->force(t_ + s_ * h_, base_.data(), v_, nu_);
    nu_ *= h_;
    z_ = h_ * v_;
    geometry_->base_momentum(s_, z_.data(), p_.data(), nu_.data(), m_.data());
  }

  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> system_;
  double s_, t_ = 0, h_ = 0;
  Eigen::VectorXd g_, xi0_;
  mutable Place<> place_;
  mutable Eigen::VectorXd leaving_, v_, z_, p_, nu_, m_, mu_, xi_, f0_, f1_, base_;
  mutable Eigen::MatrixXd inertia_;
};

}  // namespace

std::unique_ptr<GeneralStep> Gni::general(const GeneralSetup& setup) {
  return std::make_unique<Step>(setup);
}

}  // namespace hamel
