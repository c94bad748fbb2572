// gni: reflect the momentum at the node, then take a free variational step.
//
// The momentum p- = I v- that arrives at a node leaves it as p+ = 2 p~ - p-, p~ = I xi the part of p- that no
// reaction can carry (place.hpp); as velocities v+ = 2 xi - v-. Then the unconstrained step of the cotangent
// lift, mu0 = p+, p- = mu1: lift (lift.hpp) of the system without its rows, which starts from v+ and ends in v-.
// Order 2 (s = 1/2, or V = f = 0 with a symmetric tau). Weakness: |det| of the map is 1, while systems
// such as Suslov's with full inertia contract phase volume, e^{-A t}: the momentum across the constraint, O(h) at
// the start, is multiplied by -e^{+A h} in a step, the nodes see its square, h^2 e^{2 A t}, and half the step
// puts the end of the run off by log(2)/A only. The velocity of a step is admissible to O(h) only. A teaching
// baseline. Measured: tests/verification/baselines.cpp.
// Source: Ferraro, Iglesias, Martin de Diego, Momentum and energy preserving integrators for nonholonomic
// dynamics, Nonlinearity 21 (2008).
#include <hamel/framework/schemes/baselines.hpp>
#include <hamel/framework/mechanics/place.hpp>
#include <hamel/framework/schemes/general_step.hpp>
#include <hamel/framework/schemes/lift.hpp>

namespace hamel {
namespace {

/// The system without its rows.
class Free final : public Mechanics {
 public:
  explicit Free(std::shared_ptr<const Mechanics> system) : system_(std::move(system)) {}
  int dim() const override { return system_->dim(); }
  int rows() const override { return 0; }
  bool constant_inertia() const override { return system_->constant_inertia(); }
  bool constant_constraints() const override { return true; }
  void inertia(const double* g, Matrix out) const override { system_->inertia(g, out); }
  void constraints(double, const double*, Matrix, Vector) const override {}
  void force(double t, const double* g, ConstVector xi, Vector out) const override {
    system_->force(t, g, xi, out);
  }

 private:
  std::shared_ptr<const Mechanics> system_;
};

class Step final : public GeneralStep {
 public:
  explicit Step(const GeneralSetup& setup)
      : system_(setup.mechanics),
        free_(Lift::general({setup.geometry, std::make_shared<Free>(system_), setup.s})),
        place_(*system_),
        momentum_(system_->dim()) {}
  int size() const override { return free_->size(); }
  void begin(const Node& node, double h) override {
    leaving_.t = node.t;
    leaving_.g = node.g;
    leaving_.xi = node.xi;
    if (node.memory.size() > 0) leaving_.xi = 2 * node.xi - node.memory;
    free_->begin(leaving_, h);
  }
  void guess(Unknown& x) const override { free_->guess(x); }
  double scale_squared() const override { return free_->scale_squared(); }
  void residual(const Unknown& x, Unknown& f) const override { free_->residual(x, f); }
  void from_frame(Unknown& z) const override { free_->from_frame(z); }
  bool finish(const Unknown& x, Node& next) const override {
    if (!free_->finish(x, next)) return false;
    next.memory = next.xi;
    place_.set(*system_, next.t, next.g.data());
    momentum_.noalias() = place_.inertia * next.memory;
    place_.admissible(momentum_, next.xi);
    return true;
  }

 private:
  std::shared_ptr<const Mechanics> system_;
  std::unique_ptr<GeneralStep> free_;
  mutable Place<> place_;
  Node leaving_;
  mutable Eigen::VectorXd momentum_;
};

}  // namespace

std::unique_ptr<GeneralStep> Gni::general(const GeneralSetup& setup) {
  return std::make_unique<Step>(setup);
}

}  // namespace hamel
