// rkmk4: Runge-Kutta-Munthe-Kaas of order 4 on the equations of motion, explicit.
//
// On the step g = g_0 tau(eta): eta' = dL tau_eta^-1 xi, xi' = a(t, g, xi) with the acceleration of
// Lagrange-d'Alembert (motion.hpp); classical RK4, then xi is projected onto A xi = b. Without dL tau^-1 it
// would have order 2. Weakness: nothing is kept but the group: energy drifts like h^4 t, holonomic rows too.
// Source: Munthe-Kaas, High order Runge-Kutta methods on manifolds (1998).
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
        moved_(geometry_->size()) {
    for (auto* v : {&eta_, &rate_, &eta_sum_, &xi_sum_, &xi_, &mu_}) v->resize(system_->dim());
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
    eta_sum_.setZero();
    xi_sum_.setZero();
    for (int i = 0; i < 4; ++i) {
      if (i == 0) {
        eta_.setZero();
        xi_ = start_.xi;
      } else {
        eta_ = (at[i] * h_) * rate_;
        xi_ = start_.xi + (at[i] * h_) * motion_.acceleration();
      }
      geometry_->tau(eta_.data(), moved_.data());
      geometry_->compose(start_.g.data(), moved_.data(), moved_.data());
      geometry_->dtau_left_inverse(eta_.data(), xi_.data(), rate_.data());
      motion_(start_.t + at[i] * h_, moved_.data(), xi_);
      eta_sum_ += weight[i] * rate_;
      xi_sum_ += weight[i] * motion_.acceleration();
    }
    eta_ = h_ * eta_sum_;
    if (!geometry_->in_domain(eta_.data()) || !xi_sum_.allFinite()) return false;
    next.t = start_.t + h_;
    next.g.resize(start_.g.size());
    geometry_->tau(eta_.data(), next.g.data());
    geometry_->compose(start_.g.data(), next.g.data(), next.g.data());
    geometry_->normalise(next.g.data());
    place_.set(*system_, next.t, next.g.data());
    xi_ = start_.xi + h_ * xi_sum_;
    mu_.noalias() = place_.inertia * xi_;
    place_.admissible(mu_, xi_);
    next.xi = xi_;
    return true;
  }

 private:
  std::shared_ptr<const Geometry> geometry_;
  std::shared_ptr<const Mechanics> system_;
  mutable Motion motion_;
  mutable Place<> place_;
  Node start_;
  double h_ = 0;
  mutable Eigen::VectorXd moved_, eta_, rate_, eta_sum_, xi_sum_, xi_, mu_;
};

}  // namespace

std::unique_ptr<GeneralStep> Rkmk4::general(const GeneralSetup& setup) {
  return std::make_unique<Step>(setup);
}

}  // namespace hamel
