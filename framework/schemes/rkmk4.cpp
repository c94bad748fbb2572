// rkmk4: Runge-Kutta-Munthe-Kaas of order 4 on the equations of motion, explicit (explicit_step.hpp).
//
// The coordinates are those of the algebra at the start of the step, g = g_0 tau(eta), in which
//   eta' = dL tau_eta^-1 xi.
// Without dL tau^-1 it would have order 2. Weakness: nothing is kept but the group: energy and holonomic rows
// drift, on a motion that goes on for ever like h^5 t (its error of order 4 averages out where the motion is
// reversible). Measured: tests/verification/baselines.cpp.
// Source: Munthe-Kaas, High order Runge-Kutta methods on manifolds (1998).
#include <hamel/framework/schemes/baselines.hpp>
#include <hamel/framework/schemes/explicit_step.hpp>

namespace hamel {
namespace {

class Step final : public ExplicitStep {
 public:
  explicit Step(const GeneralSetup& setup) : ExplicitStep(setup, setup.geometry->dim()) {}

 private:
  void start(const Eigen::VectorXd& g, Eigen::VectorXd& eta) override {
    g0_ = g;
    eta.setZero();
  }
  bool element(const Eigen::VectorXd& eta, Eigen::VectorXd& g) const override {
    if (!geometry_->in_domain(eta.data())) return false;
    geometry_->tau(eta.data(), g.data());
    geometry_->compose(g0_.data(), g.data(), g.data());
    return true;
  }
  void rate(const Eigen::VectorXd& eta, const Eigen::VectorXd& /*g*/, const Eigen::VectorXd& xi,
            Eigen::VectorXd& out) const override {
    geometry_->dtau_left_inverse(eta.data(), xi.data(), out.data());
  }

  Eigen::VectorXd g0_;
};

}  // namespace

std::unique_ptr<GeneralStep> Rkmk4::general(const GeneralSetup& setup) {
  return std::make_unique<Step>(setup);
}

}  // namespace hamel
