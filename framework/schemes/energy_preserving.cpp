// energy_preserving: a discrete-gradient step for left-invariant systems.
//
//   I (xi_1 - xi_0) = h ad*_W I W + A^T lambda,   W = (xi_0 + xi_1)/2,   A xi_1 = 0,   g_1 = g_0 tau(h W).
// Paired with W: <ad*_W I W, W> = 0 and A W = 0, so that 1/2 xi^T I xi is kept to round-off. Order 2.
// Weakness: the energy is all that is kept; the trajectory has the error of any method of order 2.
// Source: Celledoni, Farre Puiggali, Hoiseth, Martin de Diego, Energy-preserving integrators applied to
// nonholonomic systems, J. Nonlinear Sci. 29 (2019).
#include <hamel/framework/schemes/baselines.hpp>
#include <hamel/framework/mechanics/place.hpp>
#include <hamel/framework/schemes/general_step.hpp>

namespace hamel {
namespace {

class Step final : public GeneralStep {
 public:
  explicit Step(const GeneralSetup& setup)
      : geometry_(setup.geometry),
        system_(setup.mechanics),
        place_(*system_),
        g_(geometry_->size()),
        w_(system_->dim()),
        momentum_(w_),
        r_(w_),
        rows_(system_->rows()) {}
  int size() const override { return system_->dim(); }
  void begin(const Node& node, double h) override {
    t_ = node.t;
    h_ = h;
    g_ = node.g;
    xi0_ = node.xi;
    place_.set(*system_, t_, g_.data());
    momentum_.noalias() = place_.inertia * xi0_;
  }
  void guess(Unknown& x) const override { x = xi0_; }
  double scale_squared() const override {
    const double size = place_.size(momentum_);
    return 4 * size * size;
  }
  void residual(const Unknown& x, Unknown& f) const override {
    w_ = 0.5 * (xi0_ + x);
    f.noalias() = place_.inertia * w_;
    geometry_->ad_transpose(w_.data(), f.data(), r_.data());
    r_ *= -h_;
    w_ = x - xi0_;
    r_.noalias() += place_.inertia * w_;
    rows_.noalias() = place_.a * x;
    place_.join(r_, rows_);
    f = r_;
  }
  void from_frame(Unknown& z) const override { place_.from_frame(z.data()); }
  bool finish(const Unknown& x, Node& next) const override {
    w_ = (0.5 * h_) * (xi0_ + x);
    if (!geometry_->in_domain(w_.data())) return false;
    next.t = t_ + h_;
    next.g.resize(g_.size());
    geometry_->tau(w_.data(), next.g.data());
    geometry_->compose(g_.data(), next.g.data(), next.g.data());
    geometry_->normalise(next.g.data());
    next.xi = x;
    return true;
  }

 private:
  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> system_;
  mutable Place<> place_;
  double t_ = 0, h_ = 0;
  Eigen::VectorXd g_, xi0_;
  mutable Eigen::VectorXd w_, momentum_, r_, rows_;
};

}  // namespace

std::unique_ptr<GeneralStep> EnergyPreserving::general(const GeneralSetup& setup) {
  return std::make_unique<Step>(setup);
}

}  // namespace hamel
