// rk4_projected: classical RK4 in the coordinates of the trajectory file, projected (explicit_step.hpp).
// What a user writes by hand.
//
// The coordinates are the columns q(g) of the element (nine for a rotation), in which
//   q' = d/de q(g tau(e xi)) at e = 0.
// Between the stages they leave the group; the element is the one nearest to them. Weakness: no structure but
// what the projections put back; energy and holonomic rows drift as those of rkmk4 (rkmk4.cpp).
// Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, IV.4 (projection methods).
#include <hamel/framework/lie/differences.hpp>
#include <hamel/framework/schemes/baselines.hpp>
#include <hamel/framework/schemes/explicit_step.hpp>

namespace hamel {
namespace {

class Step final : public ExplicitStep {
 public:
  explicit Step(const GeneralSetup& setup)
      : ExplicitStep(setup, setup.geometry->columns()),
        step_(setup.geometry->dim()),
        moved_(setup.geometry->size()),
        q_(setup.geometry->columns()) {}

 private:
  void start(const Eigen::VectorXd& g, Eigen::VectorXd& q) override {
    geometry_->coordinates(g.data(), q.data());
  }
  bool element(const Eigen::VectorXd& q, Eigen::VectorXd& g) const override {
    if (!q.allFinite()) return false;
    geometry_->nearest({q.data(), static_cast<size_t>(q.size())}, g.data());
    return geometry_->defect(g.data()) < 1e-6;  // else too far from any
  }
  void rate(const Eigen::VectorXd& /*q*/, const Eigen::VectorXd& g, const Eigen::VectorXd& xi,
            Eigen::VectorXd& out) const override {
    out.setZero();
    differentiate_along(*geometry_, g.data(), xi, step_, moved_, [&](double, double weight) {
      geometry_->coordinates(moved_.data(), q_.data());
      out += weight * q_;
    });
  }

  mutable Eigen::VectorXd step_, moved_, q_;
};

}  // namespace

std::unique_ptr<GeneralStep> Rk4Projected::general(const GeneralSetup& setup) {
  return std::make_unique<Step>(setup);
}

}  // namespace hamel
